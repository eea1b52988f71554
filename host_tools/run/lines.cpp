// SPDX-License-Identifier: MIT
// Pieces into lines, for each PE and stream.
#include "host_tools/run/lines.hpp"

#include <map>

namespace torolux {

void Lines::add(PeNumber pe, PeStream stream, Cycles now, std::span<const std::byte> bytes) {
  std::string& line = unfinished_[pe][static_cast<std::size_t>(stream)];
  const auto say = [&](bool ended) {
    on_line_({now, pe, line, stream, ended});
    line.clear();
  };
  for (const std::byte byte : bytes) {
    if (byte == std::byte{'\n'}) {
      say(true);
      continue;
    }
    line += static_cast<char>(byte);
    if (line.size() == kLongest) say(false);
  }
}

void Lines::finish(Cycles now) {
  const std::map<PeNumber, std::array<std::string, kStreams>> in_order(unfinished_.begin(), unfinished_.end());
  unfinished_.clear();
  for (const auto& [pe, streams] : in_order) {
    for (std::size_t stream = 0; stream < kStreams; ++stream) {
      if (!streams[stream].empty()) on_line_({now, pe, streams[stream], static_cast<PeStream>(stream), false});
    }
  }
}

}  // namespace torolux
