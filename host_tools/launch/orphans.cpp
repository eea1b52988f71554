// SPDX-License-Identifier: MIT
// A killed rank's own children (runs of a study, compilers) are nobody's; as a subreaper this process gets them.
#include "host_tools/launch/orphans.hpp"

#include <sys/prctl.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace torolux::launch {
namespace {

std::vector<pid_t> own_children() {
  const std::string self = std::to_string(::getpid());
  std::ifstream file("/proc/" + self + "/task/" + self + "/children");
  return {std::istream_iterator<pid_t>(file), std::istream_iterator<pid_t>()};
}

}  // namespace

Orphans::Orphans() : before_(own_children()) {
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);
}

Orphans::~Orphans() {
  ::prctl(PR_SET_CHILD_SUBREAPER, 0);
}

void Orphans::end() const {
  for (;;) {
    std::vector<pid_t> children = own_children();  // each one's children are among the next
    std::erase_if(children, [&](pid_t child) { return std::ranges::find(before_, child) != before_.end(); });
    if (children.empty()) return;
    for (const pid_t child : children) ::kill(child, SIGKILL);
    for (const pid_t child : children) ::waitpid(child, nullptr, 0);
  }
}

}  // namespace torolux::launch
