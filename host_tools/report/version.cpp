// SPDX-License-Identifier: MIT
// The commit that the build wrote down (cmake/commit.cmake) leaves.
#include "host_tools/report/version.hpp"

#include "commit.hpp"

namespace torolux {

const char* program_commit() {
  return kCommit;
}

}  // namespace torolux
