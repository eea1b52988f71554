// SPDX-License-Identifier: MIT
// posix_spawn, with output into files in memory: nothing blocks, however much is written.
#include "host_tools/study/child.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <system_error>
#include <utility>

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

/// Standard input, output and errors.
class Files {
 public:
  Files(int input, int output, int errors) {
    ::posix_spawn_file_actions_init(&actions_);
    ::posix_spawn_file_actions_adddup2(&actions_, input, STDIN_FILENO);
    ::posix_spawn_file_actions_adddup2(&actions_, output, STDOUT_FILENO);
    ::posix_spawn_file_actions_adddup2(&actions_, errors, STDERR_FILENO);
  }
  Files(const Files&) = delete;
  Files& operator=(const Files&) = delete;
  ~Files() { ::posix_spawn_file_actions_destroy(&actions_); }
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

}  // namespace

Child::Child(const std::string& program, const std::vector<std::string>& arguments, const std::string& input)
    : output_(memory_file("output")), errors_(memory_file("errors")) {
  const int in = memory_file("input");
  const ssize_t written = ::write(in, input.data(), input.size());
  ::lseek(in, 0, SEEK_SET);
  std::vector<std::string> words = {program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const Attributes attributes;
  const Files files(in, output_, errors_);
  int error = written == static_cast<ssize_t>(input.size()) ? 0 : EIO;
  if (error == 0)
    error = ::posix_spawnp(&process_, program.c_str(), files.get(), attributes.get(), pointers.data(), environ);
  ::close(in);
  if (error != 0) {
    ::close(output_);
    ::close(errors_);
    throw std::system_error(error, std::generic_category(), program + " cannot be started");
  }
}

Child::Child(Child&& other) noexcept
    : process_(std::exchange(other.process_, -1)),
      output_(std::exchange(other.output_, -1)),
      errors_(std::exchange(other.errors_, -1)) {}

Child::~Child() {
  if (process_ > 0) {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  for (const int descriptor : {output_, errors_}) {
    if (descriptor >= 0) ::close(descriptor);
  }
}

Ended Child::ended(int status) {
  process_ = -1;
  const int code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  return {code, contents_of(output_), contents_of(errors_)};
}

std::optional<Ended> Child::poll() {
  int status = 0;
  if (::waitpid(process_, &status, WNOHANG) != process_) return std::nullopt;
  return ended(status);
}

Ended Child::wait() {
  int status = 0;
  while (::waitpid(process_, &status, 0) != process_ && errno == EINTR) {
  }
  return ended(status);
}

void Child::signal(int number) const {
  if (process_ > 0) ::kill(process_, number);
}

}  // namespace torolux::study
