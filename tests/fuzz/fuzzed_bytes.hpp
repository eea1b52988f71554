// SPDX-License-Identifier: MIT
// A fuzzer's bytes enter, the values of which a message consists leave.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>

namespace torolux {

/// Takes bytes off the front, zeros where there are none left.
class FuzzedBytes {
 public:
  explicit FuzzedBytes(std::span<const std::byte> bytes) : left_(bytes) {}
  bool empty() const { return left_.empty(); }
  std::span<const std::byte> next(std::size_t count) {
    const auto taken = left_.first(std::min(count, left_.size()));
    left_ = left_.subspan(taken.size());
    return taken;
  }
  template <class T>
  T as() {
    T value{};
    const auto bytes = next(sizeof value);
    if (!bytes.empty()) std::memcpy(&value, bytes.data(), bytes.size());
    return value;
  }

 private:
  std::span<const std::byte> left_;
};

}  // namespace torolux
