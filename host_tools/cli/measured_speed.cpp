// SPDX-License-Identifier: MIT
// One number in a file for each engine.
#include "host_tools/cli/measured_speed.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "emulator/errors.hpp"
#include "host_tools/files/write_file.hpp"
#include "host_tools/render/predict.hpp"

namespace torolux {
namespace {

constexpr double kLeastSeconds = 2;  ///< below, what else goes on weighs too much
constexpr double kMostTimes = 1000;  ///< what is beyond, either way, is no measurement

/// Empty: there is none.
std::filesystem::path file_of(const std::string& engine) {
  // NOLINTBEGIN(concurrency-mt-unsafe): nothing here changes the environment
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  // NOLINTEND(concurrency-mt-unsafe)
  std::filesystem::path folder;
  if (cache != nullptr && *cache == '/') {
    folder = std::filesystem::path(cache) / "torolux";
  } else if (home != nullptr && *home == '/' && std::filesystem::is_directory(home)) {
    folder = std::filesystem::path(home) / ".cache" / "torolux";
  }
  return folder.empty() ? folder : folder / ("slowness-" + engine);
}

}  // namespace

std::optional<double> measured_slowness(const std::string& engine) {
  const std::filesystem::path file = file_of(engine);
  double times = 0;
  if (file.empty() || !(std::ifstream(file) >> times)) return std::nullopt;
  return times > 1 / kMostTimes && times < kMostTimes ? std::optional(times) : std::nullopt;
}

void remember_speed(const MachineChoice& machine, const RenderFigures& figures) {
  const std::filesystem::path file = file_of(machine.engine);
  const bool alone = machine.debugging.qemu_pes.empty() && machine.debugging.gdb.empty() && !machine.debugging.own;
  if (file.empty() || !alone || figures.run_seconds < kLeastSeconds) return;
  double packets = 0;
  for (const PeFigures& pe : figures.machine.pes) packets += static_cast<double>(pe.packets_sent);
  const double foretold = wall_seconds_of(static_cast<double>(figures.machine.instructions()), packets, machine,
                                          static_cast<unsigned>(figures.machine.pes.size()));
  std::error_code ignored;
  std::filesystem::create_directories(file.parent_path(), ignored);
  try {
    write_file(file, std::to_string(figures.run_seconds / foretold) + "\n");
  } catch (const InputError&) {
    // A prediction is not worth a failure.
  }
}

}  // namespace torolux
