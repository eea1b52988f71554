// SPDX-License-Identifier: MIT
// Symbols with a size are painted over the code, later ones over earlier ones; labels fill what is left.
#include "emulator/profile/function_table.hpp"

#include <algorithm>
#include <limits>
#include <string_view>

#include "emulator/engines/image/debug_info.hpp"

namespace torolux::profile {
namespace {

constexpr std::string_view kNoName = "[no symbol]";
constexpr std::string_view kCold = ".cold";                // GCC: seldom used parts, apart from their function
constexpr std::string_view kRestore = "__riscv_restore_";  // libgcc

/// As it stands in the source, without what the compiler adds to tell parts apart.
std::string name_of(const ImageSymbol& symbol) {
  return demangled(symbol.name.substr(0, symbol.name.find(kCold)));
}

}  // namespace

FunctionTable::FunctionTable(const Image& image) : ranges_(1) {
  number_of(std::string(kNoName));
  std::uint64_t end = 0;
  begin_ = std::numeric_limits<std::uint32_t>::max();
  for (const ImageSegment& segment : image.segments) {
    if (!segment.executable) continue;
    begin_ = std::min(begin_, segment.address);
    end = std::max(end, std::uint64_t{segment.address} + segment.memory_bytes);
  }
  if (end <= begin_) return;
  std::vector<FunctionNumber> function_of((end - begin_) / 2, kUnnamed);
  std::vector<bool> begins(function_of.size());
  const auto paint = [&](std::uint32_t from, std::uint64_t to, const ImageSymbol& symbol, bool over) {
    const std::size_t first = (from - begin_) / 2;
    if (first >= function_of.size() || (!over && function_of[first] != kUnnamed)) return;
    const FunctionNumber function = number_of(name_of(symbol));
    begins[first] = true;
    const std::size_t last = (std::min(to, end) - begin_ + 1) / 2;
    for (std::size_t i = first; i < std::min(last, function_of.size()); ++i) {
      if (!over && function_of[i] != kUnnamed) break;
      function_of[i] = function;
    }
  };
  const std::vector<ImageSymbol>& symbols = image.symbols;
  for (const ImageSymbol& symbol : symbols) {
    if (symbol.function && symbol.bytes != 0 && symbol.address >= begin_)
      paint(symbol.address, std::uint64_t{symbol.address} + symbol.bytes, symbol, true);
  }
  for (std::size_t i = 0; i < symbols.size(); ++i) {
    if ((symbols[i].function && symbols[i].bytes != 0) || symbols[i].address < begin_) continue;
    paint(symbols[i].address, i + 1 < symbols.size() ? symbols[i + 1].address : end, symbols[i], false);
  }
  cut_into_ranges(function_of, begins);
}

FunctionNumber FunctionTable::number_of(const std::string& name) {
  const auto found = std::find(names_.begin(), names_.end(), name);
  if (found != names_.end()) return static_cast<FunctionNumber>(found - names_.begin());
  names_.push_back(name);
  restores_.push_back(name.starts_with(kRestore));
  return static_cast<FunctionNumber>(names_.size() - 1);
}

void FunctionTable::cut_into_ranges(const std::vector<FunctionNumber>& function_of, const std::vector<bool>& begins) {
  range_of_.resize(function_of.size());
  for (std::size_t i = 0; i < function_of.size(); ++i) {
    const auto address = static_cast<std::uint32_t>(begin_ + 2 * i);
    if (i == 0 || function_of[i] != function_of[i - 1]) ranges_.push_back({address, 0, function_of[i]});
    if (begins[i]) entries_.push_back(address);
    ranges_.back().bytes += 2;
    range_of_[i] = static_cast<std::uint32_t>(ranges_.size() - 1);
  }
}

bool FunctionTable::begins_at(std::uint32_t address) const {
  return std::binary_search(entries_.begin(), entries_.end(), address);
}

}  // namespace torolux::profile
