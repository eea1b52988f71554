// SPDX-License-Identifier: MIT
// The built torolux on several ranks, with the real mpirun: words enter; a child, and the process of each rank, leave.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <fstream>
#include <iterator>
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

/// The process of this rank that works on this folder; 0: there is none.
inline pid_t process_of(unsigned rank, const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string environment = '\0' + text_of(entry.path() / "environ");
    const auto says = [&](const std::string& variable) {
      return environment.find('\0' + variable + "=" + std::to_string(rank) + '\0') != std::string::npos;
    };
    const std::string words = text_of(entry.path() / "cmdline");
    if ((says("OMPI_COMM_WORLD_RANK") || says("PMI_RANK")) && words.find(folder.string()) != std::string::npos &&
        words.starts_with(torolux_file().string()))
      return static_cast<pid_t>(std::stol(entry.path().filename()));
  }
  return 0;
}

}  // namespace torolux::test
