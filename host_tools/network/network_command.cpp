// SPDX-License-Identifier: MIT
// `torolux network`: a pattern of traffic and rates enter; throughput, latency, load and fairness leave.
#include <CLI/CLI.hpp>
#include <array>
#include <iostream>
#include <memory>
#include <optional>
#include <vector>

#include "emulator/errors.hpp"
#include "emulator/traffic/pattern.hpp"
#include "emulator/traffic/traffic.hpp"
#include "host_tools/cli/command.hpp"
#include "host_tools/cli/fault_options.hpp"
#include "host_tools/cli/named_value.hpp"
#include "host_tools/cli/parse_values.hpp"
#include "host_tools/cli/render_options.hpp"
#include "host_tools/network/network_columns.hpp"
#include "host_tools/report/text.hpp"

namespace torolux {
namespace {

struct NetworkOptions {
  std::string pes = "8x8";
  std::string traffic = "uniform";
  std::string rates = "0.1";
  std::string format = "table";
  std::uint32_t packet_flits = 4;
  std::uint32_t seed = 1;
  std::uint64_t warm_up = 5000;
  std::optional<std::uint64_t> cycles;
  bool to_itself = false;
  std::optional<std::string> machine;
  std::vector<std::string> machine_values;  ///< KEY=VALUE, checked
  FaultOptions faults;
};

constexpr std::uint64_t kMostNetworkCycles = 1'000'000'000;

struct Column {
  const char* name;
  double TrafficFigures::*value;
};
constexpr std::array<Column, 8> kColumns = {{{"offered", &TrafficFigures::offered},
                                             {"accepted", &TrafficFigures::accepted},
                                             {"mean_latency", &TrafficFigures::mean_latency},
                                             {"p99_latency", &TrafficFigures::p99_latency},
                                             {"max_latency", &TrafficFigures::max_latency},
                                             {"mean_hops", &TrafficFigures::mean_hops},
                                             {"max_link_load", &TrafficFigures::max_link_load},
                                             {"fairness", &TrafficFigures::fairness}}};

/// One line, of the columns' names or of a row's values.
template <class Text>
void print_line(bool csv, Text text) {
  for (const Column& column : kColumns) {
    if (csv && &column != kColumns.data()) std::cout << ',';
    std::cout << (csv ? text(column) : right(text(column), 14));
  }
  std::cout << std::endl;
}

int run_network(const NetworkOptions& options) {
  TrafficSetup setup;
  const auto pes = value_of("--pes", parse_pes, options.pes);
  setup.columns = pes[0];
  setup.rows = pes[1];
  if (options.machine) setup.machine = load_machine_description(*options.machine);
  for (const std::string& value : options.machine_values) set_machine_value(setup.machine, value);
  options.faults.apply_to(setup.machine);
  setup.pattern = options.traffic;
  setup.to_itself = options.to_itself;
  setup.packet_flits = options.packet_flits;
  setup.seed = options.seed;
  setup.warm_up = options.warm_up;
  setup.cycles = options.cycles;
  const std::vector<double> rates = value_of("--rate", parse_rates, options.rates);
  value_of(
      "--traffic",
      [&](const std::string& name) {
        return make_traffic_pattern(name, TorusShape(setup.columns, setup.rows), setup.to_itself);
      },
      options.traffic);

  const bool csv = options.format == "csv";
  print_line(csv, [](const Column& column) { return std::string(column.name); });
  for (const double rate : rates) {
    if (!std::cout) break;  // nobody reads it; torolux_main says so
    setup.rate = rate;
    const TrafficFigures figures = run_traffic(setup, [] { return !interrupted(); });
    print_line(csv, [&](const Column& column) { return significant(figures.*column.value, 6); });
  }
  return 0;
}

}  // namespace

std::vector<std::string> network_columns() {
  std::vector<std::string> names;
  names.reserve(kColumns.size());
  for (const Column& column : kColumns) names.emplace_back(column.name);
  return names;
}

void add_network_command(CLI::App& app, CommandAction& action) {
  const auto options = std::make_shared<NetworkOptions>();
  CLI::App* command = app.add_subcommand("network", "Drive the torus alone with synthetic traffic");
  const auto last = CLI::MultiOptionPolicy::TakeLast;
  command->add_option("--pes", options->pes, "PEs of the torus, columns x rows")
      ->type_name("PxQ")
      ->capture_default_str()
      ->multi_option_policy(last);
  command->add_option("--traffic", options->traffic, "uniform, tornado, transpose, bit-complement or hotspot")
      ->type_name("NAME")
      ->capture_default_str()
      ->multi_option_policy(last);
  command->add_option("--rate", options->rates, "Offered by each node that sends, flits per cycle, up to 1; a row each")
      ->type_name("R[,R...]")
      ->capture_default_str()
      ->multi_option_policy(last);
  command->add_option("--packet-flits", options->packet_flits, "Length of a packet, flits")
      ->type_name("N")
      ->check(CLI::Range(1U, kMostTrafficFlits))
      ->capture_default_str();
  command->add_flag("--self", options->to_itself, "Nodes send packets to themselves, too, where the pattern says so");
  command->add_option("--machine", options->machine, "Parameters of the machine [built in]")->type_name("FILE.toml");
  add_machine_values_option(*command, options->machine_values, "");
  add_fault_options(*command, options->faults, "");
  command->add_option("--seed", options->seed, "Of the traffic")->type_name("N")->capture_default_str();
  command->add_option("--warm-up", options->warm_up, "Cycles before anything is measured")
      ->type_name("N")
      ->check(CLI::Range(std::uint64_t{0}, kMostNetworkCycles))
      ->capture_default_str();
  command->add_option("--cycles", options->cycles, "Cycles in which it is [enough for 100 packets of each node]")
      ->type_name("N")
      ->check(CLI::Range(std::uint64_t{1}, kMostNetworkCycles));
  command->add_option("--format", options->format, "table or csv")
      ->type_name("NAME")
      ->check(CLI::IsMember({"table", "csv"}))
      ->capture_default_str();
  command->callback([options, &action] { action = [options] { return run_network(*options); }; });
}

}  // namespace torolux
