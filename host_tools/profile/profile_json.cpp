// SPDX-License-Identifier: MIT
// Rows as objects for programs; paths as columns of numbers for the page.
#include "host_tools/profile/profile_json.hpp"

#include <nlohmann/json.hpp>
#include <vector>

namespace torolux {
namespace {

using Json = nlohmann::ordered_json;

Json function_json(const FunctionTotals& function, const ProfileNames& names) {
  const Spread& spread = function.spread;
  return {{"name", names.all()[function.name]},
          {"calls", function.calls},
          {"self_cycles", function.self},
          {"wait_cycles", function.waits},
          {"total_cycles", function.total},
          {"self_of_a_pe",
           {{"least", spread.least},
            {"least_pe", spread.least_pe},
            {"mean", spread.mean},
            {"most", spread.most},
            {"most_pe", spread.most_pe}}}};
}

}  // namespace

std::string profile_json(const ProfileTotals& totals, const ProfileNames& names, std::span<const unsigned> pes) {
  Json json = {{"pes", pes},
               {"cycles", totals.cycles},
               {"busy_cycles", totals.cycles - totals.waits},
               {"wait_cycles", totals.waits},
               {"functions", Json::array()}};
  for (const FunctionTotals& function : totals.functions) json["functions"].push_back(function_json(function, names));
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string flame_graph_json(const PathTree& tree, const ProfileNames& names, std::size_t pes) {
  const double least = kLeastShownShare * static_cast<double>(tree.cycles());
  Json parents = Json::array(), of_name = Json::array(), calls = Json::array(), selves = Json::array(),
       totals = Json::array();
  constexpr std::size_t kLeftOut = ~std::size_t{0};
  std::vector<std::size_t> place_of(tree.paths.size(), kLeftOut);
  for (std::size_t i = 0; i < tree.paths.size(); ++i) {
    const Path& path = tree.paths[i];
    if (place_of[path.parent] == kLeftOut && i != 0) continue;
    if (static_cast<double>(path.total) < least) continue;
    place_of[i] = parents.size();
    parents.push_back(place_of[path.parent]);
    of_name.push_back(path.name);
    calls.push_back(path.calls);
    selves.push_back(path.self);
    totals.push_back(path.total);
  }
  const bool all = parents.size() == tree.paths.size();
  const Json json = {
      {"pes", pes},
      {"waits", kWaitReasons},
      {"left_out", all ? 0 : kLeastShownShare},
      {"names", names.all()},
      {"paths", {{"parents", parents}, {"names", of_name}, {"calls", calls}, {"selves", selves}, {"totals", totals}}}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace torolux
