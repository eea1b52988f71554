// SPDX-License-Identifier: MIT
// See load_phase.hpp.
#include "host_tools/stages/load_phase.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace torolux {
namespace {

/// PEs loaded at a time: enough to keep the bus busy, few enough that the host need not hold all images at once.
constexpr unsigned kLoadedAtOnce = 64;

}  // namespace

LoadPhase::LoadPhase(unsigned pes, std::function<PeLoad(PeNumber)> load_of) : pes_(pes), load_of_(std::move(load_of)) {}

void LoadPhase::start(HostPort& port) {
  while (started_ < std::min(pes_, kLoadedAtOnce)) load(port, static_cast<PeNumber>(started_++));
}

void LoadPhase::on_message(HostPort& port, PeNumber source, protocol::MessageKind kind, std::span<const std::byte>) {
  if (kind != protocol::MessageKind::ready) unexpected(source, kind, "loading");
  ++ready_;
  if (started_ < pes_) load(port, static_cast<PeNumber>(started_++));
}

void LoadPhase::load(HostPort& port, PeNumber pe) const {
  const PeLoad load = load_of_(pe);
  port.work(HostWork::layout, host_lines(sizeof load.layout + load.image.size()));
  send(port, pe, protocol::MessageKind::configure, load.layout);
  std::array<std::byte, protocol::kMostMessageBytes> message{};
  for (std::size_t at = 0; at < load.image.size(); at += protocol::kMostLoadBytes) {
    const std::size_t bytes = std::min<std::size_t>(protocol::kMostLoadBytes, load.image.size() - at);
    const protocol::LoadBlock block{load.layout.cell_words.address + static_cast<std::uint32_t>(at),
                                    static_cast<std::uint32_t>(bytes)};
    std::memcpy(message.data(), &block, sizeof block);
    std::memcpy(message.data() + sizeof block, load.image.data() + at, bytes);
    port.send_message(pe, static_cast<std::uint16_t>(protocol::MessageKind::load),
                      std::span(message).first(sizeof block + bytes));
  }
  send(port, pe, protocol::MessageKind::begin);
}

}  // namespace torolux
