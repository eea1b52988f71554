// SPDX-License-Identifier: MIT
// Anonymous memory that processes can share by file descriptor; gone when the last of them ends, however it ends. Where
// no other process wants it, it needs no descriptor.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace torolux {

class SharedMemory {
 public:
  enum class Use : std::uint8_t {
    shared,
    here,    ///< by this process alone: there may be any number of them
    densely  ///< the same, and all of it: in large pages, where the computer has them
  };

  SharedMemory() = default;
  /// Zeroed. name: for /proc only. skew: of `here`, where in its first page it begins. Throws MachineFailure.
  SharedMemory(const std::string& name, std::size_t bytes, Use use = Use::shared, std::size_t skew = 0);
  /// A part of what another one holds, which must outlive this.
  static SharedMemory part_of(const SharedMemory& whole, std::size_t offset, std::size_t bytes);
  SharedMemory(SharedMemory&& other) noexcept;
  SharedMemory& operator=(SharedMemory&& other) noexcept;
  ~SharedMemory();

  std::span<std::byte> bytes() const { return {data_, size_}; }
  int descriptor() const { return descriptor_; }  ///< close-on-exec; -1: not Use::shared

 private:
  std::byte* data_ = nullptr;
  std::size_t size_ = 0;
  std::size_t skew_ = 0;     // of data_ from the mapping's start
  std::size_t mapping_ = 0;  // its bytes; 0: another's
  int descriptor_ = -1;
};

}  // namespace torolux
