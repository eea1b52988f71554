// SPDX-License-Identifier: MIT
// Bytes enter, a whole file leaves; or a path enters and its bytes leave.
#include "host_tools/files/write_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "emulator/errors.hpp"

namespace torolux {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& file, const char* what, int error) {
  throw InputError(file.string() + ": " + what + ": " + std::strerror(error));
}

/// An open file descriptor, closed at the end.
class Descriptor {
 public:
  explicit Descriptor(int descriptor) : descriptor_(descriptor) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  bool open() const { return descriptor_ >= 0; }
  int get() const { return descriptor_; }
  /// False, with errno set, where the last bytes could not be written.
  bool close() { return ::close(std::exchange(descriptor_, -1)) == 0; }
  /// As close does, which is when some file systems write them; but the file stays open, by another descriptor.
  bool close_and_keep() {
    const int other = ::fcntl(descriptor_, F_DUPFD_CLOEXEC, 0);
    return other >= 0 && ::close(std::exchange(descriptor_, other)) == 0;
  }

 private:
  int descriptor_;
};

/// A new file in the folder of the target. It has no name until it is whole, so that a process that is killed leaves
/// nothing; where the file system has no such files, or gives them no name, it has one, and is removed at the end
/// unless it has been renamed. That name does not contain the target's, which may be as long as names may be.
class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& target) : descriptor_(create(target, name_)) {
    if (!descriptor_.open()) refuse(target, "cannot be written", errno);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (!name_.empty()) ::unlink(name_.c_str());
  }

  Descriptor& descriptor() { return descriptor_; }
  /// Puts it in the target's place, whole. False, with errno set: that could not be done.
  bool become(const fs::path& target) {
    if (!name_.empty()) return descriptor_.close() && rename_to(target);
    if (!descriptor_.close_and_keep()) return false;
    if (give_name(descriptor_.get(), target)) return true;
    if (errno != EEXIST) return false;
    // No call puts a file without a name in another one's place; who is killed between the two that do, a few
    // microseconds, leaves the name of the first.
    const fs::path name = unused_name(target);
    if (!give_name(descriptor_.get(), name)) return false;
    name_ = name;
    return rename_to(target);
  }

 private:
  bool rename_to(const fs::path& target) {
    if (std::rename(name_.c_str(), target.c_str()) != 0) return false;
    name_.clear();
    return true;
  }
  static fs::path unused_name(const fs::path& target) {
    static std::atomic<unsigned> counter = 0;
    return target.parent_path() /
           (".torolux-" + std::to_string(::getpid()) + "-" + std::to_string(counter++) + ".part");
  }
  /// Of an open file, whether it has a name or not.
  static std::string path_of(int descriptor) { return "/proc/self/fd/" + std::to_string(descriptor); }
  static bool give_name(int descriptor, const fs::path& name) {
    return ::linkat(AT_FDCWD, path_of(descriptor).c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
  }
  static fs::path folder_of(const fs::path& target) { return target.has_parent_path() ? target.parent_path() : "."; }
  static int unnamed_file(const fs::path& target) {
    return ::open(folder_of(target).c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666);
  }
  /// Whether a file without a name gets one here: not without /proc, nor where links are refused. Tried with another
  /// one, since it goes once; in each folder once, since who is killed meanwhile leaves an empty file.
  static bool gives_names(const fs::path& target) {
    static std::mutex mutex;
    static std::map<fs::path, bool> known;  // by folder
    const std::lock_guard lock(mutex);
    const auto [entry, is_new] = known.try_emplace(folder_of(target), false);
    if (!is_new) return entry->second;
    const Descriptor tried(unnamed_file(target));
    const fs::path name = unused_name(target);
    entry->second = tried.open() && give_name(tried.get(), name);
    if (entry->second) ::unlink(name.c_str());
    return entry->second;
  }
  /// name: stays empty where it needs none.
  static int create(const fs::path& target, fs::path& name) {
    const int unnamed = unnamed_file(target);
    if (unnamed >= 0 && gives_names(target)) return unnamed;
    if (unnamed >= 0) ::close(unnamed);
    const fs::path unused = unused_name(target);
    const int named = ::open(unused.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (named >= 0) name = unused;
    return named;
  }

  fs::path name_;
  Descriptor descriptor_;
};

bool write_all(int descriptor, std::span<const std::byte> contents) {
  while (!contents.empty()) {
    const ssize_t written = ::write(descriptor, contents.data(), contents.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    contents = contents.subspan(static_cast<std::size_t>(written));
  }
  return true;
}

/// Where the bytes are to go: links followed, so that the link stays and what it names is replaced.
fs::path followed(const fs::path& file) {
  std::error_code error;
  const fs::path whole = fs::canonical(file, error);
  return error ? file : whole;
}

/// Of our standard output or standard error where `file` is the same: a shell's log, which others write, too.
std::optional<int> standard_stream(const fs::path& file) {
  struct stat wanted {};
  if (::stat(file.c_str(), &wanted) != 0) return std::nullopt;
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) {
    struct stat open {};
    if (::fstat(stream, &open) == 0 && open.st_dev == wanted.st_dev && open.st_ino == wanted.st_ino) return stream;
  }
  return std::nullopt;
}

void refuse_folder(const fs::path& file) {
  std::error_code error;
  if (file.filename().empty() || fs::is_directory(file, error))
    throw InputError(file.string() + ": is a folder; name a file in it");
}

}  // namespace

