// SPDX-License-Identifier: MIT
// Statistics enter, single figures leave.
#include "host_tools/study/figures.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

#include "emulator/description/description.hpp"

namespace torolux::study {
namespace {

constexpr std::array<const char*, 3> kStages = {"load", "radiosity", "ray_tracing"};
/// Each for all stages together, and with .STAGE for one.
constexpr std::array<const char*, 4> kByStage = {"cycles", "relative", "speed_up", "efficiency"};

/// Where the statistics have it; an array's elements are numbered.
Json at_key(const Json& json, std::string_view key) {
  const Json* at = &json;
  while (!key.empty()) {
    const std::size_t dot = key.find('.');
    const std::string part(key.substr(0, dot));
    key = dot == std::string_view::npos ? std::string_view() : key.substr(dot + 1);
    if (at->is_object()) {
      const auto found = at->find(part);
      if (found == at->end()) return nullptr;
      at = &*found;
    } else if (at->is_array()) {
      std::size_t index = 0;
      const auto result = std::from_chars(part.data(), part.data() + part.size(), index);
      if (result.ptr != part.data() + part.size() || index >= at->size()) return nullptr;
      at = &(*at)[index];
    } else {
      return nullptr;
    }
  }
  return at->is_structured() ? Json(at->dump()) : *at;
}

std::optional<double> number(const Json& value) {
  return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}

Json quotient(const Json& a, const Json& b) {
  const auto x = number(a);
  const auto y = number(b);
  if (!x || !y || *y == 0) return nullptr;
  return *x / *y;
}

Json pe_count(const Json& result) {
  const auto columns = at_key(result, "settings.pes.0");
  const auto rows = at_key(result, "settings.pes.1");
  if (!columns.is_number() || !rows.is_number()) return nullptr;
  return columns.get<std::uint64_t>() * rows.get<std::uint64_t>();
}

/// stage: empty for all.
Json cycles(const Json& result, std::string_view stage) {
  if (!stage.empty()) return at_key(result, "virtual_cycles." + std::string(stage));
  const auto found = result.find("virtual_cycles");
  if (found == result.end()) return nullptr;
  if (found->contains("total")) return found->at("total");
  std::uint64_t sum = 0;
  for (const char* name : kStages) {
    if (found->contains(name)) sum += found->at(name).get<std::uint64_t>();
  }
  return sum;
}

Json by_stage(const Json& result, const Json* baseline, std::string_view name, std::string_view stage) {
  Json own = cycles(result, stage);
  if (name == "cycles") return own;
  if (baseline == nullptr) return nullptr;
  const Json first = cycles(*baseline, stage);
  if (name == "relative") return quotient(own, first);
  Json speed_up = quotient(first, own);
  if (name == "speed_up" || !speed_up.is_number()) return speed_up;
  const Json pes = quotient(pe_count(*baseline), pe_count(result));
  return pes.is_number() ? Json(speed_up.get<double>() * pes.get<double>()) : Json();
}

struct PeSums {
  double busy = 0, idle = 0, most_busy = 0, count = 0;
};

std::optional<PeSums> pe_sums(const Json& result) {
  const auto pes = result.find("pes");
  if (pes == result.end() || !pes->is_array() || pes->empty()) return std::nullopt;
  PeSums sums;
  for (const Json& pe : *pes) {
    const double busy = number(at_key(pe, "busy_cycles")).value_or(0);
    sums.busy += busy;
    sums.idle += number(at_key(pe, "idle_cycles")).value_or(0);
    sums.most_busy = std::max(sums.most_busy, busy);
    ++sums.count;
  }
  return sums;
}

Json of_pes(const Json& result, std::string_view name) {
  const auto sums = pe_sums(result);
  if (!sums) return nullptr;
  if (name == "balance") return quotient(sums->busy / sums->count, sums->most_busy);
  return quotient(sums->busy, sums->busy + sums->idle);
}

/// Of the bytes that crossed a link, those that crossed one alone.
Json adjacent_share(const Json& result) {
  const Json::json_pointer key("/histograms/bytes_by_hops");
  if (!result.contains(key) || !result.at(key).is_array()) return nullptr;
  const Json& bytes = result.at(key);
  double all = 0;
  for (std::size_t hops = 1; hops < bytes.size(); ++hops) all += number(bytes[hops]).value_or(0);
  return all > 0 ? Json(number(bytes[1]).value_or(0) / all) : Json();
}

}  // namespace

Json figure(const Json& result, const Json* baseline, std::string_view name) {
  for (const std::string_view known : kByStage) {
    if (name == known) return by_stage(result, baseline, known, "");
    if (name.starts_with(known) && name.substr(known.size()).starts_with('.'))
      return by_stage(result, baseline, known, name.substr(known.size() + 1));
  }
  if (name == "pe_count") return pe_count(result);
  if (name == "balance" || name == "utilisation") return of_pes(result, name);
  if (name == "mean_hops" && result.contains("hops")) return at_key(result, "hops.mean");
  if (name == "adjacent_share") return adjacent_share(result);
  if (name == "memory") return at_key(result, "settings.pe_memory");
  return at_key(result, name);
}

std::vector<std::string> derived_names() {
  std::vector<std::string> names = {"pe_count", "balance", "utilisation", "mean_hops", "adjacent_share", "memory"};
  for (const char* name : kByStage) {
    names.emplace_back(name);
    for (const char* stage : kStages) names.push_back(std::string(name) + "." + stage);
  }
  return names;
}

std::vector<std::string> standard_names() {
  return {"pe_count",   "cycles",  "cycles.load", "cycles.radiosity", "cycles.ray_tracing", "speed_up",
          "efficiency", "balance", "utilisation", "mean_hops",        "adjacent_share",     "memory"};
}

std::string cell_text(const Json& value) {
  if (value.is_null()) return "";
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float()) return text_of(MachineValue(value.get<double>()));
  return value.dump();
}

}  // namespace torolux::study
