// SPDX-License-Identifier: MIT
// posix_spawn, and a pipe for standard error that is read as it comes.
#include "host_tools/toolchain/compiler_process.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <system_error>

#include "emulator/errors.hpp"
#include "emulator/exec_pointers.hpp"

namespace torolux {
namespace {

/// Standard error into the pipe, signals as a program finds them that is started by hand.
class SpawnSettings {
 public:
  explicit SpawnSettings(int errors) {
    ::posix_spawn_file_actions_init(&actions_);
    ::posix_spawn_file_actions_adddup2(&actions_, errors, STDERR_FILENO);
    ::posix_spawnattr_init(&attributes_);
    sigset_t defaults;
    ::sigemptyset(&defaults);
    for (const int number : {SIGPIPE, SIGXFSZ}) ::sigaddset(&defaults, number);
    ::posix_spawnattr_setsigdefault(&attributes_, &defaults);
    ::posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGDEF);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;
  ~SpawnSettings() {
    ::posix_spawn_file_actions_destroy(&actions_);
    ::posix_spawnattr_destroy(&attributes_);
  }
  const posix_spawn_file_actions_t* actions() const { return &actions_; }
  const posix_spawnattr_t* attributes() const { return &attributes_; }

 private:
  posix_spawn_file_actions_t actions_{};
  posix_spawnattr_t attributes_{};
};

void write_all(int descriptor, const char* bytes, std::size_t count) {
  while (count > 0) {
    const ssize_t written = ::write(descriptor, bytes, count);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;  // nobody listens; the exit code still tells
    bytes += written;
    count -= static_cast<std::size_t>(written);
  }
}

/// Until all writers are gone.
std::string pass_on(int from) {
  std::string kept;
  std::array<char, 4096> part{};
  for (;;) {
    const ssize_t bytes = ::read(from, part.data(), part.size());
    if (bytes < 0 && errno == EINTR) continue;
    if (bytes <= 0) return kept;
    write_all(STDERR_FILENO, part.data(), static_cast<std::size_t>(bytes));
    kept.append(part.data(), static_cast<std::size_t>(bytes));
    if (kept.size() > kMostKeptErrors) kept.erase(0, kept.size() - kMostKeptErrors);
  }
}

}  // namespace

CompilerEnd run_compiler(const std::vector<std::string>& words, const std::string& package) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "a pipe");
  const std::vector<char*> pointers = exec_pointers(words);
  pid_t process = -1;
  const SpawnSettings settings(ends[1]);
  const int error =
      ::posix_spawnp(&process, pointers[0], settings.actions(), settings.attributes(), pointers.data(), environ);
  ::close(ends[1]);
  if (error != 0) {
    ::close(ends[0]);
    if (error != ENOENT) throw std::system_error(error, std::generic_category(), words[0] + " cannot be started");
    throw InputError(words[0] + ": there is no such program in PATH; it is in the Debian package " + package +
                     ": apt-get install " + package);
  }
  CompilerEnd end{0, pass_on(ends[0])};
  ::close(ends[0]);
  int status = 0;
  while (::waitpid(process, &status, 0) != process && errno == EINTR) continue;
  end.exit_code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  return end;
}

}  // namespace torolux
