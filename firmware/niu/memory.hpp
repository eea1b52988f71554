// SPDX-License-Identifier: MIT
// Local memory as firmware sees it: 32-bit addresses of the protocol in, pointers and spans out.
#pragma once

#include <cstdint>
#include <span>

#include "firmware/protocol/stores.hpp"
#include "platform/local_base.hpp"

namespace torolux::pe {

/// A PE's local memory. On the PE addresses are pointers; natively they are offsets into an array that stands for it.
/// Nothing is checked here: who takes an address from a message or a layout checks it first.
class Memory {
 public:
  Memory() = default;  ///< the PE's own; natively an empty one, to be assigned to
  /// base: what an address means here; made by start-up code, or by a test.
  explicit Memory(LocalBase base) : base_(base) {}

  /// The object at `address`, which is in local memory and aligned for T.
  template <class T>
  T* at(std::uint32_t address) const {
    return static_cast<T*>(base_.pointer(address));
  }
  /// The `store.count` objects of a store.
  template <class T>
  std::span<T> store(const protocol::Store& store) const {
    return {at<T>(store.address), store.count};
  }
  /// Address of something that lies in local memory.
  std::uint32_t address_of(const void* pointer) const { return base_.address(pointer); }

  /// First address that the image leaves to the stores (linker symbol `__stores_begin`).
  std::uint32_t stores_begin() const { return base_.stores_begin(); }

 private:
  LocalBase base_;
};

}  // namespace torolux::pe
