// SPDX-License-Identifier: MIT
// The built torolux on several ranks, with the real mpirun: words enter; a child, and the process of each rank, leave.
#pragma once

#include <sys/types.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "host_tools/study/child.hpp"

namespace torolux::test {

namespace fs = std::filesystem;

/// Of the MPI that this build has; a file that does not exist: it has none.
inline const std::string kMpirun = TOROLUX_MPIRUN;

inline fs::path torolux_file() {
  return fs::read_symlink("/proc/self/exe").parent_path() / "torolux";
}

/// Root in a container, and more ranks than cores: OpenMPI wants to be told that this is meant.
inline study::Child mpirun(unsigned ranks, const std::vector<std::string>& words) {
  std::vector<std::string> all = {"OMPI_ALLOW_RUN_AS_ROOT=1",
                                  "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1",
                                  "OMPI_MCA_rmaps_base_oversubscribe=1",
                                  kMpirun,
                                  "-n",
                                  std::to_string(ranks),
                                  torolux_file().string()};
  all.insert(all.end(), words.begin(), words.end());
  return {"env", all};
}

/// Of a process that may have ended meanwhile, or be somebody else's: then empty.
inline std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// The processes of this rank that work on this folder.
inline std::vector<pid_t> processes_of(unsigned rank, const fs::path& folder) {
  std::vector<pid_t> processes;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string environment = '\0' + text_of(entry.path() / "environ");
    const auto says = [&](const std::string& variable) {
      return environment.find('\0' + variable + "=" + std::to_string(rank) + '\0') != std::string::npos;
    };
    const std::string words = text_of(entry.path() / "cmdline");
    if ((says("OMPI_COMM_WORLD_RANK") || says("PMI_RANK")) && words.find(folder.string()) != std::string::npos &&
        words.starts_with(torolux_file().string()))
      processes.push_back(static_cast<pid_t>(std::stol(entry.path().filename())));
  }
  return processes;
}

/// One of them; 0: there is none.
inline pid_t process_of(unsigned rank, const fs::path& folder) {
  const std::vector<pid_t> processes = processes_of(rank, folder);
  return processes.empty() ? 0 : processes.front();
}

/// Of the main thread of a process.
inline std::vector<pid_t> children_of(pid_t process) {
  const std::string folder = "/proc/" + std::to_string(process) + "/task/" + std::to_string(process);
  std::istringstream text(text_of(folder + "/children"));
  return {std::istream_iterator<pid_t>(text), std::istream_iterator<pid_t>()};
}

/// Of a rank that --ranks has started; 0: not there.
struct RankProcesses {
  pid_t keeper = 0, rank = 0;
};
inline RankProcesses rank_and_keeper(unsigned rank, const fs::path& folder) {
  const std::vector<pid_t> processes = processes_of(rank, folder);
  for (const pid_t keeper : processes) {
    for (const pid_t child : children_of(keeper)) {
      if (std::find(processes.begin(), processes.end(), child) != processes.end()) return {keeper, child};
    }
  }
  return {};
}

}  // namespace torolux::test
