// SPDX-License-Identifier: MIT
// A struct on the heap with bytes behind it, owned. Enters: how many; leaves: a pointer, null where there is no memory.
#pragma once

#include <cstddef>
#include <memory>
#include <new>

namespace torolux::kit {

template <class T>
struct EndBlock {
  void operator()(T* block) const {
    block->~T();
    ::operator delete(block);
  }
};
template <class T>
using Block = std::unique_ptr<T, EndBlock<T>>;

/// All zeros, but for the bytes behind it.
template <class T>
Block<T> make_block(std::size_t bytes_behind) {
  static_assert(alignof(T) <= alignof(std::max_align_t));
  void* const memory = ::operator new(sizeof(T) + bytes_behind, std::nothrow);
  return Block<T>(memory != nullptr ? new (memory) T{} : nullptr);
}

/// The first byte behind it.
template <class T>
std::byte* behind(T& block) {
  return reinterpret_cast<std::byte*>(&block + 1);
}

}  // namespace torolux::kit
