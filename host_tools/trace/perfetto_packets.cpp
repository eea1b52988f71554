// SPDX-License-Identifier: MIT
// The numbers of fields are those of Perfetto's public .proto files (protos/perfetto/trace/ in its source: trace.proto,
// trace_packet.proto, track_event/*.proto, interned_data/interned_data.proto), which never change.
#include "host_tools/trace/perfetto_packets.hpp"

#include <utility>

namespace torolux {
namespace {

constexpr std::uint32_t kTracePacket = 1;  // Trace
namespace trace_packet {
constexpr std::uint32_t kTimestamp = 8, kSequence = 10, kTrackEvent = 11, kInternedData = 12, kSequenceFlags = 13,
                        kTrackDescriptor = 60;
constexpr std::uint64_t kStateCleared = 1, kNeedsState = 2;  // SequenceFlags
}  // namespace trace_packet
namespace track_descriptor {
constexpr std::uint32_t kUuid = 1, kName = 2, kParent = 5, kCounter = 8, kChildOrdering = 11, kRank = 12;
constexpr std::uint64_t kExplicit = 3;  // ChildTracksOrdering
}  // namespace track_descriptor
namespace counter_descriptor {
constexpr std::uint32_t kUnitName = 6;
}
namespace track_event {
constexpr std::uint32_t kAnnotations = 4, kType = 9, kName = 10, kTrack = 11, kCounterValue = 30, kDoubleValue = 44,
                        kFlow = 47, kTerminatingFlow = 48;
constexpr std::uint64_t kSliceBegin = 1, kSliceEnd = 2, kInstant = 3, kCounter = 4;  // Type
}  // namespace track_event
namespace debug_annotation {
constexpr std::uint32_t kString = 6, kName = 10;
}
namespace interned_data {
constexpr std::uint32_t kEventNames = 2;
constexpr std::uint32_t kNumber = 1, kName = 2;  // EventName
}  // namespace interned_data

constexpr std::uint64_t kOurSequence = 1;
constexpr std::size_t kMostWaiting = std::size_t{1} << 16U;

}  // namespace

PerfettoPackets::PerfettoPackets(Take take) : take_(std::move(take)) {}

/// The packet is whole.
void PerfettoPackets::add() {
  packet_.varint(trace_packet::kSequence, kOurSequence);
  packet_.varint(trace_packet::kSequenceFlags,
                 first_ ? trace_packet::kStateCleared | trace_packet::kNeedsState : trace_packet::kNeedsState);
  first_ = false;
  waiting_.message(kTracePacket, packet_);
  packet_.clear();
  if (waiting_.bytes().size() >= kMostWaiting) flush();
}

void PerfettoPackets::flush() {
  if (waiting_.bytes().empty()) return;
  take_(waiting_.bytes());
  taken_ += waiting_.bytes().size();
  waiting_.clear();
}

// ---- Tracks ----

void PerfettoPackets::describe(TrackId track, TrackId parent, std::string_view name, std::uint32_t rank,
                               const ProtoMessage* counter) {
  ProtoMessage descriptor;
  descriptor.varint(track_descriptor::kUuid, track).text(track_descriptor::kName, name);
  if (parent != 0) descriptor.varint(track_descriptor::kParent, parent);
  if (counter != nullptr) descriptor.message(track_descriptor::kCounter, *counter);
  descriptor.varint(track_descriptor::kChildOrdering, track_descriptor::kExplicit);
  descriptor.varint(track_descriptor::kRank, rank);
  packet_.message(trace_packet::kTrackDescriptor, descriptor);
  add();
}

void PerfettoPackets::make_track(TrackId track, TrackId parent, std::string_view name, std::uint32_t rank) {
  describe(track, parent, name, rank, nullptr);
}

void PerfettoPackets::make_counter(TrackId track, TrackId parent, std::string_view name, std::string_view unit,
                                   std::uint32_t rank) {
  ProtoMessage counter;
  counter.text(counter_descriptor::kUnitName, unit);
  describe(track, parent, name, rank, &counter);
}

// ---- Events ----

NameId PerfettoPackets::name(std::string_view text) {
  const auto known = names_.find(text);
  if (known != names_.end()) return known->second;
  const NameId number = names_.size() + 1;
  names_.emplace(text, number);
  ProtoMessage entry, data;
  entry.varint(interned_data::kNumber, number).text(interned_data::kName, text);
  data.message(interned_data::kEventNames, entry);
  packet_.message(trace_packet::kInternedData, data);
  add();
  return number;
}

/// The event, made whole, and its time.
void PerfettoPackets::event(std::uint64_t time) {
  packet_.varint(trace_packet::kTimestamp, time).message(trace_packet::kTrackEvent, event_);
  event_.clear();
  add();
}

void PerfettoPackets::annotate(std::span<const Annotation> annotations) {
  for (const Annotation& annotation : annotations) {
    inner_.clear();
    inner_.text(debug_annotation::kName, annotation.name).text(debug_annotation::kString, annotation.value);
    event_.message(track_event::kAnnotations, inner_);
  }
}

void PerfettoPackets::slice(TrackId track, std::uint64_t begin, std::uint64_t end, NameId name) {
  event_.varint(track_event::kType, track_event::kSliceBegin).varint(track_event::kTrack, track);
  event_.varint(track_event::kName, name);
  event(begin);
  event_.varint(track_event::kType, track_event::kSliceEnd).varint(track_event::kTrack, track);
  event(end);
}

/// Up to what an arrow's end has besides.
void PerfettoPackets::begin_instant(TrackId track, std::string_view text) {
  const NameId number = name(text);
  event_.varint(track_event::kType, track_event::kInstant).varint(track_event::kTrack, track);
  event_.varint(track_event::kName, number);
}

void PerfettoPackets::instant(TrackId track, std::uint64_t time, std::string_view text,
                              std::span<const Annotation> annotations) {
  begin_instant(track, text);
  annotate(annotations);
  event(time);
}

void PerfettoPackets::arrow(TrackId track, std::uint64_t time, std::string_view text, ArrowId arrow, ArrowEnd end,
                            std::span<const Annotation> annotations) {
  begin_instant(track, text);
  event_.fixed64(end == ArrowEnd::begins ? track_event::kFlow : track_event::kTerminatingFlow, arrow);
  annotate(annotations);
  event(time);
}

void PerfettoPackets::counter(TrackId track, std::uint64_t time, std::uint64_t value) {
  event_.varint(track_event::kType, track_event::kCounter).varint(track_event::kTrack, track);
  event_.varint(track_event::kCounterValue, value);
  event(time);
}

void PerfettoPackets::counter(TrackId track, std::uint64_t time, double value) {
  event_.varint(track_event::kType, track_event::kCounter).varint(track_event::kTrack, track);
  event_.real(track_event::kDoubleValue, value);
  event(time);
}

}  // namespace torolux
