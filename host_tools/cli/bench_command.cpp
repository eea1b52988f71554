// SPDX-License-Identifier: MIT
// `torolux bench`: scenes enter; the engines' speeds in the machine and alone, what the emulator itself costs, or what
// more cores bring, leaves on standard output.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "emulator/errors.hpp"
#include "host_tools/bench/cores_bench.hpp"
#include "host_tools/bench/emulator_bench.hpp"
#include "host_tools/bench/engine_bench.hpp"
#include "host_tools/cli/command.hpp"
#include "host_tools/cli/firmware_image.hpp"
#include "host_tools/cli/own_scenes.hpp"
#include "host_tools/cli/parse_values.hpp"
#include "host_tools/report/text.hpp"
#include "host_tools/scene/load_scene.hpp"

namespace torolux {
namespace {

constexpr std::size_t kLabel = 26;
/// The innermost loop of a PE: rays against triangles (tests/images).
constexpr const char* kKernel = "triangles.elf";
constexpr std::array kCores = {1U, 2U, 4U, 8U, 16U, 32U, 64U};

struct BenchOptions {
  std::vector<std::string> scenes;
  std::optional<std::string> machine;
  std::vector<std::string> pes = {"4x4"};
  unsigned max_shots = 200;
  unsigned size = 64;
  unsigned repetitions = 3;
  unsigned threads = 0;
  double exchange = 20;  // [us]
};

/// A scene that came with this program.
std::string own_scene(const char* name) {
  const auto scene = scene_folder() / name;
  std::error_code error;
  if (!std::filesystem::is_directory(scene, error)) throw UsageError("no scene at " + scene.string() + ": name one");
  return scene.string();
}

void print_speed(const std::string& label, const EngineSpeed& speed) {
  std::cout << left("  " + label, kLabel) << right(significant(speed.instructions_per_second() * 1e-6, 4), 8)
            << right(significant(speed.instructions_per_cpu_second() * 1e-6, 4), 16)
            << right(significant(speed.wall_seconds, 4), 12) << right(significant(speed.cpu_seconds, 4), 12) << "\n";
}

void print_head(const std::string& what, std::uint64_t instructions) {
  std::cout << what << ": " << grouped(instructions) << " instructions of the PEs\n"
            << left("", kLabel) << "  10^6/s   10^6/s of CPU      wall s       CPU s\n";
}

void print_bare(const BareSpeeds& bare) {
  print_speed("translated, alone", bare.translated);
  print_speed("qemu, alone", bare.qemu);
  if (bare.native) {
    print_speed("native, alone", *bare.native);
  }
  std::cout << left("  translated, by CPU time", kLabel) << right(significant(bare.qemu_ratio(), 3), 8)
            << " times as fast as qemu";
  if (const auto ratio = bare.native_ratio()) {
    std::cout << "; " << significant(*ratio, 3) << " times the time of native";
  }
  std::cout << "\n";
}

void print_in_machine(const std::string& name, const MachineSpeed& speed, const EngineSpeed& alone) {
  print_speed(name + ", in the machine", speed.pes);
  std::cout << left("", kLabel) << "  of its speed alone: "
            << percent(speed.pes.instructions_per_second() / alone.instructions_per_second()) << " by wall time, "
            << percent(speed.pes.instructions_per_cpu_second() / alone.instructions_per_cpu_second())
            << " by CPU time of the PEs; emulator's own share of CPU: " << percent(speed.emulator_share()) << "\n";
}

void print_render(const std::string& scene, const RenderBenchResult& result) {
  print_head(scene, result.translated.pes.instructions);
  print_in_machine("translated", result.translated, result.bare.translated);
  print_in_machine("qemu", result.qemu, result.bare.qemu);
  print_bare(result.bare);
  if (!result.whole) {
    std::cout << "  Alone they repeated only the beginning of the run: a log was full.\n";
  }
  std::cout << std::flush;
}

RenderBenchJob job_of(const Scene& scene, const BenchOptions& options, const std::string& machine_pes) {
  check_renderable(scene);
  RenderBenchJob job{scene, scene.camera.value_or(Camera{}), {}, {}, firmware_image()};
  job.quality.width = job.quality.height = options.size;
  job.quality.max_shots = options.max_shots;
  job.repetitions = options.repetitions;
  const auto pes = parse_pes(machine_pes);
  job.machine.columns = pes[0];
  job.machine.rows = pes[1];
  job.machine.threads = options.threads;
  job.machine.interrupted = &interrupted;
  if (options.machine) {
    job.machine.description = load_machine_description(*options.machine);
  }
  return job;
}

bool go_on(const RenderProgress& /*progress*/) {
  return !interrupted();
}

Scene scene_of(const std::string& name) {
  Scene scene = load_scene(name, {});
  for (const std::string& warning : scene.warnings) std::cerr << "torolux: note: " << warning << "\n";
  return scene;
}

int run_bench_engine(const BenchOptions& options) {
  const auto tell = [](const std::string& what) {
    return [what](const char* step) { std::cerr << "torolux: " << what << ": " << step << "\n"; };
  };
  std::vector<std::string> scenes = options.scenes;
  if (scenes.empty()) {
    scenes = {own_scene("cornell_box"), own_scene("interior")};
  }
  for (const std::string& name : scenes) {
    const Scene scene = scene_of(name);
    const RenderBenchResult result = bench_render(job_of(scene, options, options.pes.front()), tell(scene.name), go_on);
    if (interrupted()) {
      return kInterrupted;
    }
    print_render(scene.name, result);
  }
  const auto kernel = firmware_image().parent_path() / kKernel;
  if (!std::filesystem::exists(kernel)) {
    return 0;  // an installation without the tests' images
  }
  const BareSpeeds speeds =
      bench_image(kernel, options.repetitions, tell("kernel"), [](Cycles) { return !interrupted(); });
  if (interrupted()) {
    return kInterrupted;
  }
  print_head("rays against triangles", speeds.qemu.instructions);
  print_bare(speeds);
  return 0;
}

void print_cost(const std::string& pes, const EmulatorCost& cost) {
  const double nanoseconds = 1e9 * cost.scheduler_seconds / std::max(1.0, static_cast<double>(cost.packets));
  const double links = static_cast<double>(cost.hops) / std::max(1.0, static_cast<double>(cost.packets));
  std::cout << left("  " + pes + " PEs", kLabel) << right(significant(cost.scheduler_seconds, 4), 10)
            << right(significant(cost.pe_seconds, 4), 10) << right(percent(cost.share()), 9)
            << right(percent(cost.program_share()), 10) << right(grouped(cost.packets), 14)
            << right(significant(links, 3), 8) << right(significant(nanoseconds, 4), 13) << "\n"
            << std::flush;
}

/// A heading for each scene, then what `measure` prints of each number of PEs; it is given job and number.
template <class Measure>
int run_for_each_size(const BenchOptions& options, const char* heading, Measure measure) {
  const std::vector<std::string> scenes = options.scenes.empty() ? std::vector{own_scene("interior")} : options.scenes;
  for (const std::string& name : scenes) {
    const Scene scene = scene_of(name);
    std::cout << scene.name << "\n" << left("", kLabel) << heading << "\n";
    for (const std::string& pes : options.pes) {
      measure(job_of(scene, options, pes), pes);
      if (interrupted()) return kInterrupted;
    }
  }
  return 0;
}

int run_bench_emulator(const BenchOptions& options) {
  return run_for_each_size(options, "emulator s     PEs s    share   program       packets   links  ns a packet",
                           [](const RenderBenchJob& job, const std::string& pes) {
                             const EmulatorCost cost = bench_emulator(job, go_on);
                             if (!interrupted()) print_cost(pes, cost);
                           });
}

void print_times(const std::string& pes, const std::vector<CoresTime>& times) {
  const double one = times.front().measured;
  for (const CoresTime& time : times) {
    const bool measured = time.measured != 0;
    std::cout << left(time.cores == 1 ? "  " + pes + " PEs" : "", kLabel) << right(std::to_string(time.cores), 5)
              << right(significant(time.predicted, 3), 12) << right(significant(one / time.predicted, 3), 10)
              << right(time.on_ranks != 0 ? significant(one / time.on_ranks, 3) : "", 10)
              << right(measured ? significant(time.measured, 3) : "", 13)
              << right(measured ? significant(one / time.measured, 3) : "", 10) << "\n";
  }
  std::cout << std::flush;
}

int run_bench_cores(const BenchOptions& options) {
  const unsigned here = options.threads != 0 ? options.threads : std::max(1U, std::thread::hardware_concurrency());
  return run_for_each_size(options, "cores predicted s  speed-up  of ranks   measured s  speed-up",
                           [&](const RenderBenchJob& job, const std::string& pes) {
                             const auto times = bench_cores(job, kCores, here, 1e-6 * options.exchange, go_on);
                             if (!interrupted()) print_times(pes, times);
                           });
}

void add_job_options(CLI::App* bench, BenchOptions& options) {
  bench->add_option("--size", options.size, "Pixels along each side of the picture")
      ->type_name("N")
      ->check(CLI::Range(1U, 4096U))
      ->capture_default_str();
  bench->add_option("--max-shots", options.max_shots, "Patches shot in all; 0: no limit")
      ->type_name("N")
      ->capture_default_str();
  bench->add_option("--repetitions", options.repetitions, "Measurements of each, by turns; the fastest counts")
      ->type_name("N")
      ->check(CLI::Range(1U, 1000U))
      ->capture_default_str();
  bench->add_option("--machine", options.machine, "Parameters of the machine [built in]")->type_name("FILE.toml");
  bench->add_option("--threads", options.threads, "Threads of this computer that work for the machine [all cores]")
      ->type_name("N")
      ->check(CLI::Range(1U, 4096U));
}

/// A subcommand that goes over numbers of PEs.
CLI::App* add_for_each_size(CLI::App* bench, const char* name, const char* description, BenchOptions& options) {
  options.pes = {"4x4", "16x16", "32x32"};
  CLI::App* command = bench->add_subcommand(name, description);
  command->add_option("SCENE", options.scenes, "As for render [the interior]")->type_name("");
  command->add_option("--pes", options.pes, "PEs of the torus, columns x rows; may be repeated")
      ->type_name("PxQ")
      ->take_all()
      ->capture_default_str();
  add_job_options(command, options);
  return command;
}

}  // namespace

void add_bench_command(CLI::App& app, CommandAction& action) {
  CLI::App* bench = app.add_subcommand("bench", "Measure this program");
  bench->require_subcommand(1);

  const auto options = std::make_shared<BenchOptions>();
  CLI::App* engine = bench->add_subcommand(
      "engine",
      "Instructions per second of each engine: the PEs in a render, and the same PEs with nothing around them");
  engine->add_option("SCENE", options->scenes, "As for render [the Cornell box and the interior]")->type_name("");
  engine->add_option("--pes", options->pes, "PEs of the torus, columns x rows")
      ->type_name("PxQ")
      ->expected(1)
      ->capture_default_str();
  add_job_options(engine, *options);
  engine->callback([options, &action] { action = [options] { return run_bench_engine(*options); }; });

  const auto costs = std::make_shared<BenchOptions>();
  CLI::App* emulator = add_for_each_size(
      bench, "emulator", "What the emulator itself costs beside the PEs of the translated engine, by number of PEs",
      *costs);
  emulator->callback([costs, &action] { action = [costs] { return run_bench_emulator(*costs); }; });

  const auto cores = std::make_shared<BenchOptions>();
  CLI::App* predicted = add_for_each_size(
      bench, "cores",
      "What more cores bring: wall time on one, what its turns say of up to 64, and as many as there are (--threads)",
      *cores);
  predicted
      ->add_option("--exchange", cores->exchange, "Time that a message between ranks takes, for the prediction [us]")
      ->type_name("US")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
  predicted->callback([cores, &action] { action = [cores] { return run_bench_cores(*cores); }; });
}

}  // namespace torolux
