// SPDX-License-Identifier: MIT
// The table of options: what a user may set, each with its name, member, range and help. Nothing enters; from the table
// are made the command line, the keys of a scene's [defaults], the settings in the statistics, the command line that
// repeats a run, the checks of ranges, the presets, and what must match in a radiosity file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "host_tools/settings/all_settings.hpp"

namespace torolux {

/// Kinds of options: where the value lies, and what it may be.
namespace option {

/// Where a value lies in AllSettings.
template <class Value>
struct Member {
  Value& (*in)(AllSettings&);
  const Value& (*of)(const AllSettings&);
};
/// The same of an enumeration or a bool, by its number.
struct NumberedMember {
  std::size_t (*of)(const AllSettings&);
  void (*put)(AllSettings&, std::size_t);
  const void* (*address)(const AllSettings&);
};

template <class Integer>
struct Count {
  Member<Integer> member;
  std::uint64_t least = 0, most = 0;
  bool even = false;
};
struct Number {
  Member<double> member;
  double least = 0, most = 0;
  std::optional<double> least_on_command_line = std::nullopt;  ///< where scenes may give less
};
/// Above 0, scene units; absent: auto.
struct Length {
  Member<std::optional<double>> member;
};
/// 0..1; absent: auto.
struct Fraction {
  Member<std::optional<double>> member;
};
struct Choice {
  NumberedMember member;
  std::vector<std::string_view> names;  ///< by number
  std::string_view kind;                ///< of another name, as in "no filter"
  bool flag_in_scene = false;           ///< two names; there it is true or false
};
/// "off", "auto", or kelvin from kLeastWhiteKelvin to kMostWhiteKelvin.
struct White {
  Member<WhiteBalance> member;
};
struct Flag {
  Member<bool> member;
  bool given = true;  ///< the value where the flag is given
};
struct Layers {
  Member<LayerSet> member;
};
/// A name that another part knows.
struct Name {
  enum class Of : std::uint8_t { allocation, engine };
  Member<std::string> member;
  Of of;
};
/// Bytes; absent: what fits.
struct Memory {
  Member<std::optional<std::uint32_t>> member;
};
/// Along x, y, z; absent: auto.
struct Cells {
  Member<std::optional<std::array<std::uint32_t, 3>>> member;
};

using Kind = std::variant<Count<std::uint32_t>, Count<std::uint64_t>, Number, Length, Fraction, Choice, White, Flag,
                          Layers, Name, Memory, Cells>;

}  // namespace option

enum class OptionGroup : std::uint8_t { results, view, quality, machine, computer };

enum class BearsOn : std::uint8_t {
  picture,   ///< and on nothing that is kept for other pictures
  elements,  ///< their number or flux: a radiosity file must have been made with the same
  machine,   ///< on cycles and statistics only
};

struct Option {
  std::string name = {};  ///< "--samples"; empty: none of its own
  std::string form = {};  ///< of its value, as in "N"
  OptionGroup group;
  std::string help = {};
  std::string key = {};        ///< in the statistics' settings; empty: not there, or written by hand
  std::string scene_key = {};  ///< in a scene's [defaults]; empty: a scene cannot set it, or it is read by hand
  BearsOn bears_on;
  option::Kind kind;
  bool in_presets = false;
  bool built_in_told = true;  ///< --help tells the built-in value of itself
};

/// In the order of --help within each group.
std::span<const Option> all_options();

/// The built-in values.
const AllSettings& built_in_settings();

/// Of the member; throws std::logic_error where there is none. address: in built_in_settings().
const Option& option_at(const void* address);
template <class Part, class Value>
const Option& option_of(Value Part::*member) {
  return option_at(&(part_of<Part>(built_in_settings()).*member));
}

/// The value that `from` has.
void copy_value(const Option& option, const AllSettings& from, AllSettings& to);
bool same_value(const Option& option, const AllSettings& a, const AllSettings& b);

/// As the command line takes it; numbers as short as they can be read back; a flag's: "true" or "false".
std::string value_text(const Option& option, const AllSettings& settings);

/// What is allowed, as in "1 to 64", where the value is not; absent: it is, or nothing is said of its kind.
std::optional<std::string> range_fault(const Option& option, const AllSettings& settings);

}  // namespace torolux
