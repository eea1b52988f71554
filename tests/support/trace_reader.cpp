// SPDX-License-Identifier: MIT
// Bytes of a trace enter, read by the format's public description alone; tracks, slices, counters and arrows leave.
#include "tests/support/trace_reader.hpp"

#include <bit>
#include <optional>
#include <set>

namespace torolux::testing_support {
namespace {

struct Field {
  std::uint64_t number = 0, value = 0;
  std::string_view bytes;
};

std::optional<std::uint64_t> take_varint(std::string_view& from) {
  std::uint64_t value = 0;
  for (unsigned shift = 0; shift < 64 && !from.empty(); shift += 7) {
    const auto byte = static_cast<unsigned char>(from.front());
    from.remove_prefix(1);
    value |= std::uint64_t{byte & 0x7FU} << shift;
    if (byte < 0x80) return value;
  }
  return std::nullopt;
}

/// All fields of a message, or those before what is none.
std::vector<Field> fields_of(std::string_view message, bool& good) {
  std::vector<Field> fields;
  while (!message.empty()) {
    const auto key = take_varint(message);
    if (!key) return good = false, fields;
    Field field;
    field.number = *key >> 3U;
    const auto wire = *key & 7U;
    if (wire == 0 || wire == 2) {
      const auto value = take_varint(message);
      if (!value || (wire == 2 && *value > message.size())) return good = false, fields;
      field.value = *value;
      if (wire == 2) {
        field.bytes = message.substr(0, *value);
        message.remove_prefix(*value);
      }
    } else if (wire == 1 && message.size() >= 8) {
      for (unsigned i = 0; i < 8; ++i) field.value |= std::uint64_t{static_cast<unsigned char>(message[i])} << (8 * i);
      message.remove_prefix(8);
    } else {
      return good = false, fields;
    }
    fields.push_back(field);
  }
  return fields;
}

class Reader {
 public:
  explicit Reader(std::string_view bytes) {
    for (const Field& field : fields(bytes)) {
      if (field.number != 1) complain("a field of the trace that is no packet");
      packet(field.bytes);
    }
    for (const auto& [track, open] : open_) {
      if (open) complain("a slice without an end on track " + trace_.tracks[track].name);
    }
    if (!arrows_.empty()) complain(std::to_string(arrows_.size()) + " arrows without an end");
  }
  ReadTrace take() { return std::move(trace_); }

 private:
  void complain(const std::string& what) { trace_.wrong.push_back(what); }
  std::vector<Field> fields(std::string_view bytes) {
    bool good = true;
    std::vector<Field> result = fields_of(bytes, good);
    if (!good) complain("bytes that are no message");
    return result;
  }

  void packet(std::string_view bytes) {
    std::uint64_t time = 0;
    bool first = false;
    std::string_view event, track, names;
    for (const Field& field : fields(bytes)) {
      if (field.number == 8) time = field.value;
      if (field.number == 10 && field.value != 1) complain("another sequence");
      if (field.number == 11) event = field.bytes;
      if (field.number == 12) names = field.bytes;
      if (field.number == 13) first = (field.value & 1U) != 0;
      if (field.number == 60) track = field.bytes;
    }
    if (first != !begun_) complain("the state is not cleared by the first packet alone");
    begun_ = true;
    if (!track.empty()) make_track(track);
    if (!names.empty()) name(names);
    if (!event.empty()) read_event(event, time);
  }

  void make_track(std::string_view bytes) {
    ReadTrack track;
    std::uint64_t number = 0;
    for (const Field& field : fields(bytes)) {
      if (field.number == 1) number = field.value;
      if (field.number == 2) track.name = field.bytes;
      if (field.number == 5) track.parent = field.value;
      if (field.number != 8) continue;
      track.counter = true;
      for (const Field& of_counter : fields(field.bytes)) {
        if (of_counter.number == 6) track.unit = of_counter.bytes;
      }
    }
    if (number == 0 || trace_.tracks.contains(number)) complain("a track made twice: " + track.name);
    if (track.parent != 0 && !trace_.tracks.contains(track.parent)) complain("no parent: " + track.name);
    trace_.tracks[number] = track;
  }

