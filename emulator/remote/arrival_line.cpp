// SPDX-License-Identifier: MIT
// What cannot go into the ring yet, for want of room or of its payload, holds back all that the network has told behind
// it: the processor sees what it would see if the network were slower.
#include "emulator/remote/arrival_line.hpp"

#include <algorithm>
#include <string>

#include "emulator/errors.hpp"
#include "emulator/niu/channel_archive.hpp"

namespace torolux::remote {
namespace {

constexpr auto kRelaxed = std::memory_order_relaxed;

[[noreturn]] void refuse(const PacketName& name, const std::string& what) {
  throw MachineFailure("packet " + std::to_string(name.number) + " of PE " + std::to_string(name.source) + " to PE " +
                       std::to_string(name.destination) + ": " + what);
}

}  // namespace

ArrivalLine::Late ArrivalLine::next_of(ByteReader& rest) const {
  Late late{rest.get<Arrival>(), {}, {}};
  if (late.arrival.lent != 0) {
    late.name = rest.get<PacketName>();
    const PacketName& name = *late.name;
    if (name.destination != number_ || name.source != late.arrival.source || name.bytes != late.arrival.lent)
      refuse(name, "rank 0 tells PE " + std::to_string(number_) + " of it as of another");
    late.arrival.lent = 0;
    late.arrival.bytes = name.bytes;
  } else {
    const auto payload = rest.get_bytes(late.arrival.bytes);
    late.payload.assign(payload.begin(), payload.end());
  }
  return late;
}

void ArrivalLine::take(const Words& words, ByteReader& rest) {
  for (std::uint32_t i = 0; i < words.arrivals; ++i) {
    Late late = next_of(rest);
    if (!late_.empty() || !push(late)) late_.push_back(std::move(late));
  }
  wakes_ = words.wakes;
  wake_time_ = words.wake_time;
  horizon_ = words.horizon;
  publish();
}

/// False: it cannot yet.
bool ArrivalLine::push(const Late& late) {
  if (!channel_->arrivals.has_room(late.arrival.bytes)) return false;
  if (late.name) {
    const auto found = kept_.find(key(*late.name));
    if (found == kept_.end()) return false;
    if (found->second.size() != late.arrival.bytes) refuse(*late.name, "its payload has another length");
    channel_->arrivals.push(late.arrival, found->second);
    kept_.erase(found);
  } else {
    channel_->arrivals.push(late.arrival, late.payload);
  }
  ++pushed_;
  return true;
}

void ArrivalLine::keep(const PacketName& name, std::span<const std::byte> payload) {
  const bool is_new = kept_.try_emplace(key(name), payload.begin(), payload.end()).second;
  if (!is_new) refuse(name, "its payload has come twice");
}

bool ArrivalLine::refill() {
  if (late_.empty()) return false;
  const std::size_t before = late_.size();
  while (!late_.empty() && push(late_.front())) late_.pop_front();
  if (late_.size() == before) return false;
  publish();
  return true;
}

/// What waits here is not known to the processor. A wake-up is for an arrival that it finds in its ring.
void ArrivalLine::publish() {
  if (wakes_ != channel_->wakes.load(kRelaxed) && wakes_ <= pushed_) {
    channel_->wake_time.store(wake_time_, kRelaxed);
    channel_->wakes.store(wakes_, std::memory_order_seq_cst);
  }
  const std::uint64_t horizon = late_.empty() ? horizon_ : std::min(horizon_, late_.front().arrival.time);
  if (horizon > channel_->horizon.load(kRelaxed)) channel_->horizon.store(horizon, std::memory_order_seq_cst);
}

std::optional<PacketName> ArrivalLine::awaited() const {
  if (late_.empty() || !late_.front().name || has(*late_.front().name)) return std::nullopt;
  return late_.front().name;
}

std::optional<PacketName> ArrivalLine::missing() const {
  const auto lacks = [this](const Late& late) { return late.name && !has(*late.name); };
  const auto first = std::ranges::find_if(late_, lacks);
  return first == late_.end() ? std::nullopt : first->name;
}

std::vector<std::byte> ArrivalLine::give(const PacketName& name) {
  const auto found = kept_.find(key(name));
  if (found == kept_.end() || found->second.size() != name.bytes) refuse(name, "its payload is not here");
  std::vector<std::byte> payload = std::move(found->second);
  kept_.erase(found);
  return payload;
}

std::size_t ArrivalLine::unnamed() const {
  const auto named = [this](const Late& late) { return late.name && has(*late.name); };
  return kept_.size() - static_cast<std::size_t>(std::ranges::count_if(late_, named));
}

void ArrivalLine::save(SnapshotWriter& archive) const {
  std::uint64_t count = late_.size();
  channel_->arrivals.for_each([&count](const Arrival&) { ++count; });
  archive(count);
  channel_->arrivals.for_each(
      [&archive](const Arrival& arrival) { archive_arrival(archive, arrival, contents_of(arrival)); });
  for (const Late& late : late_)
    archive_arrival(archive, late.arrival, late.name ? kept_.at(key(*late.name)) : late.payload);
}

}  // namespace torolux::remote
