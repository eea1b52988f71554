// SPDX-License-Identifier: MIT
// A run that never was, with every figure different, for tests of reports.
#pragma once

#include "host_tools/report/figures.hpp"

namespace torolux::testing_support {

inline RunDescription made_up_run() {
  RunDescription run;
  run.scene = "room";
  run.quality.width = 320;
  run.quality.height = 240;
  run.quality.element_length = 0.5;
  run.machine.columns = 2;
  run.machine.rows = 1;
  run.machine.engine = "qemu";
  run.machine.threads = 7;
  run.pictures = {"room.png", "out/room.exr"};
  return run;
}

inline RenderFigures made_up_figures() {
  RenderFigures figures;
  figures.load_cycles = 1'000'000;
  figures.radiosity_cycles = 23'456'789;
  figures.ray_tracing_cycles = 3'000'500;
  figures.shots = 42;
  figures.radiosity_records = 123'456;
  figures.rays = 307'200;
  figures.credits_total = 512;
  figures.credits_home = 512;
  figures.wall_seconds = 83.21;
  figures.local_memory_bytes = 2U << 20U;
  figures.subspaces = {8, 4, 8};
  figures.filled_subspaces = 200;
  figures.radiosity_copies = {150, 512U << 10U};
  figures.ray_tracing_copies = {30, 1U << 20U, 1234};
  MachineFigures& machine = figures.machine;
  machine.now = 27'457'289;
  machine.trace_hash = 0xABCD;
  machine.packets.hops = 2500;
  machine.link_retries = 3;
  machine.bus.data_cycles = 77;
  machine.bus.transfers = 78;
  machine.frame_buffer_busy_cycles = 79;
  machine.pixels_added = 80;
  machine.scheduler_seconds = 1.5;
  machine.program_seconds = 0.5;
  machine.engine_seconds = 160.25;
  machine.pes.resize(2);
  PeFigures& first = machine.pes[0];
  first.busy_cycles = 750;
  first.waits = {100, 20, 10, 5};
  first.idle_at_end = 115;
  first.instructions = 1000;
  first.packets_sent = 600;
  first.packets_delivered = 400;
  first.records_diverted = 5;
  first.record_slots_high_water = 33;
  first.phase_cycles = {10, 20, 30};
  PeFigures& second = machine.pes[1];
  second.busy_cycles = 500;
  second.waits = {200, 0, 0, 0};
  second.idle_at_end = 300;
  second.instructions = 2000;
  second.packets_sent = 400;
  second.packets_delivered = 600;
  second.records_diverted = 6;
  second.record_slots_high_water = 44;
  second.phase_cycles = {1, 2, 3};
  EnergyBalance& energy = figures.energy;
  energy.emitted = {100, 200, 50};
  energy.absorbed = {60, 150, 40};
  energy.absorbed_specular = {10, 5, 1};
  energy.unshot = {1, 2, 0.5};
  energy.escaped = {20, 30, 5};
  energy.cut_off = {5, 8, 2};
  energy.back_side = {3.999, 5, 1.5};
  return figures;
}

/// The same with one of everything: a stage, a round, a slice of time, links.
inline RenderFigures whole_figures() {
  RenderFigures figures = made_up_figures();
  figures.draft_cycles = 17;
  MachineFigures& machine = figures.machine;
  machine.routers.resize(2);
  machine.routers[1].links[2].busy = 5'000'000;
  machine.packets.by_hops = {10, 20};
  machine.packets.bytes_by_hops = {100, 200};
  machine.packets.by_latency[3] = 30;
  machine.record_kinds = {{"light", 1, 2, 128}};
  machine.bus.from_pe.resize(2);
  machine.bus.to_pe.resize(2);
  machine.time_line = {1024, {TimeSlice{}}};
  StageFigures stage{"radiosity", 1'000'000, machine};
  stage.figures.now = 10'000'000;
  machine.stages = {stage};
  figures.rounds = {{1'000'100, 1'000'200, 1'000'300, 1'000'400, 20, 2, 345, 0.25}};
  return figures;
}

}  // namespace torolux::testing_support
