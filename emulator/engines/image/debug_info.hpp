// SPDX-License-Identifier: MIT
// What an ELF file tells a debugger (DWARF, -g). Enters: the file's bytes; leaves: for an address of code the functions
// and lines that it lies in, and for a stack frame the registers of its caller. Believes nothing that it reads.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace torolux {

/// Where code stands in its source.
struct SourcePlace {
  std::string function;  ///< as in the source; "": unknown
  std::string file;      ///< from the folder in which the compiler ran; "": unknown
  int line = 0;
};

/// Of a call that has not returned: what is known of x0..x31, and where it stands.
struct FrameRegisters {
  std::uint32_t pc = 0;
  std::array<std::optional<std::uint32_t>, 32> x;

  const std::optional<std::uint32_t>& return_address() const { return x[1]; }
  const std::optional<std::uint32_t>& stack_pointer() const { return x[2]; }
};

/// A word of local memory; nothing where it has none.
using ReadWord = std::function<std::optional<std::uint32_t>(std::uint32_t address)>;

class DebugInfo {
 public:
  /// Of an ELF file, or of anything else: then it knows nothing.
  explicit DebugInfo(std::vector<std::byte> contents);
  DebugInfo(const DebugInfo&) = delete;
  DebugInfo& operator=(const DebugInfo&) = delete;
  ~DebugInfo();

  /// Innermost first: what was inlined at this address, one into the other, and last the function that the code is of.
  /// Empty: nothing is known.
  std::vector<SourcePlace> places(std::uint32_t address) const;

  /// Whether the file says how the registers of a caller are found from the function at this address.
  bool knows_frame(std::uint32_t address) const;
  /// The caller of `frame`, whose own code is at `address`. Nothing: it cannot be told.
  std::optional<FrameRegisters> caller(const FrameRegisters& frame, std::uint32_t address, const ReadWord& read) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// A C++ name as it stands in the source; others as they are.
std::string demangled(const std::string& name);

}  // namespace torolux
