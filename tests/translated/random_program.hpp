// SPDX-License-Identifier: MIT
// Random programs: a loop over random instructions whose registers and memory end up in local memory.
#pragma once

#include <cstdint>

#include "tests/translated/runs.hpp"

namespace torolux::test {

struct RandomProgram {
  Image image;
  Fill fill;  ///< random contents of the data, with many special values
};

/// The same seed always gives the same program. instructions: executed in all, roughly.
/// sees_flags: the program reads fflags now and then, so the translator must keep them exact.
RandomProgram make_random_program(std::uint64_t seed, std::uint64_t instructions, bool sees_flags);

}  // namespace torolux::test
