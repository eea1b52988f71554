// SPDX-License-Identifier: MIT
// Sleeping on a word of shared memory until another thread or process changes it.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>

namespace torolux {

/// Sleeps while `word` holds `value`, at most `longest`. May return early.
void futex_wait(std::atomic<std::uint32_t>& word, std::uint32_t value, std::chrono::microseconds longest);
/// Wakes whoever sleeps on `word`.
void futex_wake(std::atomic<std::uint32_t>& word);

}  // namespace torolux
