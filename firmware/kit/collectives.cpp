// SPDX-License-Identifier: MIT
// torolux.h: all PEs together. Enters: pointers, types and operations of C; leaves: what Together does with them.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>

#include "firmware/kit/include/torolux.h"
#include "firmware/kit/kit.hpp"
#include "firmware/kit/together.hpp"

namespace torolux::kit {
namespace {

/// kAlignment: of both, in bytes. GCC makes one load of a value only where it knows the value to be aligned; bytes
/// take five times as long.
template <std::size_t kAlignment, class Value, class Operation>
void join_aligned(std::span<std::byte> into, std::span<const std::byte> from) {
  for (std::size_t at = 0; at < into.size(); at += sizeof(Value)) {
    std::byte* const place = std::assume_aligned<kAlignment>(&into[at]);
    Value mine;
    Value theirs;
    std::memcpy(&mine, place, sizeof mine);
    std::memcpy(&theirs, std::assume_aligned<kAlignment>(&from[at]), sizeof theirs);
    mine = Operation()(mine, theirs);
    std::memcpy(place, &mine, sizeof mine);
  }
}

/// C promises that the program's values are aligned, but nobody has to keep that here: any place works.
template <class Value, class Operation>
void join_values(std::span<std::byte> into, std::span<const std::byte> from) {
  const auto places = reinterpret_cast<std::uintptr_t>(into.data()) | reinterpret_cast<std::uintptr_t>(from.data());
  if (places % alignof(Value) == 0) {
    join_aligned<alignof(Value), Value, Operation>(into, from);
  } else {
    join_aligned<1, Value, Operation>(into, from);
  }
}

struct Sum {
  template <class Value>
  Value operator()(Value a, Value b) const {
    return a + b;
  }
};
/// Of whole numbers: around, as unsigned ones do.
template <>
inline std::int32_t Sum::operator()(std::int32_t a, std::int32_t b) const {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}
template <>
inline std::int64_t Sum::operator()(std::int64_t a, std::int64_t b) const {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
}
struct Minimum {
  template <class Value>
  Value operator()(Value a, Value b) const {
    return b < a ? b : a;
  }
};
struct Maximum {
  template <class Value>
  Value operator()(Value a, Value b) const {
    return a < b ? b : a;
  }
};

struct Type {
  std::size_t bytes;
  std::array<Join, 3> join;  ///< by operation
};
template <class Value>
constexpr Type kType = {sizeof(Value),
                        {join_values<Value, Sum>, join_values<Value, Minimum>, join_values<Value, Maximum>}};
/// By torolux_type.
constexpr std::array<Type, 6> kTypes = {kType<std::int32_t>,  kType<std::uint32_t>, kType<std::int64_t>,
                                        kType<std::uint64_t>, kType<float>,         kType<double>};

struct Task {
  std::span<std::byte> data;
  Join join;
};

std::uint32_t bits(auto constant) {
  return static_cast<std::uint32_t>(constant);
}

Task checked(Messenger& messenger, void* data, std::size_t count, torolux_type type, torolux_operation operation) {
  const auto kind = static_cast<std::size_t>(type);
  const auto how = static_cast<std::size_t>(operation);
  if (kind >= kTypes.size()) {
    messenger.fail(Words() << "there is no type " << kind << "; there are TOROLUX_INT32 (0) to TOROLUX_DOUBLE (5)");
  }
  if (how >= kTypes[kind].join.size()) {
    messenger.fail(Words() << "there is no operation " << how << "; there are TOROLUX_SUM (0) to TOROLUX_MAXIMUM (2)");
  }
  if (count > kMostMessage / kTypes[kind].bytes) {
    messenger.fail(Words() << count << " values of " << kTypes[kind].bytes << " bytes; the most is " << kMostMessage
                           << " bytes in all");
  }
  return {{static_cast<std::byte*>(data), count * kTypes[kind].bytes}, kTypes[kind].join[how]};
}

}  // namespace
}  // namespace torolux::kit

using torolux::kit::bits;
using torolux::kit::Call;
using torolux::kit::messenger;
using torolux::kit::Messenger;
using torolux::kit::Together;

void torolux_barrier() {
  Together(messenger("torolux_barrier", TOROLUX_CALLER), Call::barrier()).barrier();
}

void torolux_broadcast(unsigned root, void* data, size_t bytes) {
  Together(messenger("torolux_broadcast", TOROLUX_CALLER), Call::broadcast(root))
      .broadcast(root, {static_cast<std::byte*>(data), bytes});
}

void torolux_reduce(unsigned root, void* data, size_t count, enum torolux_type type, enum torolux_operation operation) {
  Messenger& all = messenger("torolux_reduce", TOROLUX_CALLER);
  const auto task = torolux::kit::checked(all, data, count, type, operation);
  Together(all, Call::reduce(root, bits(type), bits(operation))).reduce(root, task.data, task.join);
}

void torolux_all_reduce(void* data, size_t count, enum torolux_type type, enum torolux_operation operation) {
  Messenger& all = messenger("torolux_all_reduce", TOROLUX_CALLER);
  const auto task = torolux::kit::checked(all, data, count, type, operation);
  Together(all, Call::all_reduce(bits(type), bits(operation))).all_reduce(task.data, task.join);
}
