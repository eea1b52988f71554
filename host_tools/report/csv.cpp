// SPDX-License-Identifier: MIT
// A function for each table, from its line of names to its rows. Numbers are written so that they read back as the same
// bits.
#include "host_tools/report/csv.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <concepts>
#include <string_view>
#include <system_error>

#include "emulator/errors.hpp"
#include "host_tools/files/write_file.hpp"
#include "host_tools/report/limits.hpp"
#include "host_tools/report/sums.hpp"

namespace torolux {
namespace {

/// A line that grows cell by cell. Numbers read back as the same bits.
class Line {
 public:
  Line& add(std::string_view text) {
    if (!text_.empty()) text_ += ',';
    text_ += text;
    return *this;
  }
  template <class Number>
  requires std::integral<Number> || std::floating_point<Number> Line& add(Number value) {
    std::array<char, 32> buffer{};
    const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    return add(std::string_view(buffer.data(), static_cast<std::size_t>(result.ptr - buffer.data())));
  }
  template <class Names>
  Line& add_names(std::string_view prefix, const Names& names) {
    for (const auto& name : names) add(std::string(prefix) + std::string(name));
    return *this;
  }
  template <class Values>
  Line& add_all(const Values& values, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) add(values[i]);
    return *this;
  }
  std::string text() const { return text_; }

