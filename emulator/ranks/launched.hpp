// SPDX-License-Identifier: MIT
// The environment enters; where this process runs, and how many ranks it was started as one of, leave.
#pragma once

#include <string>
#include <vector>

#include "emulator/ranks/transport.hpp"

namespace torolux::ranks {

/// As mpirun of OpenMPI, of MPICH and its relatives, and Slurm's srun with PMI or PMIx tell it; one rank where nobody
/// does.
Ranks launched_ranks();

/// Of this computer.
std::string host_name();

/// This process's environment without what makes a child take itself for a rank. Where no launcher has started this
/// process, a user's settings for one (OMPI_MCA_...) stay.
std::vector<std::string> environment_of_no_rank();

}  // namespace torolux::ranks
