// SPDX-License-Identifier: MIT
// An image that names its phases, made by hand: statistics, tables and traces have those names, and the right cycles.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>

#include "host_tools/report/csv.hpp"
#include "host_tools/run/run.hpp"
#include "host_tools/trace/perfetto_trace.hpp"
#include "tests/translated/assembler.hpp"
#include "tests/unit/emulator/engines/elf_builder.hpp"

namespace torolux {
namespace {

using protocol::Hint;
using testing::HasSubstr;
using testing::StartsWith;

test::Word marker(Hint of, int phase) {
  return protocol::hint_instruction(static_cast<std::int32_t>(of) + phase);
}

/// Three cycles in phase 9, one in phase 10, two in none. names: records of phases.
Image image_with(const std::vector<std::pair<std::uint32_t, std::string>>& names) {
  test::ElfPlan plan;
  const test::Word nop = test::addi(0, 0, 0);
  plan.code = {marker(Hint::enter_phase, 9),
               nop,
               nop,
               nop,
               marker(Hint::leave_phase, 9),
               marker(Hint::enter_phase, 10),
               nop,
               marker(Hint::leave_phase, 10),
               test::hint(Hint::halt)};
  for (const auto& [number, name] : names) {
    std::vector<std::byte> record(28);
    std::memcpy(record.data(), &number, sizeof number);
    std::memcpy(record.data() + sizeof number, name.data(), name.size());
    plan.phases.insert(plan.phases.end(), record.begin(), record.end());
  }
  return parse_image(test::build_elf(plan), "phases.elf");
}

MachineSetup one_pe() {
  MachineSetup setup;
  setup.columns = setup.rows = 1;
  setup.engine = kInterpretedEngine;
  return setup;
}

MachineFigures run(const Image& image, MachineSetup setup = one_pe()) {
  return run_image(setup, image, [](const PeText&) {}, {});
}

nlohmann::ordered_json phases_in_statistics(const MachineFigures& figures) {
  const std::string text = run_stats_json(one_pe(), {{{"image", "phases.elf", "0"}}, {}}, figures, 0);
  const auto json = nlohmann::ordered_json::parse(text);
  EXPECT_EQ(json.at("phases"), json.at("pes").at(0).at("phase_cycles"));
  EXPECT_EQ(json.at("phases"), json.at("stages").at(0).at("phases"));
  return json.at("phases");
}

TEST(PhasesByName, StandInTheStatistics) {
  const MachineFigures figures = run(image_with({{9, "multiply, add"}, {12, "never"}}));
  const nlohmann::ordered_json expected = {
      {"program", 0}, {"multiply, add", 3}, {"phase_10", 1}, {"never", 0}, {"outside", 2}};
  EXPECT_EQ(phases_in_statistics(figures).dump(), expected.dump());
}

TEST(PhasesByName, AreThoseOfToroluxWhereAnImageNamesNone) {
  const nlohmann::ordered_json phases = phases_in_statistics(run(image_with({})));
  EXPECT_THAT(phases.dump(), StartsWith(R"({"load":0,"shoot":0,)"));
  EXPECT_THAT(phases.dump(), HasSubstr(R"("program":0,"phase_9":3,"phase_10":1,"outside":2})"));
}

TEST(PhasesByName, AreColumnsOfTheTables) {
  const MachineFigures figures = run(image_with({{9, "multiply, \"add\""}}));
  for (const CsvTable& table : stats_tables(figures)) {
    if (table.name != "pes") continue;
    EXPECT_THAT(table.header, HasSubstr("phase_program,\"phase_multiply, \"\"add\"\"\",phase_phase_10,phase_outside"));
    EXPECT_THAT(table.rows.at(0), testing::EndsWith(",0,3,1,2"));
  }
}

TEST(PhasesByName, StandInTheTrace) {
  std::string bytes;
  PerfettoTrace trace(TraceChoice{.grain_shift = 0}, [&](std::string_view part) { bytes += part; });
  MachineSetup setup = one_pe();
  setup.watcher = &trace;
  run(image_with({{9, "multiply"}}), setup);
  trace.finish();
  EXPECT_THAT(bytes, HasSubstr("multiply"));
  EXPECT_THAT(bytes, HasSubstr("phase_10"));
}

}  // namespace
}  // namespace torolux
