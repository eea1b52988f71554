// SPDX-License-Identifier: MIT
// Stands in for mpi_ranks.cpp in a build without MPI.
#include "emulator/ranks/mpi_ranks.hpp"

namespace torolux::ranks {

std::unique_ptr<Transport> join_mpi() {
  throw UsageError(
      "this torolux was built without MPI and would run once for each rank; start it without mpirun, or install "
      "mpi-default-dev and build it anew");
}

std::vector<std::string> mpi_launcher() {
  throw UsageError("--ranks: this torolux was built without MPI; install mpi-default-dev and build it anew");
}

}  // namespace torolux::ranks
