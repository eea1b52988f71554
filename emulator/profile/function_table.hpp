// SPDX-License-Identifier: MIT
// An image's symbols enter; the function that an address of code lies in leaves.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "emulator/engines/image/image.hpp"

namespace torolux::profile {

using FunctionNumber = std::uint32_t;
/// What lies in no function that the image names.
inline constexpr FunctionNumber kUnnamed = 0;

/// Code without a gap that belongs to one function.
struct CodeRange {
  std::uint32_t begin = 0;
  std::uint32_t bytes = 0;
  FunctionNumber function = kUnnamed;
};

/// Functions are told apart by name: what the compiler has moved out of one (`.cold`) belongs to it. A label of
/// assembler that lies in no function with a size is one itself, up to the next symbol.
class FunctionTable {
 public:
  explicit FunctionTable(const Image& image);

  /// Of any address; outside the code it is an empty range of kUnnamed.
  const CodeRange& range_at(std::uint32_t address) const {
    const std::uint32_t index = (address - begin_) / 2;
    return ranges_[index < range_of_.size() ? range_of_[index] : 0];
  }
  /// Whether a function begins there: to jump there is to call it.
  bool begins_at(std::uint32_t address) const;
  /// number: less than size().
  const std::string& name(FunctionNumber number) const { return names_[number]; }
  /// Whether callers return from it by jumping there (the compiler's -msave-restore).
  bool restores(FunctionNumber number) const { return restores_[number]; }
  std::size_t size() const { return names_.size(); }

 private:
  FunctionNumber number_of(const std::string& name);
  void cut_into_ranges(const std::vector<FunctionNumber>& function_of, const std::vector<bool>& begins);

  std::uint32_t begin_ = 0;              // first address of code
  std::vector<std::uint32_t> range_of_;  // by half word from begin_ on: index of ranges_
  std::vector<CodeRange> ranges_;        // the first is that of no code
  std::vector<std::uint32_t> entries_;   // ascending
  std::vector<std::string> names_;       // the first is that of what has none
  std::vector<bool> restores_;
};

}  // namespace torolux::profile
