// SPDX-License-Identifier: MIT
// Proves, for each option of the table: what is set on the command line, or in a scene file, is resolved; stands in the
// statistics; and is what the command line made of them leads to again. Presets and checks of ranges follow the table.
#include "host_tools/settings/options.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <set>

#include "emulator/errors.hpp"
#include "host_tools/cli/prepared_render.hpp"
#include "host_tools/report/settings_json.hpp"
#include "host_tools/scene/scene_file.hpp"
#include "host_tools/settings/overloaded.hpp"

namespace torolux {
namespace {

using Json = nlohmann::ordered_json;

/// Another value than the built-in one, as the command line takes it.
std::string other_text(const Option& option) {
  const std::string built_in = value_text(option, built_in_settings());
  return std::visit(
      Overloaded{
          []<class Integer>(const option::Count<Integer>& kind) {
            return std::to_string(kind.even ? kind.most - 2 : kind.most);
          },
          [](const option::Number& kind) { return std::string(kind.most > 1 ? "25" : "0.75"); },
          [](const option::Length&) { return std::string("0.375"); },
          [](const option::Fraction&) { return std::string("0.375"); },
          [&](const option::Choice& kind) { return std::string(kind.names[kind.names[0] == built_in ? 1 : 0]); },
          [](const option::White&) { return std::string("3000"); },
          [](const option::Flag& kind) { return std::string(kind.given ? "true" : "false"); },
          [](const option::Layers&) { return std::string("depth,cost"); },
          [](const option::Name& kind) {
            return std::string(kind.of == option::Name::Of::engine ? "interpreted" : "block");
          },
          [](const option::Memory&) { return std::string("524288"); },
          [](const option::Cells&) { return std::string("2x3x4"); },
      },
      option.kind);
}

AllSettings resolved(const RenderOptions& options, const SceneDefaults& defaults) {
  Scene scene;
  scene.name = "room";
  scene.camera = Camera{};
  scene.defaults = defaults;
  const Resolved resolved = resolve(options, scene);
  return {resolved.quality, resolved.tone, resolved.machine};
}

Json settings_of(const RenderOptions& options) {
  Scene scene;
  scene.name = "room";
  scene.camera = Camera{};
  return settings_json(describe(options, resolve(options, scene), scene.name, {}), nullptr);
}

std::vector<std::string> words_of(const Option& option) {
  if (std::holds_alternative<option::Flag>(option.kind)) return {"room", option.name};
  return {"room", option.name, other_text(option)};
}

TEST(Options, GivenOnTheCommandLineLeadToThemselves) {
  for (const Option& option : all_options()) {
    if (option.name.empty()) continue;
    SCOPED_TRACE(option.name);
    const RenderOptions options = parse_render_options(words_of(option));
    EXPECT_TRUE(options.given.has(option));
    const AllSettings settings = resolved(options, {});
    EXPECT_EQ(value_text(option, settings), other_text(option));
    EXPECT_FALSE(same_value(option, settings, built_in_settings()));
    const Json json = settings_of(options);
    std::vector<std::string> again = command_line_of(Json::parse(json.dump()));
    again.erase(again.begin());
    EXPECT_EQ(settings_of(parse_render_options(again)).dump(1), json.dump(1));
    if (option.bears_on != BearsOn::machine) {
      EXPECT_NE(json.dump(), settings_of(parse_render_options({"room"})).dump()) << "it determines the picture";
    }
  }
}

/// As a scene.toml has it.
std::string toml_text(const Option& option) {
  const std::string text = other_text(option);
  const auto* choice = std::get_if<option::Choice>(&option.kind);
  if (choice == nullptr) return std::holds_alternative<option::Count<std::uint64_t>>(option.kind) ? "77" : text;
  if (choice->flag_in_scene) return text == choice->names[1] ? "true" : "false";
  return "'" + text + "'";
}

TEST(Options, OfASceneFileAreResolvedAndOutweighed) {
  for (const Option& option : all_options()) {
    if (option.scene_key.empty()) continue;
    SCOPED_TRACE(option.scene_key);
    const std::string text = "[defaults]\n" + option.scene_key + " = " + toml_text(option) + "\n";
    const SceneDefaults defaults = read_scene_file(text, "s.toml").defaults;
    EXPECT_TRUE(defaults.given.has(option));
    EXPECT_FALSE(same_value(option, resolved({}, defaults), built_in_settings()));
    if (option.name.empty() || std::holds_alternative<option::Flag>(option.kind)) continue;
    RenderOptions options;
    copy_value(option, built_in_settings(), options.given.give(option));
    EXPECT_TRUE(same_value(option, resolved(options, defaults), built_in_settings())) << "given, though as built in";
  }
}

TEST(Options, EachHasAMemberAndNamesOfItsOwn) {
  std::set<std::string> names;
  std::set<std::string> keys;
  for (const Option& option : all_options()) {
    EXPECT_TRUE(option.name.empty() || names.insert(option.name).second) << option.name;
    EXPECT_TRUE(option.key.empty() || keys.insert(option.key).second) << option.key;
  }
  EXPECT_EQ(option_of(&Quality::seed).name, "--seed");
  EXPECT_EQ(option_of(&MachineChoice::engine).name, "--engine");
  EXPECT_THROW(option_of(&MachineChoice::debugging), std::logic_error);
}

TEST(Options, BuiltInValuesAreInRange) {
  for (const Option& option : all_options()) {
    if (option.group == OptionGroup::computer) continue;  // no threads: all cores
    EXPECT_EQ(range_fault(option, built_in_settings()), std::nullopt) << option.name;
  }
  AllSettings settings;
  settings.quality.hemicube = 7;
  EXPECT_EQ(range_fault(option_of(&Quality::hemicube), settings), "an even number from 4 to 256");
  settings.quality.shot_points = 65;
  EXPECT_EQ(range_fault(option_of(&Quality::shot_points), settings), "1 to 64");
  settings.quality.unshot = 1.5;
  EXPECT_EQ(range_fault(option_of(&Quality::unshot), settings), "a fraction from 0 to 1");
  settings.quality.element_length = 0;
  EXPECT_EQ(range_fault(option_of(&Quality::element_length), settings), "a length greater than 0, or auto");
}

TEST(Options, PresetsSayNothingBeyondTheirOptions) {
  for (const Preset& preset : kPresets) {
    Quality quality;
    apply(preset, quality);
    for (const Option& option : all_options()) {
      EXPECT_TRUE(same_value(option, {quality, {}, {}}, {preset.quality, {}, {}})) << preset.name << option.name;
    }
  }
}

}  // namespace
}  // namespace torolux
