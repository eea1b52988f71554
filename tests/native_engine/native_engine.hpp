// SPDX-License-Identifier: MIT
// The engine `native` for tests: each PE is a thread of this process that runs a C++ function. Enters: HINTs of that
// function; leaves: calls of the real NiuProcessorSide. Everything else of the machine is the emulator's own.
#pragma once

#include <cstdint>
#include <functional>

#include "emulator/engines/engine/engine.hpp"
#include "firmware/niu/niu.hpp"

namespace torolux::test {

/// Lets a native program take time: nothing else costs any but HINTs.
class NativeClock {
 public:
  void spend(std::uint64_t cycles) { cycles_ += cycles; }

  std::uint64_t cycles() const { return cycles_; }
  std::uint64_t spent() const { return spent_; }
  void set(std::uint64_t cycles) { cycles_ = cycles; }
  void hint(std::uint64_t cost) {
    cycles_ += cost;
    spent_ += 1;
  }

 private:
  std::uint64_t cycles_ = 0;
  std::uint64_t spent_ = 0;  // HINTs; they stand for instructions
};

/// What one PE runs; it halts when it returns.
using NativeProgram = std::function<void(pe::Niu&, NativeClock&)>;

struct NativeOptions {
  std::uint32_t cycles_per_hint = 200;  ///< >= 1; markers cost nothing
  /// Called by the PE's thread before each HINT with the PE's number: tests shake the threads' timing here.
  std::function<void(unsigned)> before_hint;
};

/// Makes `native` the engine that runs `program` on every PE; replaces an earlier one.
void register_native_engine(NativeProgram program, NativeOptions options = {});

/// An image without code for programs that need none: a NIU window and free memory behind it.
Image empty_image();

}  // namespace torolux::test
