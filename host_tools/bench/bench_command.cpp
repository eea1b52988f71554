// SPDX-License-Identifier: MIT
// `torolux bench engine`: a scene enters, the engine's speed in the machine and alone leaves, on standard output.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include "emulator/errors.hpp"
#include "host_tools/bench/engine_bench.hpp"
#include "host_tools/cli/command.hpp"
#include "host_tools/cli/firmware_image.hpp"
#include "host_tools/cli/parse_values.hpp"
#include "host_tools/report/text.hpp"
#include "host_tools/scene/load_scene.hpp"

namespace torolux {
namespace {

constexpr std::size_t kLabel = 26;

struct BenchOptions {
  std::optional<std::string> scene, machine;
  std::string pes = "4x4";
  unsigned max_shots = 200;
  unsigned size = 64;
  unsigned repetitions = 3;
  unsigned threads = 0;
};

/// The Cornell box of the source tree in which this program was built.
std::filesystem::path default_scene() {
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  auto scene = (program.parent_path() / "../../../scenes/cornell_box").lexically_normal();
  if (error || !std::filesystem::is_directory(scene)) {
    throw UsageError("no scene at " + scene.string() + ": name one");
  }
  return scene;
}

void print_speed(const std::string& label, const EngineSpeed& speed) {
  std::cout << left(label, kLabel) << right(significant(speed.instructions_per_second() * 1e-6, 4), 10)
            << " million instructions/s   (" << grouped(speed.instructions) << " in "
            << significant(speed.wall_seconds, 4) << " s; "
            << significant(speed.instructions_per_cpu_second() * 1e-6, 4) << " million per second of host CPU)\n";
}

void print_engine(const std::string& name, const EngineResult& result) {
  print_speed(name + " in the machine", result.machine);
  print_speed(name + " alone", result.bare);
  std::cout << left("  ratio", kLabel) << right(significant(result.ratio(), 3), 10) << " by wall time, "
            << significant(result.cpu_ratio(), 3) << " by host CPU time of the PEs\n"
            << left("  emulator's own share", kLabel) << right(percent(result.emulator_share()), 10) << " of "
            << significant(result.scheduler_seconds + result.machine.cpu_seconds, 4) << " s of host CPU\n";
}

void print(const EngineBenchResult& result) {
  print_engine("translated", result.translated);
  print_engine("qemu", result.qemu);
  const double alone =
      result.translated.bare.instructions_per_cpu_second() / result.qemu.bare.instructions_per_cpu_second();
  const double in_machine = result.qemu.machine.wall_seconds / result.translated.machine.wall_seconds;
  std::cout << left("translated : qemu", kLabel) << right(significant(alone, 3), 10) << " alone, per host CPU; "
            << significant(in_machine, 3) << " in the machine, by wall time\n";
  if (!result.whole) {
    std::cout << "Alone they repeated only the beginning of the run: a log was full.\n";
  }
  std::cout << std::flush;
}

int run_bench_engine(const BenchOptions& options) {
  const Scene scene = load_scene(options.scene ? std::filesystem::path(*options.scene) : default_scene(), {});
  check_renderable(scene);
  EngineBenchJob job{scene, scene.camera.value_or(Camera{}), {}, {}, firmware_image()};
  job.quality.width = job.quality.height = options.size;
  job.quality.max_shots = options.max_shots;
  job.repetitions = options.repetitions;
  const auto pes = parse_pes(options.pes);
  job.machine.columns = pes[0];
  job.machine.rows = pes[1];
  job.machine.threads = options.threads;
  if (options.machine) {
    job.machine.description = load_machine_description(*options.machine);
  }
  const auto tell = [](const char* step) { std::cerr << "torolux: " << step << "\n"; };
  const EngineBenchResult result = bench_engine(job, tell, [](const RenderProgress&) { return !interrupted(); });
  if (interrupted()) {
    return kInterrupted;
  }
  print(result);
  return 0;
}

}  // namespace

void add_bench_command(CLI::App& app, CommandAction& action) {
  const auto options = std::make_shared<BenchOptions>();
  CLI::App* bench = app.add_subcommand("bench", "Measure this program");
  bench->require_subcommand(1);
  CLI::App* engine = bench->add_subcommand(
      "engine",
      "Instructions per second of each engine: the PEs in a render, and the same PEs with nothing around them");
  engine->add_option("SCENE", options->scene, "As for render [the Cornell box]")->type_name("");
  engine->add_option("--pes", options->pes, "PEs of the torus, columns x rows")
      ->type_name("PxQ")
      ->capture_default_str();
  engine->add_option("--size", options->size, "Pixels along each side of the picture")
      ->type_name("N")
      ->check(CLI::Range(1U, 4096U))
      ->capture_default_str();
  engine->add_option("--max-shots", options->max_shots, "Patches shot in all; 0: no limit")
      ->type_name("N")
      ->capture_default_str();
  engine->add_option("--repetitions", options->repetitions, "Measurements of each, by turns; the fastest counts")
      ->type_name("N")
      ->check(CLI::Range(1U, 1000U))
      ->capture_default_str();
  engine->add_option("--machine", options->machine, "Parameters of the machine [built in]")->type_name("FILE.toml");
  engine->add_option("--threads", options->threads, "Threads of this computer that work for the machine [all cores]")
      ->type_name("N")
      ->check(CLI::Range(1U, 4096U));
  engine->callback([options, &action] { action = [options] { return run_bench_engine(*options); }; });
}

}  // namespace torolux
