// SPDX-License-Identifier: MIT
// Values of a machine that stands still to bytes, and back: one function `archive` of each class serves both ways, so
// that what is written and what is read cannot drift apart.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "emulator/errors.hpp"

namespace torolux {

/// Takes bytes, in order.
class SnapshotWriter {
 public:
  static constexpr bool kReads = false;

  /// put: is given all bytes, in pieces.
  explicit SnapshotWriter(std::function<void(std::span<const std::byte>)> put) : put_(std::move(put)) {
    buffer_.reserve(kBuffer);
  }
  void bytes(std::span<std::byte> values) { append(values); }
  void append(std::span<const std::byte> values) {
    if (buffer_.size() + values.size() > kBuffer) flush();
    if (values.size() >= kBuffer) return put_(values);
    buffer_.insert(buffer_.end(), values.begin(), values.end());
  }
  /// To be called at the end.
  void flush() {
    if (!buffer_.empty()) put_(buffer_);
    buffer_.clear();
  }
  template <class... Values>
  void operator()(Values&... values);
  /// Here begins what has this name: a reader that is somewhere else says so.
  void section(std::string_view name);

 private:
  static constexpr std::size_t kBuffer = 64U << 10U;
  std::function<void(std::span<const std::byte>)> put_;
  std::vector<std::byte> buffer_;
};

/// Gives them back. Throws InputError where there are not so many, or where something else stands.
class SnapshotReader {
 public:
  static constexpr bool kReads = true;

  /// get: fills the span whole, or throws InputError.
  explicit SnapshotReader(std::function<void(std::span<std::byte>)> get) : get_(std::move(get)) {}
  void bytes(std::span<std::byte> values) {
    if (!values.empty()) get_(values);
  }
  template <class... Values>
  void operator()(Values&... values);
  void section(std::string_view name);

 private:
  std::function<void(std::span<std::byte>)> get_;
};

[[noreturn]] inline void refuse_snapshot(const std::string& why) {
  throw InputError("the saved state is not whole: " + why);
}

namespace snapshot {

template <class Archive>
concept IsArchive = std::same_as<Archive, SnapshotWriter> || std::same_as<Archive, SnapshotReader>;
template <class Value, class Archive>
concept Archives = requires(Value& value, Archive& archive) {
  value.archive(archive);
};

template <class Value>
struct IsArray : std::false_type {};
template <class Value, std::size_t n>
struct IsArray<std::array<Value, n>> : std::true_type {};
template <class Value>
struct IsAtomic : std::false_type {};
template <class Value>
struct IsAtomic<std::atomic<Value>> : std::true_type {};

template <IsArchive Archive, class Value>
void value(Archive& archive, Value& v);

/// A count that is damaged takes no more memory than there are values.
inline constexpr std::size_t kAtATime = std::size_t{1} << 16U;

/// vector, deque or string.
template <class Archive, class Many>
void many(Archive& archive, Many& values) {
  std::uint64_t count = values.size();
  value(archive, count);
  using Element = typename Many::value_type;
  constexpr bool plain = std::is_trivially_copyable_v<Element> && !Archives<Element, Archive> && requires {
    values.data();
  };
  if constexpr (Archive::kReads) values.clear();
  while (Archive::kReads && values.size() < count) {
    const std::size_t from = values.size();
    values.resize(from + static_cast<std::size_t>(std::min<std::uint64_t>(kAtATime, count - from)));
    if constexpr (plain) {
      archive.bytes(std::as_writable_bytes(std::span(values.data() + from, values.size() - from)));
    } else {
      for (std::size_t i = from; i < values.size(); ++i) value(archive, values[i]);
    }
  }
  if constexpr (Archive::kReads) return;
  if constexpr (plain) {
    archive.bytes(std::as_writable_bytes(std::span(values.data(), values.size())));
  } else {
    for (auto& element : values) value(archive, element);
  }
}

template <class Archive>
void bits(Archive& archive, std::vector<bool>& values) {
  std::vector<std::uint8_t> plain(values.begin(), values.end());
  many(archive, plain);
  if constexpr (Archive::kReads) values.assign(plain.begin(), plain.end());
}

template <class Archive, class Value>
void maybe(Archive& archive, std::optional<Value>& v) {
  bool there = v.has_value();
  value(archive, there);
  if constexpr (Archive::kReads) {
    if (there)
      v.emplace();
    else
      v.reset();
  }
  if (v) value(archive, *v);
}

template <class Archive, class Value>
void atomic(Archive& archive, std::atomic<Value>& v) {
  Value plain = v.load();
  value(archive, plain);
  if constexpr (Archive::kReads) v.store(plain);
}

template <IsArchive Archive, class Value>
void value(Archive& archive, Value& v) {
  static_assert(!std::is_const_v<Value> && !std::is_pointer_v<Value>);
  if constexpr (Archives<Value, Archive>) {
    v.archive(archive);
  } else if constexpr (IsAtomic<Value>::value) {
    atomic(archive, v);
  } else if constexpr (std::same_as<Value, bool>) {
    std::uint8_t byte = 0;
    if constexpr (!Archive::kReads) byte = v ? 1 : 0;  // what is read into need not be set
    value(archive, byte);
    if (byte > 1) refuse_snapshot("a truth value of " + std::to_string(byte));
    v = byte != 0;
  } else if constexpr (std::same_as<Value, std::vector<bool>>) {
    bits(archive, v);
  } else if constexpr (std::is_trivially_copyable_v<Value>) {
    archive.bytes(std::as_writable_bytes(std::span(&v, 1)));
  } else if constexpr (IsArray<Value>::value) {
    for (auto& element : v) value(archive, element);
  } else if constexpr (requires { v.has_value(); }) {
    maybe(archive, v);
  } else {
    many(archive, v);
  }
}

constexpr std::uint64_t name_hash(std::string_view name) {
  std::uint64_t hash = 0xCBF2'9CE4'8422'2325U;
  for (const char c : name) hash = (hash ^ static_cast<std::uint8_t>(c)) * 0x100'0000'01B3U;
  return hash;
}

}  // namespace snapshot

template <class... Values>
void SnapshotWriter::operator()(Values&... values) {
  (snapshot::value(*this, values), ...);
}

template <class... Values>
void SnapshotReader::operator()(Values&... values) {
  (snapshot::value(*this, values), ...);
}

inline void SnapshotWriter::section(std::string_view name) {
  std::uint64_t hash = snapshot::name_hash(name);
  (*this)(hash);
}

inline void SnapshotReader::section(std::string_view name) {
  std::uint64_t hash = 0;
  (*this)(hash);
  if (hash != snapshot::name_hash(name)) refuse_snapshot("'" + std::string(name) + "' is not where it should be");
}

}  // namespace torolux
