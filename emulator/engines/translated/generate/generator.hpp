// SPDX-License-Identifier: MIT
// Writes translated code: a function of the program in, the C++ text of functions of the host out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "emulator/engines/translated/analysis/blocks.hpp"
#include "emulator/engines/translated/analysis/liveness.hpp"
#include "emulator/engines/translated/generate/semantics_text.hpp"

namespace torolux::translated {

/// Names of tables of RegionFunction in the shared object, by number of the function.
inline constexpr const char* kCalledTable = "called_functions";
inline constexpr const char* kResumedTable = "resumed_functions";
/// Name of the EnterFunction.
inline constexpr const char* kEnter = "enter";

/// A function of the program.
struct GuestFunction {
  std::uint32_t begin;                ///< where it is called
  std::uint32_t first, bytes;         ///< all its code
  std::vector<std::uint32_t> blocks;  ///< ascending addresses
};

/// Every block belongs to one function. Makes entries of blocks that are reached from another.
std::vector<GuestFunction> make_functions(const CodeMap& code, Blocks& blocks);

/// Translation units with, for each function of the program, two of the host: one is called at its beginning, one goes
/// on in the middle, at any entry. The first is the fast one: its flow of control is that of the program's source.
std::vector<SourceText> generate(const CodeMap& code, const Blocks& blocks, const Liveness& liveness,
                                 const std::vector<GuestFunction>& functions);

}  // namespace torolux::translated
