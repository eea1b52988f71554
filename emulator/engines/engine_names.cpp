// SPDX-License-Identifier: MIT
// The engines by name.
#include "emulator/engines/engine_names.hpp"

#include <algorithm>
#include <map>
#include <string>

#include "emulator/engines/qemu/qemu_engine.hpp"
#include "emulator/engines/translated/run/translated_engine.hpp"
#include "emulator/errors.hpp"
#include "emulator/nearest_name.hpp"

namespace torolux {
namespace {

constexpr std::string_view kTranslated = "translated";

/// Interprets at once what has to be translated, and goes on translated.
std::unique_ptr<Engine> make_automatic_engine(const EngineSetup& setup) {
  translated::TranslationOptions options;
  options.in_background = true;
  return make_translated_engine(setup, options);
}

std::unique_ptr<Engine> make_interpreted_engine(const EngineSetup& setup) {
  translated::TranslationOptions options;
  options.interpret = true;
  return make_translated_engine(setup, options);
}

using Registry = std::map<std::string, EngineFactory, std::less<>>;

Registry& registry() {
  static Registry engines = {
      {kQemuEngine, [](const EngineSetup& setup) { return make_qemu_engine(setup); }},
      {std::string(kTranslated), [](const EngineSetup& setup) { return make_translated_engine(setup); }},
      {kInterpretedEngine, make_interpreted_engine},
      {kAutomaticEngine, make_automatic_engine}};
  return engines;
}

}  // namespace

void register_engine(std::string_view name, EngineFactory factory) {
  registry().insert_or_assign(std::string(name), std::move(factory));
}

bool engine_runs_here(std::string_view name) {
  engine_named(name);
  return name == kTranslated || name == kInterpretedEngine || name == kAutomaticEngine;
}

const EngineFactory& engine_named(std::string_view name) {
  const auto found = registry().find(name);
  if (found == registry().end()) {
    const std::vector<std::string_view> names = engine_names();
    throw UsageError(no_such_name(name, "no engine", {names.begin(), names.end()}));
  }
  return found->second;
}

std::vector<std::string_view> engine_names() {
  std::vector<std::string_view> names;
  for (const auto& [name, factory] : registry()) {
    names.push_back(name);
  }
  return names;
}

}  // namespace torolux
