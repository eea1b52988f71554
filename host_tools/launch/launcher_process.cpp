// SPDX-License-Identifier: MIT
// fork and exec, since posix_spawn has no word for "told when its parent dies".
#include "host_tools/launch/launcher_process.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "emulator/errors.hpp"
#include "emulator/exec_pointers.hpp"

namespace torolux::launch {
namespace {

struct Program {
  char* const* words;
  char* const* environment;
  const sigset_t* mask;
  pid_t parent;
  int errors;  ///< a pipe: errno where it cannot be started
};

/// In the child, which has the memory of a process with other threads: system calls alone.
[[noreturn]] void become(const Program& program) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (::getppid() != program.parent) ::_exit(1);  // it died before that
  for (const int number : {SIGPIPE, SIGXFSZ}) ::signal(number, SIG_DFL);
  if (::isatty(STDIN_FILENO) == 1) {
    const int nothing = ::open("/dev/null", O_RDONLY);
    if (nothing >= 0) ::dup2(nothing, STDIN_FILENO);
  }
  ::sigprocmask(SIG_SETMASK, program.mask, nullptr);
  ::execvpe(program.words[0], program.words, program.environment);
  const int error = errno;
  [[maybe_unused]] const ssize_t written = ::write(program.errors, &error, sizeof(error));
  ::_exit(1);
}

}  // namespace

LauncherProcess::LauncherProcess(const std::vector<std::string>& words, const std::vector<std::string>& environment,
                                 const sigset_t& mask) {
  const std::vector<char*> word_pointers = exec_pointers(words);
  const std::vector<char*> environment_pointers = exec_pointers(environment);
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "a pipe");
  const pid_t parent = ::getpid();
  process_ = ::fork();
  if (process_ == 0) become({word_pointers.data(), environment_pointers.data(), &mask, parent, ends[1]});
  int error = process_ < 0 ? errno : 0;
  ::close(ends[1]);
  if (process_ > 0) {
    ::setpgid(process_, process_);  // whoever of the two comes first
    while (::read(ends[0], &error, sizeof(error)) < 0 && errno == EINTR) continue;
  }
  ::close(ends[0]);
  if (error == 0) return;
  if (process_ > 0) ::waitpid(process_, nullptr, 0);
  process_ = -1;
  throw InputError(words[0] + ": the launcher cannot be started: " + std::strerror(error) +
                   "; --launcher names another one");
}

LauncherProcess::~LauncherProcess() {
  if (process_ <= 0 || poll()) return;
  kill_group();
  ::waitpid(process_, nullptr, 0);
}

std::optional<int> LauncherProcess::poll() {
  int status = 0;
  if (status_) return status_;
  const pid_t ended = ::waitpid(process_, &status, WNOHANG);
  if (ended == process_) status_ = status;
  if (ended < 0 && errno == ECHILD) status_ = 1 << 8U;  // nobody knows how: as exit code 1
  return status_;
}

void LauncherProcess::signal(int number) const {
  if (!status_) ::kill(process_, number);
}

void LauncherProcess::kill_group() const {
  ::kill(-process_, SIGKILL);  // also where the launcher has ended: its helpers may be there yet
}

}  // namespace torolux::launch
