// SPDX-License-Identifier: MIT
// A child process: words in; exit code, output, errors and a result out.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace torolux::study {

struct Ended {
  int exit_code;  ///< 128 + signal where it was killed
  std::string output, errors, result;
};

/// A file that a child may be told to write to; what it writes becomes Ended::result.
inline constexpr const char* kResultStream = "/dev/fd/3";
enum class ResultStream { no, yes };

/// Killed and reaped at the end of its life if it still runs. Where this process is a rank of several (mpirun), it is
/// none.
class Child {
 public:
  /// program: a path, or a name that is looked up in PATH. input: what it reads. Throws std::system_error where it
  /// cannot be started.
  Child(const std::string& program, const std::vector<std::string>& arguments, const std::string& input = "",
        ResultStream stream = ResultStream::no);
  Child(Child&& other) noexcept;
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  Child& operator=(Child&&) = delete;
  ~Child();

  pid_t process() const { return process_; }
  /// Absent while it runs.
  std::optional<Ended> poll();
  Ended wait();
  void signal(int number) const;

 private:
  void close_all() const;
  void read_result();
  Ended ended(int status);

  pid_t process_ = -1;
  int output_ = -1, errors_ = -1;
  int result_ = -1;  ///< a pipe's end; -1: there is none
  std::string text_of_result_;
};

}  // namespace torolux::study
