// SPDX-License-Identifier: MIT
// The mirror is always as if the processor had done, a while ago, what it has told: a bound that is old is still one.
#include "emulator/remote/network_end.hpp"

#include <algorithm>
#include <string>

#include "emulator/niu/channel_archive.hpp"
#include "emulator/niu/pop_arrival.hpp"

namespace torolux::remote {
namespace {

constexpr auto kRelaxed = std::memory_order_relaxed;

constexpr std::uint64_t kLargestEntry = sizeof(Command) + protocol::kMostMessageBytes;
static_assert(protocol::kMostPacketBytes <= protocol::kMostMessageBytes);
static_assert(kCommandWindow + 3 * kLargestEntry <= kLeastRingBytes, "see kCommandWindow");

}  // namespace

NetworkEnd::NetworkEnd(NiuChannel& channel, StandIns& stand_ins) : channel_(&channel), stand_ins_(&stand_ins) {
  channel.asleep.store(1);  // whatever it is woken for is told
}

void NetworkEnd::resume() {
  told_torus_ = channel_->torus_departures.count.load(kRelaxed);
  told_bus_ = channel_->bus_departures.count.load(kRelaxed);
  told_wakes_ = channel_->wakes.load(kRelaxed);
}

/// Contents go where the network would put them.
void NetworkEnd::push(const Command& command, std::span<const std::byte> contents) {
  if (contents.empty() || channel_->payloads == nullptr) return channel_->commands.push(command, contents);
  Command lending = command;
  lending.payload = channel_->payloads->take_or_make();
  lending.lent = static_cast<std::uint16_t>(contents.size());
  std::ranges::copy(contents, lending.payload->bytes.begin());
  channel_->commands.push(lending, {});
}

void NetworkEnd::push_stand_in(const PacketName& name, const Command& command) {
  Command lending = command;
  lending.payload = channel_->payloads->take_or_make();
  stand_ins_->add(lending.payload, name);
  channel_->commands.push(lending, {});
}

void NetworkEnd::take_command(std::uint32_t pe, ByteReader& rest) {
  const auto command = rest.get<Command>();
  const auto contents = rest.get_bytes(command.bytes);
  const auto refuse = [pe](const std::string& what) {
    throw MachineFailure("PE " + std::to_string(pe) + ": its rank has sent " + what);
  };
  if (contents.size() > kMostBlockBytes || !channel_->commands.has_room(command.bytes))
    refuse("more commands than there is room for");
  received_ += entry_bytes(command);
  if (command.lent == 0) return push(command, contents);
  if (command.kind != CommandKind::send_records || command.lent > kMostBlockBytes || !contents.empty() ||
      channel_->payloads == nullptr)
    refuse("a command without what belongs to it");
  push_stand_in({kept_++, static_cast<std::uint16_t>(pe), command.destination, command.lent}, command);
}

void NetworkEnd::take(const News& news, ByteReader& rest) {
  for (std::uint32_t i = 0; i < news.commands; ++i) take_command(news.pe, rest);
  channel_->clock.store(news.clock, kRelaxed);
  channel_->copied.store(news.copied, kRelaxed);
  channel_->instructions.store(news.instructions, kRelaxed);
  channel_->taken.store(news.taken, kRelaxed);
  channel_->gather_cycles.store(news.gather_cycles, kRelaxed);
  channel_->gather_records.store(news.gather_records, kRelaxed);
  for (std::size_t i = 0; i < kWaitReasons; ++i) channel_->waits[i].store(news.waits[i], kRelaxed);
  channel_->bound.store(news.bound, std::memory_order_release);
  channel_->wait.store(news.wait, std::memory_order_seq_cst);
  woken_ = asked_ = false;
}

bool NetworkEnd::ask() {
  const bool first = !asked_;
  asked_ = true;
  return first;
}

bool NetworkEnd::has_news() const {
  return !channel_->arrivals.empty() || channel_->torus_departures.count.load(kRelaxed) != told_torus_ ||
         channel_->bus_departures.count.load(kRelaxed) != told_bus_ ||
         channel_->horizon.load(kRelaxed) != told_horizon_ || channel_->wakes.load(kRelaxed) != told_wakes_ ||
         (told_consumed_ != received_ && channel_->commands.empty());
}

void NetworkEnd::put_arrival(const Arrival& arrival, ByteWriter& words) {
  Arrival header = with_contents_behind(arrival);
  const auto name = arrival.payload != nullptr ? stand_ins_->remove(arrival.payload) : std::nullopt;
  if (name) {
    header.lent = static_cast<std::uint16_t>(header.bytes);
    header.bytes = 0;
    words.put(header);
    words.put(*name);
  } else {
    words.put(header);
    words.put_bytes(contents_of(arrival));
  }
}

bool NetworkEnd::collect(unsigned pe, ByteWriter& words) {
  channel_->asleep.store(1, kRelaxed);
  if (has_news()) {
    woken_ = false;
  } else if (!wakes_ || woken_) {  // it has been woken for all that there is
    wakes_ = false;
    return false;
  }
  if (channel_->commands.empty()) told_consumed_ = received_;
  const std::size_t at = words.size();
  words.put(Words{});
  const auto depart = [&words](const Departures& departures, std::uint64_t& told) {
    const std::uint64_t count = departures.count.load(kRelaxed);
    for (; told < count; ++told) words.put(departures.when(told));
  };
  depart(channel_->torus_departures, told_torus_);
  depart(channel_->bus_departures, told_bus_);
  std::uint32_t arrivals = 0;
  for (; const Arrival* arrival = channel_->arrivals.front(); ++arrivals) {
    put_arrival(*arrival, words);
    pop_arrival(*channel_, *arrival);
  }
  told_horizon_ = channel_->horizon.load(kRelaxed);
  told_wakes_ = channel_->wakes.load(kRelaxed);
  const std::uint64_t wake_time = channel_->wake_time.load(kRelaxed);
  words.replace(at, Words{pe, arrivals, told_torus_, told_bus_, told_horizon_, wake_time, told_wakes_, told_consumed_,
                          wakes_ ? 1U : 0U});
  woken_ = wakes_;
  wakes_ = false;
  return true;
}

}  // namespace torolux::remote
