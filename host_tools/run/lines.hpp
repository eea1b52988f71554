// SPDX-License-Identifier: MIT
// Bytes that PEs write, in pieces, enter; whole lines leave, each when its end has come.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <unordered_map>

#include "host_tools/run/pe_text.hpp"

namespace torolux {

class Lines {
 public:
  /// A longer line leaves in pieces [bytes].
  static constexpr std::size_t kLongest = 65536;

  explicit Lines(std::function<void(const PeText&)> on_line) : on_line_(std::move(on_line)) {}
  void add(PeNumber pe, PeStream stream, Cycles now, std::span<const std::byte> bytes);
  /// What is left of all PEs, in the order of their numbers, standard output first.
  void finish(Cycles now);

 private:
  static constexpr std::size_t kStreams = 2;
  std::function<void(const PeText&)> on_line_;
  std::unordered_map<PeNumber, std::array<std::string, kStreams>> unfinished_;
};

}  // namespace torolux
