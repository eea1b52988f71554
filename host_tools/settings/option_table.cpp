// SPDX-License-Identifier: MIT
// The table itself. Nothing enters; every option leaves, once. Ranges stand here and nowhere else.
#include <initializer_list>
#include <limits>
#include <type_traits>
#include <utility>

#include "emulator/engines/engine_names.hpp"
#include "firmware/protocol/stores.hpp"
#include "host_tools/settings/options.hpp"

namespace torolux {
namespace {

constexpr double kMostNumber = std::numeric_limits<double>::max();

template <class Value, class Part>
Part part_with(Value Part::*);

/// The accessors of a member of Quality, ToneMapping or MachineChoice.
template <auto Pointer>
consteval auto at() {
  using Part = decltype(part_with(Pointer));
  using Value = std::remove_reference_t<decltype(std::declval<Part&>().*Pointer)>;
  return option::Member<Value>{
      [](AllSettings& settings) -> Value& { return part_of<Part>(settings).*Pointer; },
      [](const AllSettings& settings) -> const Value& { return part_of<Part>(settings).*Pointer; }};
}
template <auto Pointer>
consteval option::NumberedMember numbered() {
  using Part = decltype(part_with(Pointer));
  using Value = std::remove_reference_t<decltype(std::declval<Part&>().*Pointer)>;
  return {
      [](const AllSettings& settings) { return static_cast<std::size_t>(part_of<Part>(settings).*Pointer); },
      [](AllSettings& settings, std::size_t value) { part_of<Part>(settings).*Pointer = static_cast<Value>(value); },
      [](const AllSettings& settings) -> const void* { return &(part_of<Part>(settings).*Pointer); }};
}

template <std::size_t N>
std::vector<std::string_view> list(const std::array<std::string_view, N>& names) {
  return {names.begin(), names.end()};
}

std::vector<std::string_view> filter_names() {
  std::vector<std::string_view> names;
  names.reserve(kPixelFilters.size());
  for (const FilterName& filter : kPixelFilters) names.push_back(filter.name);
  return names;
}

std::string joined(const std::vector<std::string_view>& names) {
  std::string text;
  for (const std::string_view name : names) text += (text.empty() ? "" : ", ") + std::string(name);
  return text;
}

std::string up_to(std::uint64_t most) {
  return " to " + std::to_string(most);
}

void add(std::vector<Option>& table, std::initializer_list<Option> options) {
  table.insert(table.end(), options);
}

void add_view(std::vector<Option>& table) {
  using enum OptionGroup;
  add(table,
      {{.group = view,
        .key = "width",
        .scene_key = "width",
        .bears_on = BearsOn::picture,
        .kind = option::Count<std::uint32_t>{at<&Quality::width>(), 1, kMostPictureEdge}},
       {.group = view,
        .key = "height",
        .scene_key = "height",
        .bears_on = BearsOn::picture,
        .kind = option::Count<std::uint32_t>{at<&Quality::height>(), 1, kMostPictureEdge}},
       {.name = "--samples",
        .form = "N",
        .group = view,
        .help = "Rays per pixel",
        .key = "samples",
        .scene_key = "samples",
        .bears_on = BearsOn::picture,
        .kind = option::Count<std::uint32_t>{at<&Quality::samples>(), 1, kMostSamples},
        .in_presets = true},
       {.name = "--most-samples",
        .form = "N",
        .group = view,
        .help =
            "Pixels whose samples differ get more than --samples, up to N (at least twice as many); 0: all have the "
            "same",
        .key = "most_samples",
        .scene_key = "most_samples",
        .bears_on = BearsOn::picture,
        .kind = option::Count<std::uint32_t>{at<&Quality::most_samples>(), 0, kMostSamples}},
       {.name = "--noise",
        .form = "L",
        .group = view,
        .help = "With --most-samples: where two halves of the samples of 2 x 2 pixels differ by more in lightness (L*, "
                "0 to 100), they get as many again",
        .key = "noise",
        .scene_key = "noise",
        .bears_on = BearsOn::picture,
        .kind = option::Number{at<&Quality::noise>(), 0, 100}},
       {.name = "--filter",
        .form = "NAME",
        .group = view,
        .help = "How what lies around a pixel's middle weighs in it: box (its square alone), tent (to the middles of "
                "the next pixels), gaussian (softer)",
        .key = "filter",
        .scene_key = "filter",
        .bears_on = BearsOn::picture,
        .kind = option::Choice{numbered<&Quality::filter>(), filter_names(), "no filter"}}});
}

void add_results(std::vector<Option>& table) {
  using enum OptionGroup;
  add(table,
      {{.name = "--layers",
        .form = "LIST",
        .group = results,
        .help = "What else the picture shows, as channels of an .exr and as a .png each beside a .png: elements, "
                "irradiance, depth, normals, owner (PE), cost (subspaces visited); or all",
        .key = "layers",
        .bears_on = BearsOn::picture,
        .kind = option::Layers{at<&Quality::layers>()},
        .built_in_told = false},
       {.name = "--exposure",
        .form = "EV",
        .group = results,
        .help = "Exposure of a .png in EV (1 is twice as bright); 0 shows the picture's middle luminance as middle "
                "grey",
        .key = "exposure",
        .scene_key = "exposure",
        .bears_on = BearsOn::picture,
        .kind = option::Number{at<&ToneMapping::exposure_ev>(), -50, 50}},
       {.name = "--tone-curve",
        .form = "NAME",
        .group = results,
        .help = "Of a .png: filmic (toe and shoulder, keeps hue), or linear (what is too bright is cut off)",
        .key = "tone_curve",
        .bears_on = BearsOn::picture,
        .kind = option::Choice{numbered<&ToneMapping::curve>(), {"filmic", "linear"}, "no tone curve"}},
       {.name = "--white-balance",
        .form = "KELVIN|auto|off",
        .group = results,
        .help =
            "Of a .png: the light that looks white, by its temperature (2700: warm lamps; 5500: nearly as it is), or "
            "guessed from the picture",
        .key = "white_balance",
        .scene_key = "white_balance",
        .bears_on = BearsOn::picture,
        .kind = option::White{at<&ToneMapping::white>()}}});
}

void add_mesh(std::vector<Option>& table) {
  using enum OptionGroup;
  // A factor is the preset's alone.
  const auto factor = [](const char* key, option::Member<double> member, bool in_presets) {
    return Option{.group = quality,
                  .key = key,
                  .bears_on = BearsOn::elements,
                  .kind = option::Number{member, 0, kMostNumber},
                  .in_presets = in_presets};
  };
  add(table,
      {{.name = "--patches",
        .form = "LENGTH|auto",
        .group = quality,
        .help = "Longest edge of a patch (which shoots light), scene units",
        .key = "patches",
        .scene_key = "patches",
        .bears_on = BearsOn::elements,
        .kind = option::Length{at<&Quality::patch_length>()}},
       {.name = "--elements",
        .form = "LENGTH|auto",
        .group = quality,
        .help = "Longest edge of an element (which receives light), scene units",
        .key = "elements",
        .scene_key = "elements",
        .bears_on = BearsOn::elements,
        .kind = option::Length{at<&Quality::element_length>()}},
       factor("patch_factor", at<&Quality::patch_factor>(), true),
       factor("element_factor", at<&Quality::element_factor>(), true),
       factor("cluster_factor", at<&Quality::cluster_factor>(), false),
       {.name = "--refine",
        .form = "FACTOR",
        .group = quality,
        .help = "Elements added where a draft of the light asks for it, as a multiple of those without; 0: no draft",
        .key = "refine",
        .scene_key = "refine",
        .bears_on = BearsOn::elements,
        .kind = option::Number{at<&Quality::refine>(), 0, 100},
        .in_presets = true}});
}

void add_light(std::vector<Option>& table) {
  using enum OptionGroup;
  add(table,
      {{.name = "--hemicube",
        .form = "N",
        .group = quality,
        .help = "Pixels across the top of a hemi-cube, even, 4" + up_to(protocol::kMostHemicubeSize),
        .key = "hemicube",
        .scene_key = "hemicube",
        .bears_on = BearsOn::elements,
        .kind = option::Count<std::uint32_t>{at<&Quality::hemicube>(), 4, protocol::kMostHemicubeSize, true},
        .in_presets = true},
       {.name = "--shot-points",
        .form = "K",
        .group = quality,
        .help = "K x K points per patch from which it shoots, 1" + up_to(protocol::kMostShotPoints) +
                " [16; with final gathering 8]",
        .key = "shot_points",
        .scene_key = "shot_points",
        .bears_on = BearsOn::elements,
        .kind = option::Count<std::uint32_t>{at<&Quality::shot_points>(), 1, protocol::kMostShotPoints},
        .in_presets = true,
        .built_in_told = false},
       {.name = "--emission-records",
        .form = "N",
        .group = quality,
        .help = "Records with which all emitters together begin, about, 0 to 1e9 [4000000; with final gathering "
                "1000000]",
        .key = "emission_records",
        .scene_key = "emission_records",
        .bears_on = BearsOn::elements,
        .kind = option::Count<std::uint32_t>{at<&Quality::emission_records>(), 0, kMostEmissionRecords},
        .in_presets = true,
        .built_in_told = false},
       {.name = "--final-gather",
        .form = "N",
        .group = quality,
        .help = "Rays by which an element, in the mean, gathers what lights it when all shots are over, as many as a "
                "hemi-cube has pixels at least; 0: none, it is as bright as what was shot says [512; 0 where more than "
                "a hundredth of the surface is mirror, glass or glossy, and where shots, their points or records of "
                "emission are given]",
        .key = "final_gather",
        .scene_key = "final_gather",
        .bears_on = BearsOn::elements,
        .kind = option::Count<std::uint32_t>{at<&Quality::final_gather>(), 0, kMostGatherRays},
        .in_presets = true,
        .built_in_told = false},
       {.name = "--unshot",
        .form = "FRACTION",
        .group = quality,
        .help = "The radiosity stage ends when less than this fraction of the emitted flux is unshot",
        .key = "unshot",
        .scene_key = "unshot",
        .bears_on = BearsOn::elements,
        .kind = option::Number{at<&Quality::unshot>(), 0, 1, 1e-9},
        .in_presets = true},
       {.name = "--max-shots",
        .form = "N",
        .group = quality,
        .help = "Or after this many patches have shot; 0: no limit",
        .key = "max_shots",
        .scene_key = "max_shots",
        .bears_on = BearsOn::elements,
        .kind = option::Count<std::uint32_t>{at<&Quality::max_shots>(), 0, 0xFFFF'FFFFU}}});
}

void add_surfaces(std::vector<Option>& table) {
  using enum OptionGroup;
  add(table,
      {{.name = "--bounces",
        .form = "N",
        .group = quality,
        .help = "Path segments after which light is cut off, 1" + up_to(protocol::kMostBounces),
        .key = "bounces",
        .scene_key = "bounces",
        .bears_on = BearsOn::elements,
        .kind = option::Count<std::uint32_t>{at<&Quality::bounces>(), 1, protocol::kMostBounces}},
       {.name = "--texels",
        .form = "N",
        .group = quality,
        .help = "Texels of each texture, at most; larger images are averaged",
        .key = "texels",
        .scene_key = "texels",
        .bears_on = BearsOn::elements,
        .kind = option::Count<std::uint32_t>{at<&Quality::texels>(), 1, kMostTexels}},
       {.name = "--direct",
        .form = "HOW",
        .group = quality,
        .help = "Light straight from emitters, at diffuse surfaces: shadow-rays (one from each point that is seen: "
                "sharp shadows), or radiosity (from the elements: no noise; chosen where much of the scene emits)",
        .key = "direct",
        .scene_key = "shadow_rays",
        .bears_on = BearsOn::elements,
        .kind =
            option::Choice{
                numbered<&Quality::shadow_rays>(), {"radiosity", "shadow-rays"}, "no way of direct light", true}},
       {.name = "--two-sided-lights",
        .group = quality,
        .help = "Emitters emit from both sides",
        .key = "two_sided_lights",
        .scene_key = "two_sided_lights",
        .bears_on = BearsOn::elements,
        .kind = option::Flag{at<&Quality::two_sided_lights>()}},
       {.name = "--seed",
        .form = "N",
        .group = quality,
        .help = "Seed of all random numbers",
        .key = "seed",
        .scene_key = "seed",
        .bears_on = BearsOn::elements,
        .kind = option::Count<std::uint64_t>{at<&Quality::seed>(), 0, ~std::uint64_t{0}}}});
}

/// What a scheme decides where it is not given is told by words: [..., --scheme paper: ...].
Option of_scheme(const char* name, const char* form, const char* key, std::string help, option::Kind kind) {
  return {.name = name,
          .form = form,
          .group = OptionGroup::machine,
          .help = std::move(help),
          .key = key,
          .bears_on = BearsOn::machine,
          .kind = std::move(kind),
          .built_in_told = false};
}

void add_machine(std::vector<Option>& table) {
  const auto plain = [](const char* name, const char* form, std::string help, option::Kind kind) {
    return of_scheme(name, form, "", std::move(help), std::move(kind));
  };
  add(table,
      {plain("", "", "", option::Count<std::uint32_t>{at<&MachineChoice::columns>(), 1, protocol::kMostPes}),
       plain("", "", "", option::Count<std::uint32_t>{at<&MachineChoice::rows>(), 1, protocol::kMostPes}),
       plain("--pe-memory", "SIZE",
             "Local memory of a PE in bytes, K = 1024, M = 1024 K; 256K to 64M [the smallest power of two from 1M that "
             "fits]",
             option::Memory{at<&MachineChoice::pe_memory>()}),
       {.name = "--subspaces",
        .form = "GxHxK|auto",
        .group = OptionGroup::machine,
        .help = "Subspaces along x, y, z",
        .bears_on = BearsOn::machine,
        .kind = option::Cells{at<&MachineChoice::subspaces>()}},
       {.name = "--scheme",
        .form = "NAME",
        .group = OptionGroup::machine,
        .help = "How the scene and the work are shared out: spread (copies of what is hot on every PE, work dealt to "
                "whoever has little), or paper (as published: owners shoot, every face between PEs is a hand-over)",
        .key = "scheme",
        .bears_on = BearsOn::machine,
        .kind = option::Choice{numbered<&MachineChoice::scheme>(), list(kSchemeNames), "no scheme"}},
       of_scheme("--allocation", "NAME", "allocation",
                 "Which PE holds which subspace: " + std::string(kAllocations) + " [balanced; --scheme paper: skewed]",
                 option::Name{at<&MachineChoice::allocation>(), option::Name::Of::allocation}),
       of_scheme("--replicate", "FRACTION|auto", "replicate",
                 "Most of a PE's memory for copies of subspaces that stand on every PE, 0 to 1; auto: what fits [auto; "
                 "--scheme paper: 0]",
                 option::Fraction{at<&MachineChoice::replicate>()}),
       of_scheme("--points", "travel|stay", "points",
                 "A shot's points are expanded by whoever has little work, or by the patch's owner [travel; --scheme "
                 "paper: stay]",
                 option::Choice{numbered<&MachineChoice::points>(), list(kPointsNames), "no way of points"}),
       of_scheme("--empty", "over|enter", "empty",
                 "Rays step over empty subspaces by themselves, or stop in each [over; --scheme paper: enter]",
                 option::Choice{numbered<&MachineChoice::empty>(), list(kEmptyNames), "no way with empty subspaces"}),
       of_scheme(
           "--camera-rays", "pes|host", "camera_rays",
           "PEs make the camera rays of tiles dealt to them, or the host does [pes; --scheme paper: host]",
           option::Choice{numbered<&MachineChoice::camera_rays>(), list(kRayMakerNames), "no maker of camera rays"}),
       of_scheme("--enter-empty", "", "skip_empty_subspaces",
                 "Camera rays of the host begin in the outermost subspace on their way, not in the first one with "
                 "anything in it",
                 option::Flag{at<&MachineChoice::skip_empty_subspaces>(), false})});
}

void add_computer(std::vector<Option>& table) {
  add(table, {{.name = "--threads",
               .form = "N",
               .group = OptionGroup::computer,
               .help = "Threads of this computer that work for the machine [all cores]",
               .bears_on = BearsOn::machine,
               .kind = option::Count<std::uint32_t>{at<&MachineChoice::threads>(), 1, 4096},
               .built_in_told = false},
              {.name = "--engine",
               .form = "NAME",
               .group = OptionGroup::computer,
               .help = "What runs the PEs: " + joined(engine_names()),
               .bears_on = BearsOn::machine,
               .kind = option::Name{at<&MachineChoice::engine>(), option::Name::Of::engine}}});
}

std::vector<Option> make_table() {
  std::vector<Option> table;
  add_view(table);
  add_results(table);
  add_mesh(table);
  add_light(table);
  add_surfaces(table);
  add_machine(table);
  add_computer(table);
  return table;
}

}  // namespace

std::span<const Option> all_options() {
  static const std::vector<Option> table = make_table();
  return table;
}

}  // namespace torolux