 private:
  std::string text_;
};

/// A text of the user's in a table (RFC 4180).
std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

CsvTable pes_table(const MachineFigures& machine) {
  CsvTable table{"pes", "", {}};
  Line header;
  header.add("stage,pe,begin,cycles,busy_cycles");
  header.add_names("wait_", kWaitReasonNames);
  header.add("idle_at_end,instructions,packets_sent,packets_delivered,records_diverted,copy_out_cycles,copy_in_cycles");
  for (const std::string& phase : machine.phases) {
    if (!phase.empty()) header.add(csv_text("phase_" + phase));
  }
  header.add("phase_outside");
  table.header = header.text();
  for (const StageFigures& stage : machine.stages) {
    for (std::size_t pe = 0; pe < stage.figures.pes.size(); ++pe) {
      const PeFigures& figures = stage.figures.pes[pe];
      Line row;
      row.add(stage.name).add(pe).add(figures.begin).add(figures.cycles).add(figures.busy_cycles);
      row.add_all(figures.waits, kWaitReasons).add(figures.idle_at_end).add(figures.instructions);
      row.add(figures.packets_sent).add(figures.packets_delivered).add(figures.records_diverted);
      row.add(figures.copy_out_cycles).add(figures.copy_in_cycles);
      for (std::size_t i = 0; i < machine.phases.size(); ++i) {
        if (!machine.phases[i].empty()) row.add(figures.phase_cycles[i]);
      }
      row.add(figures.outside_phases());
      table.rows.push_back(row.text());
    }
  }
  return table;
}

CsvTable stages_table(const MachineFigures& machine, const std::vector<RoundFigures>& rounds) {
  CsvTable table{"stages", "", {}};
  Line header;
  header.add("stage,begin,cycles,pe_busy_cycles").add_names("pe_wait_", kWaitReasonNames);
  header.add("pe_idle_at_end,packets,hops,records_diverted,bus_busy_cycles,frame_buffer_busy_cycles,host_busy_cycles");
  header.add("limit,limit_share").add_names("share_", kLimitNames);
  table.header = header.text();
  for (const StageFigures& stage : machine.stages) {
    const MachineFigures& figures = stage.figures;
    const PeSums sums = sums_of(figures.pes);
    const Limits limits = limits_of(stage, rounds);
    Line row;
    row.add(stage.name).add(stage.begin).add(figures.now).add(sums.busy).add_all(sums.waits, kWaitReasons);
    row.add(sums.idle_at_end).add(sums.delivered).add(figures.packets.hops).add(sums.diverted);
    row.add(figures.bus.busy_cycles()).add(figures.frame_buffer_busy_cycles).add(figures.host.busy_cycles);
    row.add(kLimitNames[static_cast<std::size_t>(limits.by)]).add(limits.share()).add_all(limits.shares, kLimits);
    table.rows.push_back(row.text());
  }
  return table;
}

CsvTable bus_table(const MachineFigures& machine) {
  CsvTable table{"bus", "stage,by,name,transfers,bytes,cycles", {}};
  const auto add = [&](const std::string& stage, std::string_view by, std::string_view name,
                       const BusTraffic& traffic) {
    Line row;
    row.add(stage).add(by).add(name).add(traffic.transfers).add(traffic.bytes).add(traffic.cycles);
    table.rows.push_back(row.text());
  };
  for (const StageFigures& stage : machine.stages) {
    const BusFigures& bus = stage.figures.bus;
    for (std::size_t i = 0; i < kBusUsers; ++i) add(stage.name, "requester", kBusUserNames[i], bus.users[i]);
    for (std::size_t i = 0; i < kBusKinds; ++i) add(stage.name, "kind", kBusKindNames[i], bus.kinds[i]);
    for (std::size_t pe = 0; pe < bus.from_pe.size(); ++pe) {
      add(stage.name, "from_pe", std::to_string(pe), bus.from_pe[pe]);
      add(stage.name, "to_pe", std::to_string(pe), bus.to_pe[pe]);
    }
  }
  return table;
}

CsvTable links_table(const MachineFigures& machine) {
  CsvTable table{
      "links", "stage,pe,link,packets,flits,wasted_flits,busy_cycles,idle_cycles,stalled_cycles,queue_high_water", {}};
  for (const StageFigures& stage : machine.stages) {
    const auto add = [&](std::size_t pe, std::string_view name, const LinkFigures& link) {
      Line row;
      row.add(stage.name).add(pe).add(name).add(link.packets).add(link.flits).add(link.wasted_flits).add(link.busy);
      row.add(stage.figures.now - link.busy).add(link.stalled).add(link.queue_high_water);
      table.rows.push_back(row.text());
    };
    for (std::size_t pe = 0; pe < stage.figures.routers.size(); ++pe) {
      const RouterFigures& router = stage.figures.routers[pe];
      for (std::size_t i = 0; i < kLinks; ++i) add(pe, kLinkNames[i], router.links[i]);
      add(pe, "injection", router.injection);
      add(pe, "ejection", router.ejection);
    }
  }
  return table;
}

CsvTable histograms_table(const MachineFigures& machine) {
  CsvTable table{"histograms", "stage,histogram,least,most,packets,bytes", {}};
  for (const StageFigures& stage : machine.stages) {
    const PacketFigures& packets = stage.figures.packets;
    const auto add = [&](std::string_view name, std::uint64_t least, std::uint64_t most, std::uint64_t count,
                         const std::string& bytes) {
      if (count == 0) return;
      Line row;
      table.rows.push_back(row.add(stage.name).add(name).add(least).add(most).add(count).add(bytes).text());
    };
    for (std::size_t h = 0; h < packets.by_hops.size(); ++h) {
      add("hops", h, h, packets.by_hops[h], std::to_string(packets.bytes_by_hops[h]));
    }
    for (std::size_t n = 0; n < packets.by_records.size(); ++n) {
      add("records", n, n, packets.by_records[n], std::to_string(packets.bytes_by_records[n]));
    }
    for (std::size_t i = 0; i < packets.by_latency.size(); ++i) {
      const std::uint64_t end = std::uint64_t{1} << i;
      add("latency", end / 2, end - 1, packets.by_latency[i], "");
    }
  }
  return table;
}

CsvTable kinds_table(const MachineFigures& machine) {
  CsvTable table{"kinds", "stage,kind,packets,records,bytes", {}};
  for (const StageFigures& stage : machine.stages) {
    for (const KindFigures& kind : stage.figures.record_kinds) {
      Line row;
      table.rows.push_back(
          row.add(stage.name).add(kind.name).add(kind.packets).add(kind.records).add(kind.bytes).text());
    }
  }
  return table;
}

CsvTable time_line_table(const MachineFigures& machine) {
  CsvTable table{"timeline", "", {}};
  Line header;
  header.add("begin,cycles,load,packets,bus_cycles,frame_buffer_cycles,host_cycles").add_names("", kHostGaugeNames);
  table.header = header.text();
  const TimeLineFigures& line = machine.time_line;
  for (std::size_t i = 0; i < line.slices.size(); ++i) {
    const TimeSlice& slice = line.slices[i];
    const Cycles begin = i * line.width;
    Line row;
    row.add(begin).add(std::min(line.width, machine.now - begin)).add(slice.load).add(slice.packets);
    row.add(slice.bus_cycles).add(slice.frame_buffer_cycles).add(slice.host_cycles);
    table.rows.push_back(row.add_all(slice.gauges, kHostGauges).text());
  }
  return table;
}

CsvTable host_table(const MachineFigures& machine) {
  CsvTable table{"host", "stage,work,items,own_cycles", {}};
  for (const StageFigures& stage : machine.stages) {
    for (std::size_t i = 0; i < kHostWorks; ++i) {
      Line row;
      row.add(stage.name).add(kHostWorkNames[i]).add(stage.figures.host.items[i]);
      table.rows.push_back(row.add(stage.figures.host.own_cycles[i]).text());
    }
  }
  return table;
}

CsvTable rounds_table(const std::vector<RoundFigures>& rounds) {
  CsvTable table{"rounds", "round,begin,chosen,last_shot_done,end,tail,shooters,pes,records,unshot", {}};
  for (std::size_t i = 0; i < rounds.size(); ++i) {
    const RoundFigures& round = rounds[i];
    Line row;
    row.add(i).add(round.begin).add(round.chosen).add(round.last_shot_done).add(round.end).add(round.tail());
    table.rows.push_back(row.add(round.shooters).add(round.pes).add(round.records).add(round.unshot).text());
  }
  return table;
}

CsvTable visits_table(const RenderFigures& figures) {
  CsvTable table{"visits", "stage,subspaces,segments", {}};
  const auto add = [&](std::string_view stage, const VisitSums& segments) {
    for (std::size_t n = 0; n < segments.size(); ++n) {
      Line row;
      if (segments[n] != 0) table.rows.push_back(row.add(stage).add(n).add(segments[n]).text());
    }
  };
  add("radiosity", figures.radiosity_visits);
  add("ray_tracing", figures.ray_visits);
  return table;
}

/// rounds: for what bounds the stages.
std::vector<CsvTable> machine_tables(const MachineFigures& machine, const std::vector<RoundFigures>& rounds) {
  std::vector<CsvTable> tables = {stages_table(machine, rounds), pes_table(machine),   bus_table(machine),
                                  host_table(machine),           links_table(machine), histograms_table(machine),
                                  time_line_table(machine)};
  if (!machine.record_kinds.empty()) tables.push_back(kinds_table(machine));
  return tables;
}

}  // namespace

std::string CsvTable::text() const {
  std::string text = header + "\n";
  for (const std::string& row : rows) text += row + "\n";
  return text;
}

std::vector<CsvTable> stats_tables(const MachineFigures& machine) {
  return machine_tables(machine, {});
}

std::vector<CsvTable> stats_tables(const RenderFigures& figures) {
  std::vector<CsvTable> tables = machine_tables(figures.machine, figures.rounds);
  if (!figures.rounds.empty()) tables.push_back(rounds_table(figures.rounds));
  tables.push_back(visits_table(figures));
  return tables;
}

void check_stats_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw InputError(folder.string() + ": the folder cannot be made: " + error.message());
  check_file_writable(folder / "stages.csv");
}

void write_stats_tables(const std::filesystem::path& folder, const std::vector<CsvTable>& tables) {
  for (const CsvTable& table : tables) write_file(folder / (table.name + ".csv"), table.text());
}

}  // namespace torolux
