// SPDX-License-Identifier: MIT
// One label and value a line, as `torolux info` has them.
#include "host_tools/inspect/answer_text.hpp"

#include <algorithm>

#include "host_tools/report/text.hpp"

namespace torolux {
namespace {

constexpr std::size_t kLabel = 22;
constexpr std::size_t kMostSources = 8, kMostSubspaces = 12;

std::string line(const std::string& label, const std::string& text) {
  return left(label, kLabel) + text + "\n";
}

std::string triple(const Vec3d& v) {
  return significant(v[0], 4) + " " + significant(v[1], 4) + " " + significant(v[2], 4);
}

std::string subspace(const std::array<std::uint32_t, 3>& cell) {
  return "(" + std::to_string(cell[0]) + ", " + std::to_string(cell[1]) + ", " + std::to_string(cell[2]) + ")";
}

std::string sources_text(const ElementAnswer& answer) {
  double sum = 0;
  for (const LightSource& source : answer.sources) sum += source.sum();
  const double held = answer.incident[0] + answer.incident[1] + answer.incident[2];
  std::string text = line("light comes from", grouped(answer.sources.size()) + " patches; looking back from it finds " +
                                                  (held > 0 ? percent(sum / held) : "0 %") + " of what it holds");
  for (std::size_t i = 0; i < std::min(kMostSources, answer.sources.size()); ++i) {
    const LightSource& source = answer.sources[i];
    const double emitted = source.emitted[0] + source.emitted[1] + source.emitted[2];
    text += line("  " + right(percent(source.sum() / sum), 7),
                 "patch " + std::to_string(source.patch) + " of '" + source.material + "' (PE " +
                     std::to_string(source.pe) + "): " + triple(source.watts()) + " W" +
                     (emitted > 0 ? ", " + percent(emitted / source.sum(), 0) + " of it emitted there" : ""));
  }
  return text;
}

std::string phases_text(const PeFigures& figures) {
  std::string text;
  for (std::size_t i = 0; i < protocol::kPhaseNames.size(); ++i) {
    if (figures.phase_cycles[i] == 0) continue;
    text += (text.empty() ? "" : ", ") + std::string(protocol::kPhaseNames[i]) + " " +
            percent(static_cast<double>(figures.phase_cycles[i]) /
                    static_cast<double>(std::max<Cycles>(1, figures.busy_cycles)));
  }
  return text.empty() ? "none" : text;
}

std::string figures_text(const PeFigures& figures) {
  return line("  cycles", grouped(figures.cycles) + ", busy " +
                              percent(static_cast<double>(figures.busy_cycles) /
                                      static_cast<double>(std::max<Cycles>(1, figures.cycles)))) +
         line("  busy by phase", phases_text(figures)) +
         line("  packets", grouped(figures.packets_sent) + " sent, " + grouped(figures.packets_delivered) +
                               " received; records diverted " + grouped(figures.records_diverted)) +
         line("  high-water marks", grouped(figures.record_slots_high_water) + " record slots, " +
                                        grouped(figures.receive_buffers_high_water) + " receive buffers");
}

std::string stage_text(const PeStage& stage) {
  std::string text = line(stage.name + " stage", stage.figures ? "" : "left out");
  std::string cells =
      grouped(stage.subspaces.size()) + " of its own, " + grouped(stage.common_subspaces) + " that all PEs have";
  for (std::size_t i = 0; i < std::min(kMostSubspaces, stage.subspaces.size()); ++i)
    cells += (i == 0 ? ": " : ", ") + subspace(stage.subspaces[i]);
  if (stage.subspaces.size() > kMostSubspaces) cells += ", ...";
  text += line("  subspaces", cells);
  text += line("  polygons",
               grouped(stage.polygons) + (stage.patches > 0 ? "; patches that it owns " + grouped(stage.patches) : ""));
  text += line("  memory", bytes_text(stage.used_bytes) + " of " + bytes_text(stage.available_bytes) + " (" +
                               percent(static_cast<double>(stage.used_bytes) /
                                       static_cast<double>(std::max<std::uint64_t>(1, stage.available_bytes))) +
                               ")");
  text += line("  " + right(bytes_text(stage.image_bytes), 12), "  firmware and its stack");
  std::vector<StoreBytes> stores = stage.stores;
  std::ranges::stable_sort(stores, std::greater<>(), &StoreBytes::bytes);
  for (const StoreBytes& store : stores)
    text += line("  " + right(bytes_text(store.bytes), 12), std::string("  ") + store.name);
  if (stage.figures) text += figures_text(*stage.figures);
  return text;
}

}  // namespace

std::string answer_text(const ElementAnswer& answer) {
  std::string polygons = std::to_string(answer.polygons.front());
  for (std::size_t i = 1; i < std::min<std::size_t>(4, answer.polygons.size()); ++i)
    polygons += ", " + std::to_string(answer.polygons[i]);
  if (answer.polygons.size() > 4) polygons += ", ... (" + grouped(answer.polygons.size()) + " in all)";
  std::string text =
      line("element", std::to_string(answer.element) + ", " + (answer.side == 0 ? "front" : "back") +
                          (answer.other_side ? "; its other side is " + std::to_string(*answer.other_side) : "")) +
      line("patch", std::to_string(answer.patch) + ", of which it is element " + std::to_string(answer.of_patch) +
                        " of " + grouped(answer.patch_elements)) +
      line("polygon", polygons + " of '" + answer.material + "'") + line("place", triple(answer.centre)) +
      line("area", significant(answer.area, 5) + " m^2, seen in " + grouped(answer.pixels) + " pixels") +
      line("owner",
           "PE " + std::to_string(answer.owner) + "; the patch's centre is in subspace " + subspace(answer.subspace)) +
      line("in ray tracing", answer.keeper ? "kept by PE " + std::to_string(*answer.keeper) + " alone"
                                           : "at every PE that has its polygon") +
      line("incident",
           triple(answer.incident) + " W" +
               (answer.direct ? ", straight from emitters " + triple(*answer.direct) + " W"
                              : " by shots, of which " + triple(answer.apart.value_or(Vec3d{})) +
                                    " W are kept; gathered " + triple(answer.gathered.value_or(Vec3d{})) + " W")) +
      line("irradiance", triple(answer.irradiance) + " W/m^2") + line("reflectance", triple(answer.reflectance)) +
      line("emission", triple(answer.emission) + " W/m^2") + line("radiosity", triple(answer.radiosity) + " W/m^2") +
      line("not shot on", triple(answer.patch_unshot) + " W, of what its patch has received");
  return text + sources_text(answer);
}

std::string answer_text(const PeAnswer& answer) {
  std::string text = line("PE", std::to_string(answer.pe) + ", column " + std::to_string(answer.column) + ", row " +
                                    std::to_string(answer.row));
  std::string place = grouped(answer.pixels) + " pixels see first what stands in its subspaces";
  if (answer.box)
    place += ", within " + std::to_string(answer.box->left) + "," + std::to_string(answer.box->top) + " to " +
             std::to_string(answer.box->right) + "," + std::to_string(answer.box->bottom);
  text += line("in the picture", place) + line("whole run", "") + figures_text(answer.figures);
  for (const PeStage& stage : answer.stages) text += stage_text(stage);
  text += line("last packets", answer.last_packets.empty() ? "none" : "");
  for (const PassedPacket& packet : answer.last_packets)
    text += right(grouped(packet.time), 16) + "  " + (packet.sent ? "to PE " : "from PE ") +
            std::to_string(packet.other) + ", " + grouped(packet.records) +
            (packet.records == 1 ? " record, " : " records, ") + grouped(packet.bytes) + " bytes\n";
  return text;
}

std::string answer_text(const PixelAnswer& answer) {
  std::string text = line("pixel", std::to_string(answer.pixel.column) + "," + std::to_string(answer.pixel.row) +
                                       ", sample " + std::to_string(answer.pixel.sample)) +
                     line("radiance", triple(answer.radiance) + " W/(m^2 sr), all samples") +
                     line("sees", answer.element ? "element " + std::to_string(*answer.element) : "no lit element");
  for (const StoryEvent& event : answer.story) text += text_of(event) + "\n";
  return text;
}

}  // namespace torolux
