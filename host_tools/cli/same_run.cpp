// SPDX-License-Identifier: MIT
// Both are flattened to values by their path, without what may differ between equal runs, and compared one by one;
// inputs by their SHA-256.
#include "host_tools/cli/same_run.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "host_tools/report/settings_json.hpp"

namespace torolux {
namespace {

using Json = nlohmann::ordered_json;
using Lines = std::vector<std::string>;

std::string dotted(std::string pointer) {
  std::ranges::replace(pointer, '/', '.');
  return pointer.substr(1);
}

/// Values by JSON pointer, in order.
Json flat(const Json& json) {
  return json.is_structured() && !json.empty() ? json.flatten() : Json::object();
}

void add_differences(const Json& was, const Json& is, Lines& lines) {
  const Json before = flat(was);
  const Json now = flat(is);
  for (const auto& [pointer, value] : before.items()) {
    const auto found = now.find(pointer);
    if (found == now.end())
      lines.push_back(dotted(pointer) + ": was " + value.dump() + ", is no more");
    else if (*found != value)
      lines.push_back(dotted(pointer) + ": was " + value.dump() + ", is " + found->dump());
  }
}

Json section(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found == json.end() ? Json() : *found;
}

}  // namespace

Lines changed_inputs(const Json& was, const Json& is) {
  Lines lines;
  const Json before = section(was, "inputs");
  const Json now = section(is, "inputs");
  for (std::size_t i = 0; i < std::max(before.size(), now.size()); ++i) {
    if (i >= now.size()) {
      lines.push_back(before[i].value("path", "") + " is no more among the inputs");
    } else if (i >= before.size()) {
      lines.push_back(now[i].value("path", "") + " is new among the inputs");
    } else if (before[i].value("sha256", "") != now[i].value("sha256", "")) {
      lines.push_back(now[i].value("path", "") + " has changed: SHA-256 was " + before[i].value("sha256", "") +
                      ", is " + now[i].value("sha256", ""));
    }
  }
  return lines;
}

Lines changed_versions(const Json& was, const Json& is) {
  Lines lines;
  add_differences({{"versions", section(was, "versions")}}, {{"versions", section(is, "versions")}}, lines);
  return lines;
}

Lines changed_settings(const Json& was, const Json& is) {
  Json before = determining(was);
  Json now = determining(is);
  for (Json* settings : {&before, &now}) {
    for (const char* key : {"inputs", "engine", "qemu_pes"}) settings->erase(key);
  }
  Lines lines;
  add_differences(before, now, lines);
  const Json old_keys = flat(before);
  const Json new_keys = flat(now);
  for (const auto& [pointer, value] : new_keys.items()) {
    if (!old_keys.contains(pointer)) lines.push_back(dotted(pointer) + ": is new, " + value.dump());
  }
  return lines;
}

Lines changed_figures(const Json& was, const Json& is) {
  Json before = was;
  for (const char* key : {"version", "engine", "settings", "command_line", "wall_seconds", "host"}) before.erase(key);
  Lines lines;
  add_differences(before, is, lines);
  return lines;
}

}  // namespace torolux
