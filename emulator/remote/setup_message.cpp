// SPDX-License-Identifier: MIT
// Images travel as they have been read: other computers need not have their files.
#include "emulator/remote/setup_message.hpp"

#include <map>
#include <string>
#include <type_traits>

#include "emulator/ranks/content.hpp"

namespace torolux::remote {
namespace {

static_assert(std::is_trivially_copyable_v<MachineDescription>, "it travels as it is");

struct SentSegment {
  ImageSegment segment{};

  template <class Archive>
  void archive(Archive& archive) {
    archive(segment.address, segment.memory_bytes, segment.contents, segment.executable, segment.writable);
  }
};

struct SentSymbol {
  ImageSymbol symbol{};

  template <class Archive>
  void archive(Archive& archive) {
    archive(symbol.address, symbol.bytes, symbol.name, symbol.function);
  }
};

struct SentImage {
  std::string file;
  std::vector<SentSegment> segments;
  std::vector<SentSymbol> symbols;
  std::uint32_t entry = 0, niu_window = 0, stores_begin = 0;
  PhaseNames phase_names;

  SentImage() = default;
  explicit SentImage(const Image& image)
      : file(image.file.string()),
        entry(image.entry),
        niu_window(image.niu_window),
        stores_begin(image.stores_begin),
        phase_names(image.phase_names) {
    segments.reserve(image.segments.size());
    symbols.reserve(image.symbols.size());
    for (const ImageSegment& segment : image.segments) segments.push_back({segment});
    for (const ImageSymbol& symbol : image.symbols) symbols.push_back({symbol});
  }
  Image image() const {
    Image made;
    made.file = file;
    made.segments.reserve(segments.size());
    made.symbols.reserve(symbols.size());
    for (const SentSegment& segment : segments) made.segments.push_back(segment.segment);
    for (const SentSymbol& symbol : symbols) made.symbols.push_back(symbol.symbol);
    made.entry = entry;
    made.niu_window = niu_window;
    made.stores_begin = stores_begin;
    made.phase_names = phase_names;
    return made;
  }

  template <class Archive>
  void archive(Archive& archive) {
    archive(file, segments, symbols, entry, niu_window, stores_begin, phase_names);
  }
};

struct SentSetup {
  MachineDescription description;
  std::uint32_t columns = 0, rows = 0, local_memory_bytes = 0, threads = 0, sharers = 1, machine_number = 0;
  std::string engine;
  std::vector<std::string> arguments;
  std::uint64_t until = 0;
  std::vector<std::uint32_t> numbers, image_of, rank_of;
  std::vector<SentImage> images;

  template <class Archive>
  void archive(Archive& archive) {
    archive(description, columns, rows, local_memory_bytes, threads, sharers, machine_number, engine, arguments, until,
            numbers, image_of, rank_of, images);
  }
};

}  // namespace

std::vector<std::byte> bytes_of_setup(const MachineSetup& machine, const ImageSet& images, const BlockPlace& place) {
  SentSetup sent;
  sent.description = machine.description;
  sent.columns = machine.columns;
  sent.rows = machine.rows;
  sent.local_memory_bytes = machine.local_memory_bytes;
  sent.threads = machine.threads;
  sent.sharers = place.sharers;
  sent.machine_number = place.machine_number;
  sent.engine = machine.engine;
  sent.arguments = machine.arguments;
  sent.until = machine.until;
  sent.numbers.assign(place.numbers.begin(), place.numbers.end());
  sent.rank_of.assign(place.rank_of.begin(), place.rank_of.end());
  std::map<std::size_t, std::uint32_t> places;  // of the images that its PEs have
  for (const unsigned pe : place.numbers) {
    const auto [image, is_new] = places.emplace(images.number_of(pe), static_cast<std::uint32_t>(places.size()));
    if (is_new) sent.images.emplace_back(images.of(pe));
    sent.image_of.push_back(image->second);
  }
  return ranks::bytes_of(std::move(sent));
}

BlockSetup setup_of_bytes(std::span<const std::byte> bytes) {
  auto sent = ranks::content_of<SentSetup>(bytes);
  BlockSetup setup;
  setup.machine.description = sent.description;
  setup.machine.columns = sent.columns;
  setup.machine.rows = sent.rows;
  setup.machine.local_memory_bytes = sent.local_memory_bytes;
  setup.machine.threads = sent.threads;
  setup.machine.engine = sent.engine;
  setup.machine.arguments = sent.arguments;
  setup.machine.until = sent.until;
  setup.place.numbers.assign(sent.numbers.begin(), sent.numbers.end());
  setup.place.rank_of.assign(sent.rank_of.begin(), sent.rank_of.end());
  setup.place.sharers = sent.sharers;
  setup.place.machine_number = sent.machine_number;
  std::vector<Image> images;
  images.reserve(sent.images.size());
  for (const SentImage& image : sent.images) images.push_back(image.image());
  setup.images = ImageSet(std::move(images), std::move(sent.image_of));
  return setup;
}

}  // namespace torolux::remote
