// SPDX-License-Identifier: MIT
// The other process shares all memory and is waited for: a vfork whose end is not told by SIGCHLD, whatever the program
// does with that.
#include "host_tools/files/put_in_place.hpp"

#include <fcntl.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdio>

namespace torolux {
namespace {

struct Calls {
  const char* path;
  const char* name;
  const char* target;
  PutInPlace result;
  int error;
  bool made;
};

/// In memory that is ours: nothing but these calls.
int make_calls(void* argument) {
  Calls& calls = *static_cast<Calls*>(argument);
  const bool named = ::linkat(AT_FDCWD, calls.path, AT_FDCWD, calls.name, AT_SYMLINK_FOLLOW) == 0;
  const bool done = named && std::rename(calls.name, calls.target) == 0;
  calls.error = done ? 0 : errno;
  calls.result = {done, named && !done};
  calls.made = true;
  return 0;
}

/// False: there can be no such process, or it does not share our memory.
bool make_calls_elsewhere(Calls& calls) {
  alignas(16) std::array<std::byte, 1U << 16U> stack;
  // A handler must not run twice, in memory that two processes share.
  sigset_t all;
  sigset_t before;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  const int process = ::clone(make_calls, stack.data() + stack.size(), CLONE_VM | CLONE_VFORK, &calls);
  while (process >= 0 && ::waitpid(process, nullptr, __WCLONE) < 0 && errno == EINTR) {
  }
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return process >= 0 && calls.made;
}

}  // namespace

PutInPlace put_in_place(const std::filesystem::path& path, const std::filesystem::path& name,
                        const std::filesystem::path& target) {
  Calls calls{path.c_str(), name.c_str(), target.c_str(), {}, EINTR, false};
  if (!make_calls_elsewhere(calls)) make_calls(&calls);
  errno = calls.error;
  return calls.result;
}

}  // namespace torolux
