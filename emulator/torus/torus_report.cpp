// SPDX-License-Identifier: MIT
// What the torus tells of itself: figures, an account of its slots, and who waits for what.
#include <algorithm>

#include "emulator/errors.hpp"
#include "emulator/torus/torus.hpp"

namespace torolux {

std::vector<RouterFigures> Torus::router_figures(Cycles now) {
  settle(now);
  std::vector<RouterFigures> result(routers_.size());
  const auto figures_of = [&](const Router& here, std::size_t port) {
    const Output& out = here.outputs[port];
    const Seldom& seldom = here.seldom[port];
    LinkFigures figures{out.packets, out.flits, seldom.wasted_flits, out.flits + seldom.busy_beyond, seldom.stalled};
    // Both are counted when a packet goes: in advance, or afterwards.
    figures.busy -= out.free_at > now ? out.free_at - now : 0;
    figures.stalled += out.stalled_at < now ? now - out.stalled_at : 0;
    return figures;
  };
  for (unsigned router = 0; router < shape_.routers(); ++router) {
    const Router& here = routers_[router];
    RouterFigures& figures = result[router];
    for (std::size_t port = 0; port < kLinks; ++port) {
      figures.links[port] = figures_of(here, port);
      const std::size_t other = opposite_link(port);
      figures.links[port].queue_high_water = routers_[neighbours_[router][port]].inputs[other].high_water;
    }
    figures.ejection = figures_of(here, index_of(Port::local));
    const Input& local = here.inputs[index_of(Port::local)];
    figures.injection = here.injection;
    figures.injection.busy -= local.free_at > now ? local.free_at - now : 0;
    const bool asks = (here.outputs[local.output].waiting >> index_of(Port::local) & 1U) != 0;
    if (asks) figures.injection.stalled += now - local.asked_at;
    figures.injection.queue_high_water = local.high_water;
  }
  return result;
}

void Torus::check_slots() const {
  for (unsigned router = 0; router < shape_.routers(); ++router) {
    for (std::size_t port = 0; port < kLinks; ++port) {
      const Output& out = routers_[router].outputs[port];
      if (out.held > buffer_ || std::uint32_t{out.slots} + out.returns + out.held != buffer_) {  // the sum may wrap
        throw MachineFailure("router " + std::to_string(router) + ", link " + std::to_string(port) + ": " +
                             std::to_string(out.slots) + " slots free, " + std::to_string(out.returns) +
                             " on their way back, " + std::to_string(out.held) + " held; the buffer has " +
                             std::to_string(buffer_));
      }
    }
  }
}

std::string Torus::report(unsigned most) const {
  constexpr std::array<const char*, kPorts> kNames = {"east", "west", "south", "north", "local"};
  std::string text;
  for (unsigned router = 0; router < shape_.routers() && most != 0; ++router) {
    std::string line;
    for (std::size_t port = 0; port < kPorts; ++port) {
      const Input& input = routers_[router].inputs[port];
      if (input.queue.empty()) continue;
      line += std::string(", ") + std::to_string(input.queue.size()) + " from " + kNames[port] + " for " +
              kNames[input.output];
      const Output& out = routers_[router].outputs[input.output];
      if (input.output != index_of(Port::local)) line += " (" + std::to_string(out.slots) + " slots free)";
    }
    if (line.empty()) continue;
    text += "  router " + std::to_string(router) + ": packets wait" + line + "\n";
    --most;
  }
  return text;
}

}  // namespace torolux
