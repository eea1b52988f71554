// SPDX-License-Identifier: MIT
// Virtual time is held to a line over the page's time; a packet's place is between the times of its last hop.
#include "host_tools/display/pace.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "emulator/errors.hpp"
#include "emulator/torus/shape.hpp"
#include "host_tools/display/messages.hpp"

namespace torolux {
namespace {

constexpr double kMostSpeed = 1e12;  // [cycles/s]
/// Hops that are remembered; far more than fit into the buffers of a machine whose packets can be told apart.
constexpr std::size_t kMostHops = std::size_t{1} << 16U;

Step step_named(const std::string& name) {
  if (name == "event") return Step::event;
  if (name == "packet") return Step::packet;
  if (name == "round") return Step::round;
  throw InputError("step \"" + name + "\": allowed are event, packet and round");
}

}  // namespace

void Pace::obey(const nlohmann::json& values, Clock::time_point now) {
  from_ = present(now);
  since_ = now;
  if (const auto step = values.find("step"); step != values.end()) {
    step_ = step_named(step->is_string() ? step->get<std::string>() : step->dump());
    steps_ = true;
    free_ = false;
    speed_ = 0;
    return;
  }
  const auto speed = values.find("speed");
  if (speed == values.end()) throw InputError("pace: there is neither speed nor step");
  if (*speed == "free") {
    return go_free();
  }
  if (!speed->is_number() || !(speed->get<double>() >= 0 && speed->get<double>() <= kMostSpeed)) {
    throw InputError("speed: allowed are \"free\" and 0 to 1e12 cycles in a second");
  }
  speed_ = speed->get<double>();
  steps_ = false;
  free_ = false;
}

void Pace::go_free() {
  free_ = true;
  hops_.clear();
}

/// Between the last event and the next one.
Cycles Pace::present(Clock::time_point now) const {
  if (free_ || speed_ == 0) return std::max(from_, happened_);
  const double passed = std::chrono::duration<double>(now - since_).count() * speed_;
  const auto reached = from_ + static_cast<Cycles>(std::min(passed, kMostSpeed));
  return std::max(happened_, std::min(reached, std::max(next_, happened_)));
}

bool Pace::lets(Cycles next, Clock::time_point now) {
  next_ = next;
  if (steps_) {
    if (step_ == Step::event) steps_ = false;
  } else if (speed_ == 0 || static_cast<double>(next) - static_cast<double>(from_) >
                                std::chrono::duration<double>(now - since_).count() * speed_) {
    return false;
  }
  happened_ = next;
  return true;
}

void Pace::passed(Step what) {
  if (steps_ && what == step_) steps_ = false;
}

void Pace::note(const Block& packet, const Hop& hop) {
  if (hops_.size() >= kMostHops && !hops_.contains(packet.number)) return;
  hops_[packet.number] = hop;
}

void Pace::entered(unsigned pe, const Block& packet) {
  if (free_) return;
  note(packet, {packet.source, packet.destination, packet.records, static_cast<std::uint16_t>(pe), PacketPlace::kWaits,
                happened_, happened_});
}

void Pace::leaves(unsigned router, std::size_t output, const Block& packet, Cycles start, Cycles arrives) {
  if (free_) return;
  const auto way = output == index_of(Port::local) ? PacketPlace::kLeaves : static_cast<std::uint8_t>(output);
  note(packet,
       {packet.source, packet.destination, packet.records, static_cast<std::uint16_t>(router), way, start, arrives});
}

std::string Pace::packets() {
  const Cycles now = present(Clock::now());
  std::erase_if(hops_, [now](const auto& entry) {
    return entry.second.way == PacketPlace::kLeaves && entry.second.arrives < now;
  });
  const std::size_t shown = std::min(hops_.size(), kMostPackets);
  std::string contents;
  contents.reserve(sizeof(PacketsHeader) + shown * sizeof(PacketPlace));
  append_bytes(contents, PacketsHeader{now, free_ ? -1.0 : speed_, static_cast<std::uint32_t>(shown),
                                       static_cast<std::uint32_t>(hops_.size() - shown)});
  std::size_t left = shown;
  for (const auto& [number, hop] : hops_) {
    if (left-- == 0) break;
    const double way = static_cast<double>(std::max<Cycles>(1, hop.arrives - hop.start));
    const double gone = now > hop.start ? static_cast<double>(now - hop.start) : 0;
    const auto part = static_cast<std::uint8_t>(std::lround(255 * std::min(1.0, gone / way)));
    // Of the number, the source's own count and the source both tell packets apart.
    const auto name = static_cast<std::uint32_t>((number & 0xFFFFU) << 16U) | hop.source;
    append_bytes(contents, PacketPlace{name, hop.source, hop.destination, hop.router, hop.records, hop.way, part, 0});
  }
  return contents;
}

}  // namespace torolux
