// SPDX-License-Identifier: MIT
// O_EXCL makes a lock; who holds it stands in it; its age tells whether a holder elsewhere lives.
#include "host_tools/study/claim.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>
#include <utility>

#include "emulator/errors.hpp"
#include "host_tools/files/write_file.hpp"

namespace torolux::study {
namespace {

namespace fs = std::filesystem;

/// A lock without a holder's name is being written, or its maker died in between.
constexpr std::chrono::seconds kNameless{5};

std::string text_of_file(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// Where numbers of processes mean the same: this boot of this computer, this namespace.
std::string here() {
  std::error_code error;
  std::string boot = text_of_file("/proc/sys/kernel/random/boot_id");
  while (!boot.empty() && boot.back() == '\n') boot.pop_back();
  return boot + "/" + fs::read_symlink("/proc/self/ns/pid", error).string();
}

/// When a process began, in ticks since boot, so that its number is not taken for that of a later one; 0: not there,
/// or ended and not yet reaped.
std::uint64_t beginning_of(pid_t process) {
  const std::string text = text_of_file("/proc/" + std::to_string(process) + "/stat");
  const std::size_t name_end = text.rfind(')');
  if (name_end == std::string::npos) return 0;
  std::istringstream fields(text.substr(name_end + 1));
  std::string state, skipped;
  fields >> state;
  if (state == "Z" || state == "X") return 0;
  for (int field = 4; field < 22; ++field) fields >> skipped;  // proc(5): starttime is the 22nd
  std::uint64_t beginning = 0;
  fields >> beginning;
  return beginning;
}

std::string holder_text(pid_t child) {
  const pid_t self = ::getpid();
  std::string text = here() + " " + std::to_string(self) + " " + std::to_string(beginning_of(self));
  if (child > 0) text += " " + std::to_string(child) + " " + std::to_string(beginning_of(child));
  return text + "\n";
}

/// Since the file was touched, by the clock of the file's own computer: that of the folder may be another one.
std::chrono::seconds age_of(const fs::path& file) {
  const fs::path probe = file.parent_path() / (".probe-" + std::to_string(::getpid()));
  struct stat now {};
  struct stat then {};
  const int descriptor = ::open(probe.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  const bool known = descriptor >= 0 && ::write(descriptor, ".", 1) == 1 && ::fstat(descriptor, &now) == 0;
  if (descriptor >= 0) ::close(descriptor);
  ::unlink(probe.c_str());
  if (!known || ::stat(file.c_str(), &then) != 0) return std::chrono::seconds(0);
  return std::chrono::seconds(now.st_mtim.tv_sec - then.st_mtim.tv_sec);
}

bool holder_lives(const fs::path& lock, const std::string& text) {
  std::istringstream words(text);
  std::string where;
  if (!(words >> where)) return age_of(lock) < kNameless;
  if (where != here()) return age_of(lock) < kBelieved;
  pid_t process = 0;
  std::uint64_t beginning = 0;
  while (words >> process >> beginning) {
    if (beginning != 0 && beginning_of(process) == beginning) return true;
  }
  return false;
}

bool make(const fs::path& lock) {
  const int descriptor = ::open(lock.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor < 0) {
    if (errno == EEXIST) return false;
    throw InputError(lock.string() + ": cannot be made: " + std::strerror(errno));
  }
  const std::string text = holder_text(0);
  const ssize_t written = ::write(descriptor, text.data(), text.size());
  ::close(descriptor);
  if (written != static_cast<ssize_t>(text.size())) throw InputError(lock.string() + ": cannot be written");
  return true;
}

/// Moves the lock of a dead holder away. Should it be another's by now, it is put back.
void remove_stale(const fs::path& lock, const std::string& text) {
  const fs::path away = lock.parent_path() / (".stale-" + std::to_string(::getpid()));
  if (std::rename(lock.c_str(), away.c_str()) != 0) return;
  if (text_of_file(away) != text) static_cast<void>(::link(away.c_str(), lock.c_str()));
  ::unlink(away.c_str());
}

}  // namespace

std::optional<Claim> Claim::take(const fs::path& lock) {
  for (int attempt = 0; attempt < 2; ++attempt) {
    if (make(lock)) return Claim(lock);
    const std::string text = text_of_file(lock);
    if (holder_lives(lock, text)) return std::nullopt;
    remove_stale(lock, text);
  }
  return std::nullopt;
}

Claim::Claim(Claim&& other) noexcept : lock_(std::exchange(other.lock_, fs::path())) {}

Claim::~Claim() {
  if (!lock_.empty()) ::unlink(lock_.c_str());
}

void Claim::note_child(pid_t child) const {
  write_file(lock_, holder_text(child));
}

void Claim::show_life() const {
  ::utimensat(AT_FDCWD, lock_.c_str(), nullptr, 0);
}

}  // namespace torolux::study
