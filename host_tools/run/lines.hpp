// SPDX-License-Identifier: MIT
// Bytes that PEs write, in pieces, enter; whole lines leave, each when its end has come.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "emulator/snapshot/archive.hpp"
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
  /// All of it that a run changes.
  template <class Archive>
  void archive(Archive& archive) {
    std::vector<Unfinished> all;
    for (const auto& [pe, texts] : unfinished_) all.push_back({pe, texts});
    archive(all);
    unfinished_.clear();
    for (Unfinished& one : all) unfinished_[one.pe] = std::move(one.texts);
  }

 private:
  static constexpr std::size_t kStreams = 2;
  struct Unfinished {
    PeNumber pe;
    std::array<std::string, kStreams> texts;

    template <class Archive>
    void archive(Archive& archive) {
      archive(pe, texts);
    }
  };
  std::function<void(const PeText&)> on_line_;
  std::unordered_map<PeNumber, std::array<std::string, kStreams>> unfinished_;
};

}  // namespace torolux
