// SPDX-License-Identifier: MIT
// Tracks, slices, instants, counters and arrows enter; TracePackets of Perfetto leave, one behind the other. All
// packets together are a trace.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "host_tools/trace/protobuf.hpp"

namespace torolux {

/// Names a track; any number but 0.
using TrackId = std::uint64_t;
/// Names an arrow; any number but 0.
using ArrowId = std::uint64_t;
/// A name that events have.
using NameId = std::uint64_t;
enum class ArrowEnd : std::uint8_t { begins, ends };

/// A name and a value, shown when an event is clicked on.
struct Annotation {
  std::string_view name;
  std::string value;  ///< shown as text
};

/// Times are in ns, and on each track do not fall. A track is made before anything else is on it.
class PerfettoPackets {
 public:
  using Take = std::function<void(std::string_view)>;
  /// take: gets bytes as they come, some ten thousand at a time.
  explicit PerfettoPackets(Take take);

  // parent: 0: none; the viewer sorts those by name. rank: order among those of one parent.
  void make_track(TrackId track, TrackId parent, std::string_view name, std::uint32_t rank);
  /// unit: shown behind the values.
  void make_counter(TrackId track, TrackId parent, std::string_view name, std::string_view unit, std::uint32_t rank);

  /// Stands in the trace once; events have its number, which is not 0.
  NameId name(std::string_view text);
  void slice(TrackId track, std::uint64_t begin, std::uint64_t end, NameId name);
  void instant(TrackId track, std::uint64_t time, std::string_view name, std::span<const Annotation> annotations);
  void arrow(TrackId track, std::uint64_t time, std::string_view name, ArrowId arrow, ArrowEnd end,
             std::span<const Annotation> annotations);
  void counter(TrackId track, std::uint64_t time, std::uint64_t value);
  void counter(TrackId track, std::uint64_t time, double value);

  /// So far.
  std::uint64_t bytes() const { return taken_ + waiting_.bytes().size(); }
  /// Gives what waits to `take`.
  void flush();

 private:
  void describe(TrackId track, TrackId parent, std::string_view name, std::uint32_t rank, const ProtoMessage* counter);
  void begin_instant(TrackId track, std::string_view text);
  void event(std::uint64_t time);
  void add();
  void annotate(std::span<const Annotation> annotations);

  Take take_;
  std::map<std::string, NameId, std::less<>> names_;
  ProtoMessage waiting_;  // of the trace, which is a message, too
  std::uint64_t taken_ = 0;
  bool first_ = true;
  ProtoMessage packet_, event_, inner_;  // of the packet being made
};

}  // namespace torolux
