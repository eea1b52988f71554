// SPDX-License-Identifier: MIT
// Settings of which each was given or not: by the user on the command line, or by a scene.
#pragma once

#include <bitset>
#include <cstddef>
#include <optional>
#include <type_traits>

#include "host_tools/settings/options.hpp"

namespace torolux {

class GivenSettings {
 public:
  bool has(const Option& option) const { return given_.test(number_of(option)); }
  template <class Part, class Value>
  bool has(Value Part::*member) const {
    return has(option_of(member));
  }
  /// Absent where it was not given.
  template <class Part, class Value>
  std::optional<Value> get(Value Part::*member) const {
    return has(member) ? std::optional(part_of<Part>(values_).*member) : std::nullopt;
  }

  template <class Part, class Value>
  void set(Value Part::*member, const std::type_identity_t<Value>& value) {
    part_of<Part>(values_).*member = value;
    given_.set(number_of(option_of(member)));
  }
  /// From now on given; its value is to be put into what is returned.
  AllSettings& give(const Option& option) {
    given_.set(number_of(option));
    return values_;
  }
  template <class Part, class Value>
  void forget(Value Part::*member) {
    given_.reset(number_of(option_of(member)));
  }

  /// Of what was not given: the built-in values.
  const AllSettings& values() const { return values_; }
  /// Puts what was given in the place of what stands there.
  void apply_to(AllSettings& settings) const;

 private:
  static constexpr std::size_t kMostOptions = 128;
  static std::size_t number_of(const Option& option) {
    return static_cast<std::size_t>(&option - all_options().data());
  }

  AllSettings values_;
  std::bitset<kMostOptions> given_;
};

}  // namespace torolux
