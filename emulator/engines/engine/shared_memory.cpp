// SPDX-License-Identifier: MIT
// Anonymous shared memory from memfd_create: no name in any file system, so nothing can be left behind.
#include "emulator/engines/engine/shared_memory.hpp"

#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "emulator/errors.hpp"

namespace torolux {
namespace {

/// Of the common computers; elsewhere alignment to it does no harm.
constexpr std::size_t kLargePage = std::size_t{2} << 20U;

// A machine of a thousand PEs needs several descriptors for each; the usual soft limit is 1024.
void raise_descriptor_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) == 0 && limit.rlim_cur < limit.rlim_max) {
    limit.rlim_cur = limit.rlim_max;
    setrlimit(RLIMIT_NOFILE, &limit);
  }
}

int make_descriptor(const std::string& name) {
  int descriptor = memfd_create(name.c_str(), MFD_CLOEXEC);
  if (descriptor < 0 && errno == EMFILE) {
    raise_descriptor_limit();
    descriptor = memfd_create(name.c_str(), MFD_CLOEXEC);
  }
  return descriptor;
}

[[noreturn]] void fail(const std::string& name, std::size_t bytes) {
  throw MachineFailure("cannot make " + std::to_string(bytes) + " bytes of shared memory '" + name +
                       "': " + std::strerror(errno));
}

}  // namespace

SharedMemory::SharedMemory(const std::string& name, std::size_t bytes, Use use, std::size_t skew)
    : size_(bytes), skew_(use == Use::here ? skew : 0), mapping_(bytes + skew_) {
  if (use == Use::densely) mapping_ += kLargePage;
  int flags = MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE;
  if (use == Use::shared) {
    flags = MAP_SHARED;
    descriptor_ = make_descriptor(name);
    if (descriptor_ < 0) fail(name, bytes);
  }
  void* mapped = MAP_FAILED;
  if (use != Use::shared || ftruncate(descriptor_, static_cast<off_t>(bytes)) == 0) {
    mapped = mmap(nullptr, mapping_, PROT_READ | PROT_WRITE, flags, descriptor_, 0);
  }
  if (mapped == MAP_FAILED) {
    const int reason = errno;
    if (descriptor_ >= 0) close(descriptor_);
    errno = reason;
    fail(name, bytes);
  }
  if (use == Use::densely) {
    skew_ = (kLargePage - reinterpret_cast<std::uintptr_t>(mapped) % kLargePage) % kLargePage;
    // For speed alone: it does without.
    if (bytes >= kLargePage) madvise(static_cast<std::byte*>(mapped) + skew_, bytes, MADV_HUGEPAGE);
  }
  data_ = static_cast<std::byte*>(mapped) + skew_;
}

SharedMemory SharedMemory::part_of(const SharedMemory& whole, std::size_t offset, std::size_t bytes) {
  SharedMemory part;
  part.data_ = whole.bytes().subspan(offset, bytes).data();
  part.size_ = bytes;
  return part;
}

SharedMemory::SharedMemory(SharedMemory&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)),
      size_(std::exchange(other.size_, 0)),
      skew_(std::exchange(other.skew_, 0)),
      mapping_(std::exchange(other.mapping_, 0)),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

SharedMemory& SharedMemory::operator=(SharedMemory&& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  std::swap(skew_, other.skew_);
  std::swap(mapping_, other.mapping_);
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

SharedMemory::~SharedMemory() {
  if (mapping_ != 0) {
    munmap(data_ - skew_, mapping_);
  }
  if (descriptor_ >= 0) {
    close(descriptor_);
  }
}

}  // namespace torolux