bool is_device(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

struct FileWriter::Parts {
  std::optional<Descriptor> device;  // or
  fs::path target;
  std::optional<TemporaryFile> temporary;
};

FileWriter::FileWriter(const fs::path& file) : file_(file), parts_(std::make_unique<Parts>()) {
  refuse_folder(file);
  const std::optional<int> stream = standard_stream(file);
  if (stream || is_device(file)) {
    parts_->device.emplace(stream ? ::fcntl(*stream, F_DUPFD_CLOEXEC, 0) : ::open(file.c_str(), O_WRONLY | O_CLOEXEC));
    if (!parts_->device->open()) refuse(file, "cannot be written", errno);
    return;
  }
  parts_->target = followed(file);
  parts_->temporary.emplace(parts_->target);
}

FileWriter::~FileWriter() = default;

void FileWriter::append(std::span<const std::byte> contents) {
  const Descriptor& open = parts_->device ? *parts_->device : parts_->temporary->descriptor();
  if (!write_all(open.get(), contents)) refuse(file_, "cannot be written", errno);
}

void FileWriter::write_at(std::uint64_t position, std::span<const std::byte> contents) {
  if (!parts_->device && ::lseek(parts_->temporary->descriptor().get(), static_cast<off_t>(position), SEEK_SET) < 0)
    refuse(file_, "cannot be written", errno);
  append(contents);
}

void FileWriter::empty() {
  if (parts_->device) return;
  const int open = parts_->temporary->descriptor().get();
  if (::ftruncate(open, 0) != 0 || ::lseek(open, 0, SEEK_SET) < 0) refuse(file_, "cannot be written", errno);
}

void FileWriter::finish() {
  if (parts_->device) return;
  if (!parts_->temporary->become(parts_->target)) refuse(file_, "cannot be written", errno);
}

void write_file(const fs::path& file, std::span<const std::byte> contents) {
  FileWriter writer(file);
  writer.append(contents);
  writer.finish();
}

void write_file(const fs::path& file, std::string_view text) {
  write_file(file, std::as_bytes(std::span(text)));
}

void check_file_writable(const fs::path& file) {
  refuse_folder(file);
  if (is_device(file)) {
    if (::access(file.c_str(), W_OK) != 0) refuse(file, "cannot be written", errno);
    return;
  }
  const TemporaryFile temporary(followed(file));
}

std::vector<std::byte> read_file(const fs::path& file, std::size_t most_bytes) {
  std::error_code error;
  if (fs::is_directory(file, error)) throw InputError(file.string() + ": is a folder, not a file");
  const Descriptor descriptor(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  if (!descriptor.open()) refuse(file, "cannot be read", errno);
  std::vector<std::byte> contents;
  std::vector<std::byte> piece(1U << 16U);
  for (;;) {
    const ssize_t count = ::read(descriptor.get(), piece.data(), piece.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) refuse(file, "cannot be read", errno);
    if (count == 0) return contents;
    contents.insert(contents.end(), piece.begin(), piece.begin() + count);
    if (contents.size() > most_bytes)
      throw InputError(file.string() + ": larger than " + std::to_string(most_bytes) + " bytes");
  }
}

}  // namespace torolux
