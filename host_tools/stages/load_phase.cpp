// SPDX-License-Identifier: MIT
// Layouts first; then stores in blocks of at most one message, where a PE's image differs from what it has been sent;
// then `begin`, which each PE answers with `ready`.
#include "host_tools/stages/load_phase.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "firmware/protocol/store_names.hpp"

namespace torolux {
namespace {

using protocol::StoreName;
using Bytes = std::span<const std::byte>;

/// PEs loaded at a time where each is sent all that it has: enough to keep the bus busy, few enough that the host need
/// not hold all images at once.
constexpr unsigned kLoadedAtOnce = 64;
/// Where an image differs from what all have heard by less than this in between, one message carries both places.
constexpr std::size_t kLeastGap = 64;
/// Looked at in one piece, where a PE's image and what it has are mostly alike.
constexpr std::size_t kAlike = 256;

/// A store's bytes in an image, padding up to a multiple of 4 included.
Bytes bytes_of(const protocol::StageLayout& layout, Bytes image, const protocol::StoreExtent& extent) {
  if (extent.store.count == 0) return {};
  const std::size_t begin = extent.store.address - layout.cell_words.address;
  return image.subspan(begin, (static_cast<std::size_t>(extent.bytes()) + 3) / 4 * 4);
}

/// Head and bytes as one message.
template <class Head>
class Block {
 public:
  Block(const Head& head, Bytes bytes) : size_(sizeof head + bytes.size()) {
    std::memcpy(message_.data(), &head, sizeof head);
    std::memcpy(message_.data() + sizeof head, bytes.data(), bytes.size());
  }
  Bytes bytes() const { return Bytes(message_).first(size_); }

 private:
  std::array<std::byte, protocol::kMostMessageBytes> message_;
  std::size_t size_;
};

void send_bytes(HostPort& port, PeNumber pe, std::uint32_t address, Bytes bytes) {
  port.work(HostWork::layout, host_lines(bytes.size()));
  for (std::size_t at = 0; at < bytes.size(); at += protocol::kMostLoadBytes) {
    const Bytes part = bytes.subspan(at, std::min<std::size_t>(protocol::kMostLoadBytes, bytes.size() - at));
    const protocol::LoadBlock head{address + static_cast<std::uint32_t>(at), static_cast<std::uint32_t>(part.size())};
    port.send_message(pe, static_cast<std::uint16_t>(protocol::MessageKind::load), Block(head, part).bytes());
  }
}

/// What of a store's bytes the PE does not have yet. there: what it has, from the store's beginning on.
void send_difference(HostPort& port, PeNumber pe, std::uint32_t address, Bytes wanted, Bytes there) {
  const auto differs = [&](std::size_t at) {
    return at + 4 > there.size() || std::memcmp(wanted.data() + at, there.data() + at, 4) != 0;
  };
  const std::size_t both = std::min(wanted.size(), there.size());
  for (std::size_t begin = 0; begin < wanted.size(); begin += 4) {
    while (begin + kAlike <= both && std::memcmp(wanted.data() + begin, there.data() + begin, kAlike) == 0) {
      begin += kAlike;
    }
    if (begin == wanted.size() || !differs(begin)) continue;
    std::size_t end = begin + 4;
    for (std::size_t at = end; at < wanted.size() && at - end < kLeastGap; at += 4) {
      if (differs(at)) end = at + 4;
    }
    send_bytes(port, pe, address + static_cast<std::uint32_t>(begin), wanted.subspan(begin, end - begin));
    begin = end - 4;
  }
}

}  // namespace

LoadPhase::LoadPhase(unsigned pes, Loads loads) : pes_(pes), loads_(std::move(loads)) {}

void LoadPhase::start(HostPort& port) {
  for (unsigned pe = 0; pe < pes_; ++pe) {
    layouts_.push_back(loads_.layout(static_cast<PeNumber>(pe)));
    port.work(HostWork::layout, host_lines(sizeof layouts_.back()));
    send(port, static_cast<PeNumber>(pe), protocol::MessageKind::configure, layouts_.back());
  }
  if (loads_.common) send_common(port);
  const unsigned at_once = loads_.common ? pes_ : kLoadedAtOnce;
  while (started_ < std::min(pes_, at_once)) load(port, static_cast<PeNumber>(started_++));
}

void LoadPhase::restore(SnapshotReader& archive) {
  archive(started_, ready_);
  for (unsigned pe = 0; pe < pes_; ++pe) layouts_.push_back(loads_.layout(static_cast<PeNumber>(pe)));
}

void LoadPhase::on_message(HostPort& port, PeNumber source, protocol::MessageKind kind, std::span<const std::byte>) {
  if (kind != protocol::MessageKind::ready) unexpected(source, kind, "loading");
  ++ready_;
  if (started_ < pes_) load(port, static_cast<PeNumber>(started_++));
}

void LoadPhase::send_common(HostPort& port) const {
  const auto extents = protocol::store_extents(loads_.common->layout);
  for (std::uint32_t name = 0; name < extents.size(); ++name) {
    if (StoreName{name} == StoreName::record_slots) continue;
    const Bytes bytes = bytes_of(loads_.common->layout, loads_.common->image, extents[name]);
    port.work(HostWork::layout, host_lines(bytes.size()));
    for (std::size_t at = 0; at < bytes.size(); at += protocol::kMostLoadStoreBytes) {
      const Bytes part = bytes.subspan(at, std::min<std::size_t>(protocol::kMostLoadStoreBytes, bytes.size() - at));
      const protocol::LoadStore head{name, static_cast<std::uint32_t>(at), static_cast<std::uint32_t>(part.size())};
      port.broadcast(static_cast<std::uint16_t>(protocol::MessageKind::load_store), Block(head, part).bytes());
    }
  }
}

/// Elements need not be sent: the PE has cleared them.
void LoadPhase::load(HostPort& port, PeNumber pe) {
  const protocol::StageLayout& layout = layouts_[pe];
  const std::vector<std::byte> image = loads_.image(pe);
  const auto extents = protocol::store_extents(layout);
  std::array<protocol::StoreExtent, protocol::kStores> common{};
  if (loads_.common) common = protocol::store_extents(loads_.common->layout);
  for (std::uint32_t name = 0; name < extents.size(); ++name) {
    if (StoreName{name} == StoreName::record_slots || StoreName{name} == StoreName::elements) continue;
    Bytes there;
    if (loads_.common) there = bytes_of(loads_.common->layout, loads_.common->image, common[name]);
    send_difference(port, pe, extents[name].store.address, bytes_of(layout, image, extents[name]), there);
  }
  send(port, pe, protocol::MessageKind::begin);
}

}  // namespace torolux
