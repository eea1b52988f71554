// SPDX-License-Identifier: MIT
// Runs enter, what came of them leaves: by child processes here (local_hands.hpp), or by other ranks (rank_hands.hpp).
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace torolux::study {

struct Order {
  std::uint64_t number = 0;        ///< of who gives it
  std::vector<std::string> words;  ///< after `torolux`
  bool from_output = false;        ///< the result is what it prints

  template <class Archive>
  void archive(Archive& archive) {
    archive(number, words, from_output);
  }
};

struct Outcome {
  int exit_code = 0;  ///< 128 + signal where it was killed
  std::string errors;
  std::string result;  ///< empty where the run writes it into its file itself
};

struct Answer {
  std::uint64_t number = 0;
  std::optional<Outcome> outcome;  ///< absent: nobody does it any more
};

class Hands {
 public:
  Hands() = default;
  Hands(const Hands&) = delete;
  Hands& operator=(const Hands&) = delete;
  virtual ~Hands() = default;

  /// Results come with answers: statistics are to be written to kResultStream.
  virtual bool brings_results() const = 0;
  virtual bool free() const = 0;
  /// Only while free. Leaves the process that does it, if it is one of this computer.
  virtual std::optional<pid_t> start(const Order& order) = 0;
  virtual std::optional<Answer> poll() = 0;
  /// Ends what runs; it is not answered.
  virtual void stop() = 0;
};

}  // namespace torolux::study
