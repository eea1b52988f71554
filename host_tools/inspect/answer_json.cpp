// SPDX-License-Identifier: MIT
// Keys are named as the answers' fields are, with the unit where it is watts.
#include "host_tools/inspect/answer_json.hpp"

#include <nlohmann/json.hpp>

#include "host_tools/report/machine_json.hpp"

namespace torolux {
namespace {

using Json = nlohmann::ordered_json;

template <class T>
Json optional_json(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}

Json source_json(const LightSource& source) {
  return {{"patch", source.patch},
          {"material", source.material},
          {"pe", source.pe},
          {"emitted_w", source.emitted},
          {"reflected_w", source.reflected}};
}

Json stage_json(const PeStage& stage) {
  Json stores = Json::object();
  for (const StoreBytes& store : stage.stores) stores[store.name] = store.bytes;
  return {{"name", stage.name},
          {"common_subspaces", stage.common_subspaces},
          {"subspaces", stage.subspaces},
          {"polygons", stage.polygons},
          {"patches", stage.patches},
          {"image_bytes", stage.image_bytes},
          {"stores", std::move(stores)},
          {"used_bytes", stage.used_bytes},
          {"available_bytes", stage.available_bytes},
          {"figures", stage.figures ? pes_json({*stage.figures}, built_in_phase_names())[0] : Json()}};
}

}  // namespace

Json answer_json(const ElementAnswer& answer) {
  Json sources = Json::array();
  for (const LightSource& source : answer.sources) sources.push_back(source_json(source));
  return {{"element", answer.element},
          {"patch", answer.patch},
          {"of_patch", answer.of_patch},
          {"patch_elements", answer.patch_elements},
          {"side", answer.side == 0 ? "front" : "back"},
          {"other_side", optional_json(answer.other_side)},
          {"polygons", answer.polygons},
          {"material", answer.material},
          {"centre", answer.centre},
          {"area", answer.area},
          {"reflectance", answer.reflectance},
          {"owner", answer.owner},
          {"subspace", answer.subspace},
          {"keeper", optional_json(answer.keeper)},
          {"incident_w", answer.incident},
          {"direct_w", optional_json(answer.direct)},
          {"gathered_w", optional_json(answer.gathered)},
          {"apart_w", optional_json(answer.apart)},
          {"irradiance", answer.irradiance},
          {"emission", answer.emission},
          {"radiosity", answer.radiosity},
          {"patch_unshot_w", answer.patch_unshot},
          {"pixels", answer.pixels},
          {"sources", std::move(sources)}};
}

Json answer_json(const PeAnswer& answer) {
  Json stages = Json::array(), packets = Json::array();
  for (const PeStage& stage : answer.stages) stages.push_back(stage_json(stage));
  for (const PassedPacket& packet : answer.last_packets)
    packets.push_back({{"cycle", packet.time},
                       {"sent", packet.sent},
                       {"other", packet.other},
                       {"records", packet.records},
                       {"bytes", packet.bytes}});
  Json box;
  if (answer.box) box = {answer.box->left, answer.box->top, answer.box->right, answer.box->bottom};
  return {{"pe", answer.pe},
          {"column", answer.column},
          {"row", answer.row},
          {"pixels", answer.pixels},
          {"box", std::move(box)},
          {"figures", pes_json({answer.figures}, built_in_phase_names())[0]},
          {"stages", std::move(stages)},
          {"last_packets", std::move(packets)}};
}

Json answer_json(const PixelAnswer& answer) {
  Json story = Json::array();
  for (const StoryEvent& event : answer.story) {
    story.push_back({{"cycle", event.time}, {"who", event.who}, {"what", event.what}});
    if (!event.routers.empty()) story.back()["routers"] = event.routers;
  }
  return {{"column", answer.pixel.column},
          {"row", answer.pixel.row},
          {"sample", answer.pixel.sample},
          {"radiance", answer.radiance},
          {"element", optional_json(answer.element)},
          {"story", std::move(story)}};
}

}  // namespace torolux
