// SPDX-License-Identifier: MIT
// A process that mpirun has started enters, its transport leaves.
#pragma once

#include <memory>

#include "emulator/ranks/transport.hpp"

namespace torolux::ranks {

/// Joins the others; once in a process. Throws UsageError where this build has no MPI, or another one than mpirun's.
std::unique_ptr<Transport> join_mpi();

}  // namespace torolux::ranks
