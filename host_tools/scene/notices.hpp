// SPDX-License-Identifier: MIT
// Places in files and what there is to say of them enter; refusals, and one line for each kind of note, leave.
#pragma once

#include <cstddef>
#include <string>
#include <unordered_map>
#include <vector>

namespace torolux {

/// A line of a file; 0: the file as a whole.
struct Place {
  std::string file;
  std::size_t line = 0;

  std::string text() const { return line == 0 ? file : file + ":" + std::to_string(line); }
};

/// Throws InputError "FILE:LINE: message".
[[noreturn]] void refuse(const Place& place, const std::string& message);

/// What is passed over, or read as the one thing that it can mean. Each kind is told once, with the first place and how
/// many more there were.
class Notices {
 public:
  /// message: the kind. detail: what of this kind stands at this place.
  void note(const std::string& message, const Place& place, const std::string& detail = {});
  /// "FILE:LINE: message: detail (and 37 more)", in the order of their first places.
  std::vector<std::string> lines() const;

 private:
  struct Notice {
    std::string message;
    Place first;
    std::string detail;
    std::size_t count;
  };
  /// More kinds than a reader would look at are counted together: files by chance have one on each line.
  static constexpr std::size_t kMostKinds = 100;

  std::vector<Notice> notices_;
  std::unordered_map<std::string, std::size_t> number_;  // by message
  std::size_t more_ = 0;
};

}  // namespace torolux
