// SPDX-License-Identifier: MIT
// One profile after the other, so that no more than one is in memory.
#include "host_tools/profile/speedscope.hpp"

#include <nlohmann/json.hpp>
#include <vector>

#include "host_tools/report/version.hpp"

namespace torolux {
namespace {

using Json = nlohmann::ordered_json;

std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string profile_text(const PathTree& tree, const std::string& name) {
  Json samples = Json::array(), weights = Json::array();
  std::vector<std::size_t> depth_of(tree.paths.size());
  std::vector<NameNumber> stack;
  for (std::size_t i = 1; i < tree.paths.size(); ++i) {
    const Path& path = tree.paths[i];
    depth_of[i] = depth_of[path.parent] + 1;
    stack.resize(depth_of[path.parent]);
    stack.push_back(path.name);
    if (path.self == 0) continue;
    samples.push_back(stack);
    weights.push_back(path.self);
  }
  const Json json = {{"type", "sampled"},         {"name", name},       {"unit", "none"},    {"startValue", 0},
                     {"endValue", tree.cycles()}, {"samples", samples}, {"weights", weights}};
  return text_of(json);
}

}  // namespace

void write_speedscope(const profile::CycleProfile& profile, const ProfileNames& names, std::span<const unsigned> pes,
                      const std::string& name, const std::function<void(std::string_view)>& take) {
  Json frames = Json::array();
  for (const std::string& one : names.all()) frames.push_back({{"name", one}});
  const Json head = {{"$schema", "https://www.speedscope.app/file-format-schema.json"},
                     {"name", name},
                     {"exporter", std::string("torolux@") + kVersion},
                     {"activeProfileIndex", 0},
                     {"shared", {{"frames", frames}}}};
  std::string text = text_of(head);
  text.pop_back();  // the brace, behind which no more comes
  take(text + ",\"profiles\":[");
  if (pes.size() > 1) take(profile_text(paths_of(profile, names, pes), "all PEs") + ",");
  for (const unsigned& pe : pes) {
    take(profile_text(paths_of(profile, names, std::span(&pe, 1)), "PE " + std::to_string(pe)));
    if (&pe != &pes.back()) take(",");
  }
  take("]}\n");
}

}  // namespace torolux
