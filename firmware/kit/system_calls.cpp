// SPDX-License-Identifier: MIT
// What newlib asks of the machine below it. Enters: file numbers, bytes, times as C has them; leaves: output and files
// of the host, errno.
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/times.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <optional>

#include "firmware/kit/host_files.hpp"
#include "firmware/kit/include/torolux.h"

namespace torolux::kit {
namespace {

using protocol::FileAccess;
using protocol::FileError;

/// Files of the host follow the three that are always there.
constexpr int kFirstFile = 3;
/// The PE's clock at its nominal frequency, whatever the machine file says of it [cycles in a microsecond].
constexpr std::uint64_t kCyclesPerMicrosecond = 100;

struct Standard {
  bool opened = false;
  std::uint32_t file = 0;
  bool there = false;
};
constinit Standard input;

int failed(int error) {
  errno = error;
  return -1;
}

int errno_of(FileError error) {
  switch (error) {
    case FileError::no_such_file:
      return ENOENT;
    case FileError::not_allowed:
      return EACCES;
    case FileError::too_many:
      return EMFILE;
    default:
      return EINVAL;
  }
}

/// How each file was opened; 0: it is not open. Files number `kFirstFile` and on.
constinit std::array<std::uint32_t, protocol::kMostOpenFiles> access_to{};

std::uint32_t file_of(int number) {
  return static_cast<std::uint32_t>(number - kFirstFile);
}
bool is_file(int number) {
  return number >= kFirstFile && file_of(number) < access_to.size() && access_to[file_of(number)] != 0;
}
bool is_file_for(int number, FileAccess use) {
  return is_file(number) && (access_to[file_of(number)] & static_cast<std::uint32_t>(use)) != 0;
}

/// The user's file `stdin`, opened when something is first read of it.
std::optional<std::uint32_t> standard_input() {
  if (!input.opened) {
    const auto answer = open_file("stdin", static_cast<std::uint32_t>(FileAccess::read));
    input = {true, answer.file, answer.error == FileError::none};
  }
  return input.there ? std::optional(input.file) : std::nullopt;
}

std::uint32_t access_of(int flags) {
  const int mode = flags & O_ACCMODE;
  std::uint32_t access = 0;
  const auto add = [&](FileAccess bit, bool wanted) { access |= wanted ? static_cast<std::uint32_t>(bit) : 0; };
  add(FileAccess::read, mode != O_WRONLY);
  add(FileAccess::write, mode != O_RDONLY);
  add(FileAccess::append, (flags & O_APPEND) != 0);
  add(FileAccess::empty, (flags & O_TRUNC) != 0);
  return access;
}

std::uint64_t microseconds() {
  return torolux_clock() / kCyclesPerMicrosecond;
}

}  // namespace
}  // namespace torolux::kit

using namespace torolux::kit;
namespace protocol = torolux::protocol;

extern "C" {

int _open(const char* name, int flags, int /*mode*/) {
  const std::uint32_t access = access_of(flags);
  const auto answer = open_file(name, access);
  if (answer.error != FileError::none) return failed(errno_of(answer.error));
  access_to[answer.file] = access;
  return static_cast<int>(answer.file) + kFirstFile;
}

int _close(int number) {
  if (number >= 0 && number < kFirstFile) return 0;
  if (!is_file(number)) return failed(EBADF);
  close_file(file_of(number));
  access_to[file_of(number)] = 0;
  return 0;
}

int _read(int number, void* data, std::size_t bytes) {
  const auto file = number == STDIN_FILENO                  ? standard_input()
                    : is_file_for(number, FileAccess::read) ? std::optional(file_of(number))
                                                            : std::nullopt;
  if (!file) return number == STDIN_FILENO ? 0 : failed(EBADF);
  return static_cast<int>(read_file(*file, {static_cast<std::byte*>(data), bytes}));
}

int _write(int number, const void* data, std::size_t bytes) {
  const std::span contents(static_cast<const std::byte*>(data), bytes);
  if (number == STDOUT_FILENO) {
    write_output(protocol::OutputStream::standard_output, contents);
  } else if (number == STDERR_FILENO) {
    write_output(protocol::OutputStream::standard_error, contents);
  } else if (is_file_for(number, FileAccess::write)) {
    write_file(file_of(number), contents);
  } else {
    return failed(EBADF);
  }
  return static_cast<int>(bytes);
}

off_t _lseek(int number, off_t offset, int origin) {
  if (!is_file(number)) return failed(number < kFirstFile ? ESPIPE : EBADF);
  if (origin < SEEK_SET || origin > SEEK_END) return failed(EINVAL);
  const auto answer = seek_file(file_of(number), static_cast<protocol::FileOrigin>(origin), offset);
  if (answer.error != FileError::none) return failed(errno_of(answer.error));
  return static_cast<off_t>(answer.position);
}

int _isatty(int number) {
  if (number == STDOUT_FILENO || number == STDERR_FILENO) return 1;  // lines leave when they end
  return failed(ENOTTY);
}

int _fstat(int number, struct stat* state) {
  std::memset(state, 0, sizeof *state);
  if (number >= 0 && number < kFirstFile) {
    state->st_mode = S_IFCHR;
    return 0;
  }
  if (!is_file(number)) return failed(EBADF);
  state->st_mode = S_IFREG;
  state->st_blksize = static_cast<decltype(state->st_blksize)>(protocol::kMostWriteBytes);
  return 0;
}

int _gettimeofday(struct timeval* time, void* /*zone*/) {
  const std::uint64_t now = microseconds();
  if (time != nullptr) {
    time->tv_sec = static_cast<time_t>(now / 1'000'000);
    time->tv_usec = static_cast<suseconds_t>(now % 1'000'000);
  }
  return 0;
}

clock_t _times(struct tms* times) {
  const auto ticks = static_cast<clock_t>(microseconds() * CLOCKS_PER_SEC / 1'000'000);
  if (times != nullptr) *times = {ticks, 0, 0, 0};
  return ticks;
}

// What there is not.
int _unlink(const char* /*name*/) {
  return failed(EACCES);
}
int _link(const char* /*from*/, const char* /*to*/) {
  return failed(EACCES);
}
int _stat(const char* /*name*/, struct stat* /*state*/) {
  return failed(ENOENT);
}
int _mkdir(const char* /*name*/, int /*mode*/) {
  return failed(EACCES);
}
int _fork() {
  return failed(ENOSYS);
}
int _wait(int* /*status*/) {
  return failed(ECHILD);
}
int _execve(const char* /*name*/, char* const* /*arguments*/, char* const* /*environment*/) {
  return failed(ENOSYS);
}
int _fcntl(int /*number*/, int /*what*/, int /*value*/) {
  return failed(ENOSYS);
}

}  // extern "C"
