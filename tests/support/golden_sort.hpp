// SPDX-License-Identifier: MIT
// One run of an image whose trace hash every way of running it must leave: threads, ranks, their launcher, placing.
#pragma once

#include <array>
#include <cstdint>

namespace torolux::test {

/// sort.elf with these arguments on so many PEs of 1 MiB, parameters of the machine as built in.
inline constexpr std::array<const char*, 2> kGoldenArguments = {"3000", "check"};
inline constexpr unsigned kGoldenColumns = 4, kGoldenRows = 3;
/// Changes with whatever changes the order or the times of events, but of hops: the program, its compiler, the
/// machine's parameters.
inline constexpr std::uint64_t kGoldenTraceHash = 11'175'078'867'820'923'006U;

}  // namespace torolux::test
