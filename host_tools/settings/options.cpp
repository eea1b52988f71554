// SPDX-License-Identifier: MIT
// An option and settings enter; its value leaves, copied, compared, as text, or checked.
#include "host_tools/settings/options.hpp"

#include <stdexcept>

#include "emulator/description/description.hpp"
#include "host_tools/settings/overloaded.hpp"

namespace torolux {
namespace {

template <class Value>
const void* address(const option::Member<Value>& member, const AllSettings& settings) {
  return &member.of(settings);
}
const void* address(const option::NumberedMember& member, const AllSettings& settings) {
  return member.address(settings);
}

template <class Value>
void copy(const option::Member<Value>& member, const AllSettings& from, AllSettings& to) {
  member.in(to) = member.of(from);
}
void copy(const option::NumberedMember& member, const AllSettings& from, AllSettings& to) {
  member.put(to, member.of(from));
}

/// As short as it can be read back.
std::string shortest(double value) {
  return text_of(MachineValue(value));
}

std::string text(const std::optional<double>& value) {
  return value ? shortest(*value) : "auto";
}

std::string text(const WhiteBalance& white) {
  if (white.kind == WhiteBalance::Kind::kelvin) return shortest(white.kelvin);
  return white.kind == WhiteBalance::Kind::automatic ? "auto" : "off";
}

std::string text(LayerSet set) {
  std::string names;
  for (const LayerName& layer : layers_in(set)) names += (names.empty() ? "" : ",") + std::string(layer.name);
  return names;
}

std::string text(const std::optional<std::array<std::uint32_t, 3>>& cells) {
  if (!cells) return "auto";
  const auto& [x, y, z] = *cells;
  return std::to_string(x) + "x" + std::to_string(y) + "x" + std::to_string(z);
}

template <class Integer>
std::optional<std::string> fault(const option::Count<Integer>& count, Integer value) {
  if (value >= count.least && value <= count.most && (!count.even || value % 2 == 0)) return std::nullopt;
  return (count.even ? "an even number from " : "") + std::to_string(count.least) + " to " + std::to_string(count.most);
}

}  // namespace

const AllSettings& built_in_settings() {
  static const AllSettings settings;
  return settings;
}

const Option& option_at(const void* wanted) {
  for (const Option& option : all_options()) {
    const void* is =
        std::visit([](const auto& kind) { return address(kind.member, built_in_settings()); }, option.kind);
    if (is == wanted) return option;
  }
  throw std::logic_error("a setting that is not in the table of options");
}

void copy_value(const Option& option, const AllSettings& from, AllSettings& to) {
  std::visit([&](const auto& kind) { copy(kind.member, from, to); }, option.kind);
}

bool same_value(const Option& option, const AllSettings& a, const AllSettings& b) {
  return std::visit([&](const auto& kind) { return kind.member.of(a) == kind.member.of(b); }, option.kind);
}

std::string value_text(const Option& option, const AllSettings& settings) {
  return std::visit(
      Overloaded{
          [&](const option::Choice& kind) { return std::string(kind.names.at(kind.member.of(settings))); },
          [&](const option::Flag& kind) { return std::string(kind.member.of(settings) ? "true" : "false"); },
          [&](const option::Name& kind) { return kind.member.of(settings); },
          [&](const option::Number& kind) { return shortest(kind.member.of(settings)); },
          [&](const option::Memory& kind) {
            const auto& bytes = kind.member.of(settings);
            return bytes ? std::to_string(*bytes) : std::string("auto");
          },
          [&]<class Integer>(const option::Count<Integer>& kind) { return std::to_string(kind.member.of(settings)); },
          [&](const auto& kind) { return text(kind.member.of(settings)); },
      },
      option.kind);
}

std::optional<std::string> range_fault(const Option& option, const AllSettings& settings) {
  using Fault = std::optional<std::string>;
  return std::visit(Overloaded{
                        [&]<class Integer>(const option::Count<Integer>& kind) -> Fault {
                          return fault(kind, kind.member.of(settings));
                        },
                        [&](const option::Number& kind) -> Fault {
                          const double value = kind.member.of(settings);
                          if (value >= kind.least && value <= kind.most) return std::nullopt;
                          const std::string form = option.form == "FRACTION" ? "a fraction from " : "";
                          return form + shortest(kind.least) + " to " + shortest(kind.most);
                        },
                        [&](const option::White& kind) -> Fault {
                          const WhiteBalance& white = kind.member.of(settings);
                          if (white.kind != WhiteBalance::Kind::kelvin ||
                              (white.kelvin >= kLeastWhiteKelvin && white.kelvin <= kMostWhiteKelvin))
                            return std::nullopt;
                          return shortest(kLeastWhiteKelvin) + " to " + shortest(kMostWhiteKelvin) + ", auto or off";
                        },
                        [&](const option::Length& kind) -> Fault {
                          const std::optional<double>& length = kind.member.of(settings);
                          if (!length || *length > 0) return std::nullopt;
                          return "a length greater than 0, or auto";
                        },
                        [&](const auto&) -> Fault { return std::nullopt; },
                    },
                    option.kind);
}

}  // namespace torolux
