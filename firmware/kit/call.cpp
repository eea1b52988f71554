// SPDX-License-Identifier: MIT
// A call of all PEs together, in words.
#include "firmware/kit/call.hpp"

#include <array>
#include <string_view>

namespace torolux::kit {
namespace {

/// By torolux_type and torolux_operation, which are checked before a Call is made; three bits, and two.
constexpr std::array<std::string_view, 8> kTypes = {"INT32", "UINT32", "INT64", "UINT64", "FLOAT", "DOUBLE", "?", "?"};
constexpr std::array<std::string_view, 4> kOperations = {"SUM", "MINIMUM", "MAXIMUM", "?"};

}  // namespace

Words& operator<<(Words& words, Call call) {
  const std::uint32_t word = call.word_;
  const auto root = [&] { words << (word >> 16U) << ", ..."; };
  const auto joined = [&] {
    words << ", TOROLUX_" << kTypes[word >> 2U & 7U] << ", TOROLUX_" << kOperations[word >> 5U & 3U] << ")";
  };
  switch (static_cast<Call::Kind>(word & 3U)) {
    case Call::Kind::barrier:
      return words << "torolux_barrier()";
    case Call::Kind::broadcast:
      words << "torolux_broadcast(";
      root();
      return words << ")";
    case Call::Kind::reduce:
      words << "torolux_reduce(";
      root();
      break;
    case Call::Kind::all_reduce:
      words << "torolux_all_reduce(...";
      break;
  }
  joined();
  return words;
}

}  // namespace torolux::kit