  void name(std::string_view bytes) {
    for (const Field& entry : fields(bytes)) {
      std::uint64_t number = 0;
      std::string text;
      for (const Field& field : fields(entry.bytes)) {
        if (field.number == 1) number = field.value;
        if (field.number == 2) text = field.bytes;
      }
      if (!names_.emplace(number, text).second) complain("a name's number twice: " + text);
    }
  }

  void annotate(ReadEvent& event, std::string_view bytes) {
    std::string key, value;
    for (const Field& field : fields(bytes)) {
      if (field.number == 10) key = field.bytes;
      if (field.number == 6) value = field.bytes;
    }
    event.annotations[key] = value;
  }

  void read_event(std::string_view bytes, std::uint64_t time) {
    ReadEvent event;
    event.time = time;
    for (const Field& field : fields(bytes)) {
      if (field.number == 4) annotate(event, field.bytes);
      if (field.number == 9) event.type = static_cast<ReadEvent::Type>(field.value);
      if (field.number == 10) {
        if (!names_.contains(field.value)) complain("a name that is not there");
        event.name = names_[field.value];
      }
      if (field.number == 11) event.track = field.value;
      if (field.number == 30) event.value = static_cast<double>(field.value);
      if (field.number == 44) event.value = std::bit_cast<double>(field.value);
      if (field.number == 47) event.arrows.push_back(field.value);
      if (field.number == 48) event.arrow_ends.push_back(field.value);
    }
    check(event);
    trace_.events.push_back(event);
  }

  void check(const ReadEvent& event) {
    if (!trace_.tracks.contains(event.track)) return complain("an event on a track that is not there");
    const ReadTrack& track = trace_.tracks[event.track];
    std::uint64_t& last = last_[event.track];
    if (event.time < last) complain("time falls on track " + track.name);
    const bool empty = event.type == ReadEvent::end && event.time == last;
    last = event.time;
    if (track.counter != (event.type == ReadEvent::counter)) complain("not what the track is for: " + track.name);
    bool& open = open_[event.track];
    if (event.type == ReadEvent::begin) {
      if (open) complain("slices overlap on track " + track.name);
      if (event.name.empty()) complain("a slice without a name on track " + track.name);
      open = true;
    }
    if (event.type == ReadEvent::end) {
      if (!open || empty) complain("an empty slice, or one without a beginning, on track " + track.name);
      open = false;
    }
    for (const std::uint64_t arrow : event.arrows) {
      if (!arrows_.emplace(arrow, event.time).second) complain("an arrow that begins twice");
    }
    for (const std::uint64_t arrow : event.arrow_ends) {
      const auto begun = arrows_.find(arrow);
      if (begun == arrows_.end() || begun->second > event.time) complain("an arrow's end without its beginning");
      arrows_.erase(arrow);
    }
  }

  ReadTrace trace_;
  bool begun_ = false;
  std::map<std::uint64_t, std::string> names_;
  std::map<std::uint64_t, std::uint64_t> last_, arrows_;
  std::map<std::uint64_t, bool> open_;
};

}  // namespace

ReadTrace read_trace(std::string_view bytes) {
  return Reader(bytes).take();
}

std::uint64_t ReadTrace::track(std::string_view name, std::uint64_t parent) const {
  for (const auto& [number, track] : tracks) {
    if (track.name == name && track.parent == parent) return number;
  }
  return 0;
}

std::map<std::string, std::uint64_t> ReadTrace::lengths(std::uint64_t track) const {
  std::map<std::string, std::uint64_t> result;
  const ReadEvent* open = nullptr;
  for (const ReadEvent& event : events) {
    if (event.track != track) continue;
    if (event.type == ReadEvent::begin) open = &event;
    if (event.type == ReadEvent::end && open != nullptr) result[open->name] += event.time - open->time;
  }
  return result;
}

std::size_t ReadTrace::arrows() const {
  std::size_t count = 0;
  for (const ReadEvent& event : events) count += event.arrow_ends.size();
  return count;
}

}  // namespace torolux::testing_support
