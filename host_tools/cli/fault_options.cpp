// SPDX-License-Identifier: MIT
// Options into FaultOptions, and those into a machine's description.
#include "host_tools/cli/fault_options.hpp"

#include <CLI/CLI.hpp>
#include <limits>

#include "emulator/errors.hpp"
#include "host_tools/cli/named_value.hpp"
#include "host_tools/cli/parse_values.hpp"

namespace torolux {
namespace {

/// Adds an option whose text goes through `parse`; errors name the option.
template <class Parse>
void add_fault(CLI::App& command, const std::string& name, const std::string& form, const std::string& help,
               const std::string& group, Parse parse) {
  const auto take = [name, parse](const std::string& text) { value_of(name, parse, text); };
  CLI::Option* option = command.add_option_function<std::string>(name, take, help);
  option->type_name(form)->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  if (!group.empty()) option->group(group);
}

}  // namespace

void FaultOptions::apply_to(MachineDescription& machine) const {
  if (jitter) machine.jitter.seed = *jitter;
  if (link_error_rate) machine.torus.link_error_rate = *link_error_rate;
}

void add_fault_options(CLI::App& command, FaultOptions& options, const std::string& group) {
  add_fault(command, "--jitter", "SEED",
            "Delay links, routers and bus transfers by chance, up to the machine's jitter.cycles each; 0: do not",
            group, [&options](const std::string& text) {
              options.jitter =
                  static_cast<std::uint32_t>(parse_count(text, 0, std::numeric_limits<std::uint32_t>::max()));
            });
  add_fault(command, "--fault", "link:P", "Spoil packets on links with this chance, 0 to 0.5; they are sent again",
            group, [&options](const std::string& text) { options.link_error_rate = parse_link_fault(text); });
}

}  // namespace torolux
