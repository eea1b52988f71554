// SPDX-License-Identifier: MIT
// Entries of the table enter, options of CLI11 leave, whose texts become values by the kind of each.
#include "host_tools/cli/table_options.hpp"

#include "emulator/engines/engine_names.hpp"
#include "emulator/errors.hpp"
#include "emulator/nearest_name.hpp"
#include "host_tools/cli/parse_values.hpp"
#include "host_tools/subspace/allocation.hpp"

namespace torolux {
namespace {

void check_name(option::Name::Of of, const std::string& name) {
  if (of == option::Name::Of::allocation) check_allocation(name);
  if (of == option::Name::Of::engine) engine_named(name);
}

/// An option's text on the command line becomes its value.
class TextReader {
 public:
  TextReader(const std::string& text, AllSettings& to) : text_(text), to_(to) {}

  template <class Integer>
  void operator()(const option::Count<Integer>& kind) const {
    const std::uint64_t value = parse_count(text_, kind.least, kind.most);
    if (kind.even && value % 2 != 0) throw InputError("\"" + text_ + "\" is odd; the number must be even");
    kind.member.in(to_) = static_cast<Integer>(value);
  }
  void operator()(const option::Number& kind) const {
    kind.member.in(to_) = parse_number(text_, kind.least_on_command_line.value_or(kind.least), kind.most);
  }
  void operator()(const option::Length& kind) const { kind.member.in(to_) = parse_length(text_); }
  void operator()(const option::Fraction& kind) const { kind.member.in(to_) = parse_fraction(text_); }
  void operator()(const option::Choice& kind) const { kind.member.put(to_, parse_name(text_, kind.names, kind.kind)); }
  void operator()(const option::White& kind) const { kind.member.in(to_) = parse_white_balance(text_); }
  void operator()(const option::Flag& kind) const { kind.member.in(to_) = kind.given; }
  void operator()(const option::Layers& kind) const { kind.member.in(to_) = parse_layers(text_); }
  void operator()(const option::Name& kind) const {
    check_name(kind.of, text_);
    kind.member.in(to_) = text_;
  }
  void operator()(const option::Memory& kind) const { kind.member.in(to_) = parse_memory(text_); }
  void operator()(const option::Cells& kind) const { kind.member.in(to_) = parse_subspaces(text_); }

 private:
  const std::string& text_;
  AllSettings& to_;
};

}  // namespace

void check_allocation(const std::string& name) {
  if (is_allocation(name)) return;
  const std::string near = did_you_mean(name, {"skewed", "skewed-both", "modulo", "block", "balanced"});
  throw UsageError("\"" + name + "\" is no allocation" + near + (near.empty() ? "; there are: " : " There are: ") +
                   std::string(kAllocations));
}

const char* heading(OptionGroup group) {
  switch (group) {
    case OptionGroup::results:
      return "Results";
    case OptionGroup::view:
      return "View";
    case OptionGroup::quality:
      return "Quality";
    case OptionGroup::machine:
    case OptionGroup::computer:
      break;
  }
  return "Machine (does not change the picture)";
}

CLI::Option* add_table_option(CLI::App& command, const Option& option, GivenSettings& given) {
  const auto take = [&option, &given](const std::string& text) {
    std::visit(TextReader(text, given.give(option)), option.kind);
  };
  if (std::holds_alternative<option::Flag>(option.kind)) {
    const auto set = [take](std::int64_t times) {
      if (times > 0) take("");
    };
    return command.add_flag_function(option.name, set, option.help)->group(heading(option.group));
  }
  CLI::Option* added = add_value(command, option.name, option.form, option.help, take)->group(heading(option.group));
  if (option.built_in_told) added->default_str(value_text(option, built_in_settings()));
  return added;
}

void add_table_options(CLI::App& command, OptionGroup group, GivenSettings& given) {
  for (const Option& option : all_options()) {
    if (option.group == group && !option.name.empty()) add_table_option(command, option, given);
  }
}

}  // namespace torolux
