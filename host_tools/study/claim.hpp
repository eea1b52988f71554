// SPDX-License-Identifier: MIT
// A lock file beside a result: whoever has it does the run, so that several processes, on several computers with one
// folder, share a study. Locks save work and nothing else: should two do the same run, both write the same result, each
// whole.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

namespace torolux::study {

/// How often a holder shows that it lives, and how long another computer believes it without that.
inline constexpr std::chrono::seconds kHeartbeat{10};
inline constexpr std::chrono::seconds kBelieved{60};

class Claim {
 public:
  /// Absent: another process has it that lives, or whose run still goes on (a study that was killed leaves its runs
  /// behind, which finish). A lock that a dead process left is taken over. Throws InputError where no file can be made.
  static std::optional<Claim> take(const std::filesystem::path& lock);

  Claim(Claim&& other) noexcept;
  Claim(const Claim&) = delete;
  Claim& operator=(const Claim&) = delete;
  Claim& operator=(Claim&&) = delete;
  /// Removes the lock.
  ~Claim();

  /// The process that does the run.
  void note_child(pid_t child) const;
  void show_life() const;

 private:
  explicit Claim(std::filesystem::path lock) : lock_(std::move(lock)) {}

  std::filesystem::path lock_;
};

}  // namespace torolux::study
