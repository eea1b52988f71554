// SPDX-License-Identifier: MIT
// A process that mpirun has started enters, its transport leaves; and that mpirun.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "emulator/ranks/transport.hpp"

namespace torolux::ranks {

/// Joins the others; once in a process. Throws UsageError where this build has no MPI, or another one than mpirun's.
std::unique_ptr<Transport> join_mpi();

/// mpirun of the MPI that this build has, with what it has to be told so that it starts as many ranks here as are asked
/// for: words to which `-n N` and a program are added. Throws UsageError where this build has no MPI.
std::vector<std::string> mpi_launcher();

}  // namespace torolux::ranks
