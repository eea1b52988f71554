// SPDX-License-Identifier: MIT
// Variables that launchers set become numbers.
#include "emulator/ranks/launched.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include "emulator/ranks/starter.hpp"

namespace torolux::ranks {
namespace {

struct Launcher {
  const char* count;
  const char* own;
};

/// OpenMPI; Hydra (MPICH, Intel MPI, MVAPICH) and srun --mpi=pmi2; srun --mpi=pmix, whose own number is PMIx's.
constexpr std::array<Launcher, 3> kLaunchers = {{{"OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK"},
                                                 {"PMI_SIZE", "PMI_RANK"},
                                                 {"SLURM_STEP_NUM_TASKS", "PMIX_RANK"}}};
constexpr std::array<std::string_view, 4> kOfLaunchers = {"OMPI_", "PMI_", "PMIX_", "HYDI_"};

/// Whether a launcher has started this process, or what has started it.
bool of_launcher() {
  return std::ranges::any_of(kLaunchers, [](const Launcher& one) { return std::getenv(one.own) != nullptr; });
}

std::optional<unsigned> number(const char* name) {
  const char* text = std::getenv(name);
  if (text == nullptr) return std::nullopt;
  unsigned value = 0;
  const char* end = text + std::strlen(text);
  const auto read = std::from_chars(text, end, value);
  return read.ec == std::errc() && read.ptr == end ? std::optional(value) : std::nullopt;
}

}  // namespace

Ranks launched_ranks() {
  for (const Launcher& launcher : kLaunchers) {
    const std::optional<unsigned> count = number(launcher.count);
    const std::optional<unsigned> own = number(launcher.own);
    if (count && own && *own < *count) return {*own, *count};
  }
  return {};
}

std::string host_name() {
  std::array<char, 256> name{};
  ::gethostname(name.data(), name.size() - 1);
  return name.data();
}

std::vector<std::string> environment_of_no_rank() {
  const bool has_launcher = of_launcher();
  std::vector<std::string> kept;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string_view text = *variable;
    const auto starts = [text](std::string_view prefix) { return text.starts_with(prefix); };
    if (starts(kStarterVariable) || (has_launcher && std::ranges::any_of(kOfLaunchers, starts))) continue;
    kept.emplace_back(text);
  }
  return kept;
}

}  // namespace torolux::ranks
