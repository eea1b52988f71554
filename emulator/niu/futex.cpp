// SPDX-License-Identifier: MIT
// Sleeping on a word of shared memory, by the Linux futex call.
#include "emulator/niu/futex.hpp"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <climits>
#include <ctime>

namespace torolux {

void futex_wait(std::atomic<std::uint32_t>& word, std::uint32_t value, std::chrono::microseconds longest) {
  timespec time{};
  time.tv_sec = static_cast<time_t>(longest.count() / 1'000'000);
  time.tv_nsec = static_cast<long>(longest.count() % 1'000'000 * 1000);
  syscall(SYS_futex, &word, FUTEX_WAIT, value, &time, nullptr, 0);
}

void futex_wake(std::atomic<std::uint32_t>& word) {
  syscall(SYS_futex, &word, FUTEX_WAKE, INT_MAX, nullptr, nullptr, 0);
}

}  // namespace torolux
