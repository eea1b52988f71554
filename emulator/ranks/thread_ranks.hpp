// SPDX-License-Identifier: MIT
// What each rank does enters; it is done by a thread for each in this process, with messages that are late at random.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "emulator/ranks/transport.hpp"

namespace torolux::ranks {

struct Delays {
  std::uint64_t seed = 0;
  std::chrono::microseconds most{0};  ///< each message is late by a hash of seed, ranks and its number, up to this
};

/// Runs `rank` once for each of `count` ranks and waits for all. Leaves what each threw, by rank; empty: it returned. A
/// rank that returns without `close` is lost without a word, as a process that was killed.
std::vector<std::string> run_as_threads(unsigned count, const Delays& delays,
                                        const std::function<void(Transport&)>& rank);

}  // namespace torolux::ranks
