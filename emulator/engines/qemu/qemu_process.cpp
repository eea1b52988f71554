// SPDX-License-Identifier: MIT
// fork, exec and reaping of one QEMU.
#include "emulator/engines/qemu/qemu_process.hpp"

#include <fcntl.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <utility>

#include "emulator/errors.hpp"
#include "emulator/exec_pointers.hpp"

namespace torolux {
namespace {

/// In the child, between fork and exec: only async-signal-safe calls.
[[noreturn]] void become(char* const* arguments, std::span<const int> inherited, const cpu_set_t* cores, int log,
                         pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) {
    _exit(1);  // it died before the line above
  }
  setpgid(0, 0);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  const int nothing = open("/dev/null", O_RDONLY);
  dup2(nothing, STDIN_FILENO);
  dup2(log, STDOUT_FILENO);
  dup2(log, STDERR_FILENO);
  for (const int descriptor : inherited) {
    fcntl(descriptor, F_SETFD, 0);
  }
  if (cores != nullptr) {
    sched_setaffinity(0, sizeof(*cores), cores);
  }
  // Woken PEs wait for their turn instead of driving others from their core: their caches stay warm.
  const sched_param batch{};
  sched_setscheduler(0, SCHED_BATCH, &batch);
  execvp(arguments[0], arguments);
  const char* reason = errno == ENOENT ? "not found on PATH: install qemu-system-misc" : "cannot be executed";
  for (const char* part : {static_cast<const char*>(arguments[0]), " ", reason}) {
    (void)!write(STDERR_FILENO, part, std::strlen(part));
  }
  _exit(127);
}

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

QemuProcess::QemuProcess(const std::vector<std::string>& arguments, std::span<const int> inherited,
                         std::span<const int> cores) {
  const std::vector<char*> pointers = exec_pointers(arguments);
  cpu_set_t set;
  CPU_ZERO(&set);
  for (const int core : cores) {
    CPU_SET(static_cast<std::size_t>(core), &set);
  }
  log_ = memfd_create("torolux-qemu-log", MFD_CLOEXEC);
  const pid_t parent = getpid();
  process_ = log_ < 0 ? -1 : fork();
  if (process_ == 0) {
    become(pointers.data(), inherited, cores.empty() ? nullptr : &set, log_, parent);
  }
  if (process_ < 0) {
    const int reason = errno;
    if (log_ >= 0) {
      close(log_);
    }
    throw MachineFailure("cannot start " + arguments.front() + ": " + std::strerror(reason));
  }
}

QemuProcess::QemuProcess(QemuProcess&& other) noexcept
    : process_(std::exchange(other.process_, -1)),
      log_(std::exchange(other.log_, -1)),
      status_(other.status_),
      stopped_(other.stopped_),
      final_cpu_seconds_(other.final_cpu_seconds_) {}

QemuProcess::~QemuProcess() {
  kill();
  if (log_ >= 0) {
    close(log_);
  }
}

void QemuProcess::reap(int options) {
  if (process_ < 0) {
    return;
  }
  int status = 0;
  rusage usage{};
  pid_t reaped = 0;
  do {
    reaped = wait4(process_, &status, options, &usage);
  } while (reaped < 0 && errno == EINTR);
  if (reaped == 0) {
    return;
  }
  status_ = status;
  stopped_ = reaped > 0 && WIFSTOPPED(status);
  if (!stopped_) {
    process_ = -1;
    final_cpu_seconds_ = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  }
}

std::optional<std::string> QemuProcess::ended() {
  reap(WNOHANG | WUNTRACED);
  const auto signal_name = [](int number) {
    return "signal " + std::to_string(number) + " (" + strsignal(number) + ")";
  };
  if (stopped_) {
    return "stopped by " + signal_name(WSTOPSIG(status_));
  }
  if (process_ >= 0) {
    return std::nullopt;
  }
  return WIFSIGNALED(status_) ? "killed by " + signal_name(WTERMSIG(status_))
                              : "ended by itself with status " + std::to_string(WEXITSTATUS(status_));
}

void QemuProcess::kill() {
  if (process_ >= 0) {
    ::kill(process_, SIGKILL);
    reap(0);
  }
}

double QemuProcess::cpu_seconds() const {
  clockid_t clock = 0;
  timespec time{};
  if (process_ >= 0 && clock_getcpuclockid(process_, &clock) == 0 && clock_gettime(clock, &time) == 0) {
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }
  return final_cpu_seconds_;
}

std::string QemuProcess::log_tail() const {
  constexpr off_t kMost = 2000;
  struct stat status {};
  if (log_ < 0 || fstat(log_, &status) != 0) {
    return {};
  }
  std::string tail(static_cast<std::size_t>(std::min<off_t>(status.st_size, kMost)), '\0');
  const ssize_t read = pread(log_, tail.data(), tail.size(), status.st_size - static_cast<off_t>(tail.size()));
  tail.resize(read > 0 ? static_cast<std::size_t>(read) : 0);
  while (!tail.empty() && (tail.back() == '\n' || tail.back() == ' ')) {
    tail.pop_back();
  }
  return tail;
}

}  // namespace torolux
