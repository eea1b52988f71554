// SPDX-License-Identifier: MIT
// posix_spawn, with output into files in memory: nothing blocks, however much is written. The result comes through a
// pipe, since a child takes it for a device and does not replace it by a file; polls empty it.
#include "host_tools/study/child.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <system_error>
#include <thread>
#include <utility>

#include "emulator/exec_pointers.hpp"
#include "emulator/ranks/launched.hpp"

namespace torolux::study {
namespace {

int memory_file(const char* name) {
  const int descriptor = ::memfd_create(name, MFD_CLOEXEC);
  if (descriptor < 0) throw std::system_error(errno, std::generic_category(), "a child's output");
  return descriptor;
}

std::string contents_of(int descriptor) {
  struct stat status {};
  ::fstat(descriptor, &status);
  std::string text(static_cast<std::size_t>(status.st_size), '\0');
  const ssize_t bytes = ::pread(descriptor, text.data(), text.size(), 0);
  text.resize(bytes > 0 ? static_cast<std::size_t>(bytes) : 0);
  return text;
}

/// Signals as a program finds them that is started by hand.
class Attributes {
 public:
  Attributes() {
    ::posix_spawnattr_init(&attributes_);
    sigset_t none;
    ::sigemptyset(&none);
    ::posix_spawnattr_setsigmask(&attributes_, &none);
    sigset_t defaults;
    ::sigemptyset(&defaults);
    ::sigaddset(&defaults, SIGPIPE);
    ::posix_spawnattr_setsigdefault(&attributes_, &defaults);
    ::posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }
  Attributes(const Attributes&) = delete;
  Attributes& operator=(const Attributes&) = delete;
  ~Attributes() { ::posix_spawnattr_destroy(&attributes_); }
  const posix_spawnattr_t* get() const { return &attributes_; }

 private:
  posix_spawnattr_t attributes_{};
};

constexpr int kResultDescriptor = 3;  // kResultStream

/// Standard input, output and errors; result: -1: none.
class Files {
 public:
  Files(int input, int output, int errors, int result) {
    ::posix_spawn_file_actions_init(&actions_);
    ::posix_spawn_file_actions_adddup2(&actions_, input, STDIN_FILENO);
    ::posix_spawn_file_actions_adddup2(&actions_, output, STDOUT_FILENO);
    ::posix_spawn_file_actions_adddup2(&actions_, errors, STDERR_FILENO);
    if (result >= 0) ::posix_spawn_file_actions_adddup2(&actions_, result, kResultDescriptor);
  }
  Files(const Files&) = delete;
  Files& operator=(const Files&) = delete;
  ~Files() { ::posix_spawn_file_actions_destroy(&actions_); }
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

}  // namespace

Child::Child(const std::string& program, const std::vector<std::string>& arguments, const std::string& input,
             ResultStream stream)
    : output_(memory_file("output")), errors_(memory_file("errors")) {
  const int in = memory_file("input");
  const ssize_t written = ::write(in, input.data(), input.size());
  ::lseek(in, 0, SEEK_SET);
  std::array<int, 2> ends{-1, -1};
  if (stream == ResultStream::yes && ::pipe2(ends.data(), O_CLOEXEC) == 0) ::fcntl(ends[0], F_SETFL, O_NONBLOCK);
  result_ = ends[0];
  std::vector<std::string> words = {program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<std::string> environment = ranks::environment_of_no_rank();
  const Attributes attributes;
  const Files files(in, output_, errors_, ends[1]);
  int error = written == static_cast<ssize_t>(input.size()) ? 0 : EIO;
  if (error == 0)
    error = ::posix_spawnp(&process_, program.c_str(), files.get(), attributes.get(), exec_pointers(words).data(),
                           exec_pointers(environment).data());
  ::close(in);
  if (ends[1] >= 0) ::close(ends[1]);
  if (error != 0) {
    close_all();
    throw std::system_error(error, std::generic_category(), program + " cannot be started");
  }
}

Child::Child(Child&& other) noexcept
    : process_(std::exchange(other.process_, -1)),
      output_(std::exchange(other.output_, -1)),
      errors_(std::exchange(other.errors_, -1)),
      result_(std::exchange(other.result_, -1)),
      text_of_result_(std::move(other.text_of_result_)) {}

Child::~Child() {
  if (process_ > 0) {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  close_all();
}

void Child::close_all() const {
  for (const int descriptor : {output_, errors_, result_}) {
    if (descriptor >= 0) ::close(descriptor);
  }
}

void Child::read_result() {
  std::array<char, 1U << 16U> piece;
  for (;;) {
    const ssize_t bytes = result_ >= 0 ? ::read(result_, piece.data(), piece.size()) : 0;
    if (bytes <= 0) return;
    text_of_result_.append(piece.data(), static_cast<std::size_t>(bytes));
  }
}

Ended Child::ended(int status) {
  process_ = -1;
  const int code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  read_result();
  return {code, contents_of(output_), contents_of(errors_), std::move(text_of_result_)};
}

std::optional<Ended> Child::poll() {
  int status = 0;
  read_result();
  if (::waitpid(process_, &status, WNOHANG) != process_) return std::nullopt;
  return ended(status);
}

Ended Child::wait() {
  while (result_ >= 0) {
    if (std::optional<Ended> ended = poll()) return std::move(*ended);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  int status = 0;
  while (::waitpid(process_, &status, 0) != process_ && errno == EINTR) {
  }
  return ended(status);
}

void Child::signal(int number) const {
  if (process_ > 0) ::kill(process_, number);
}

}  // namespace torolux::study
