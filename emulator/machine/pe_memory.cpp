// SPDX-License-Identifier: MIT
// Memory as the engine needs it: by this process alone, or shared with others.
#include "emulator/machine/pe_memory.hpp"

#include <algorithm>
#include <string>

#include "emulator/cache_line.hpp"
#include "emulator/engines/engine_names.hpp"
#include "emulator/errors.hpp"
#include "emulator/machine/arguments.hpp"
#include "emulator/niu/channel.hpp"
#include "emulator/niu/processor_side.hpp"
#include "emulator/niu/state_log.hpp"
#include "emulator/trace/watcher.hpp"
#include "firmware/protocol/niu_window.hpp"

namespace torolux {
namespace {

/// Of a computer's caches. Which set of a cache a line goes to hangs on where in its page it lies: were it the same
/// place for all PEs, a thousand of them would share a few lines of the cache.
constexpr std::size_t kCacheColours = protocol::kPageBytes / kCacheLine;

/// From one channel of a PE in this process to the next: dense, so that all of them are in a few large pages and need
/// no place in each page's tables; and each a line further on in its page.
std::size_t channel_stride(std::size_t bytes) {
  return (bytes + protocol::kPageBytes - 1) / protocol::kPageBytes * protocol::kPageBytes + kCacheLine;
}

/// Of a PE that this process runs, or another: with its log of states, where somebody watches.
std::size_t channel_bytes_of(const MachineSetup& setup, bool here) {
  return (here ? small_niu_channel_bytes() : niu_channel_bytes()) + (setup.watcher != nullptr ? sizeof(StateLog) : 0);
}

/// place: of its channel among `channels`. here: no other process must be able to map it.
PeMemory make_memory(unsigned pe, std::size_t place, const MachineSetup& setup, const SharedMemory& channels,
                     bool here) {
  const std::string name = "torolux-pe" + std::to_string(pe);
  const std::size_t bytes = channel_bytes_of(setup, here);
  PeMemory memory{
      here ? SharedMemory::part_of(channels, place * channel_stride(bytes), bytes) : SharedMemory(name + "-niu", bytes),
      SharedMemory(name, mapped_bytes_for(setup.local_memory_bytes),
                   here ? SharedMemory::Use::here : SharedMemory::Use::shared, pe % kCacheColours * kCacheLine),
      setup.local_memory_bytes};
  NiuChannel& channel = *niu_channel_at(memory.channel.bytes().data());
  if (here) channel.ring_bytes = kLeastRingBytes;
  if (setup.watcher != nullptr) {
    channel.state_log = static_cast<std::uint32_t>(bytes - sizeof(StateLog));
    state_log_of(channel)->set_grain_shift(setup.watcher->grain_shift());
  }
  return memory;
}

/// That it also runs: the kit (firmware/kit) takes an eighth of a memory for what arrives, and its heap holds what it
/// knows of each PE, and what the C library needs.
std::string memory_advice(std::uint64_t image_bytes, std::uint64_t pes) {
  constexpr std::uint64_t heap = 32U * 1024U;
  constexpr std::uint64_t of_each_pe = 32;
  constexpr std::uint64_t step = 64U * 1024U;
  const std::uint64_t all = (image_bytes + heap + of_each_pe * pes) * 8 / 7;
  const std::uint64_t rounded = std::max<std::uint64_t>((all + step - 1) / step * step, protocol::kSmallestLocalMemory);
  if (rounded > protocol::kLargestLocalMemory) return "no PE may have what it takes (64M): make its data smaller";
  return "give it --pe-memory " + std::to_string(rounded / 1024) + "K or more";
}

/// Throws InputError where the image does not fit.
void check_memory(const Image& image, const MachineSetup& setup) {
  const std::uint64_t needed = std::uint64_t{image.stores_begin} - protocol::kLocalMemoryBase;
  if (needed <= setup.local_memory_bytes) return;
  throw InputError(image.file.string() + ": needs " + std::to_string(needed) +
                   " bytes of local memory for itself, a PE has " + std::to_string(setup.local_memory_bytes) + ": " +
                   memory_advice(needed, std::uint64_t{setup.columns} * setup.rows));
}

void fill_in(PeMemory& memory, unsigned pe, const MachineSetup& setup, const Image& image) {
  const auto local = memory.local.bytes().first(setup.local_memory_bytes);
  check_memory(image, setup);
  image.load_into(local);
  const std::uint32_t offset = image.niu_window - protocol::kLocalMemoryBase;
  if (image.niu_window < protocol::kLocalMemoryBase ||
      std::uint64_t{offset} + protocol::kPageBytes > setup.local_memory_bytes) {
    throw InputError(image.file.string() + ": its NIU window lies outside a local memory of " +
                     std::to_string(setup.local_memory_bytes) + " bytes");
  }
  auto& window = *reinterpret_cast<protocol::NiuWindow*>(local.data() + offset);
  window.protocol_version = protocol::kProtocolVersion;
  window.pe = pe;
  window.columns = setup.columns;
  window.rows = setup.rows;
  window.local_memory_bytes = setup.local_memory_bytes;
  write_arguments(setup.arguments, image, local);
}

SharedMemory make_channels(const MachineSetup& setup, std::size_t pes) {
  return {"torolux-niu", pes * channel_stride(channel_bytes_of(setup, true)), SharedMemory::Use::densely};
}

}  // namespace

PeMemories make_pes(const MachineSetup& setup, const ImageSet& images, std::span<const unsigned> numbers,
                    const std::vector<bool>& on_qemu) {
  PeMemories made;
  const bool here = engine_runs_here(setup.engine);
  if (here) made.channels = make_channels(setup, numbers.size());
  made.pes.reserve(numbers.size());
  for (const unsigned pe : numbers) {
    const bool is_near = here && !on_qemu[pe];
    made.pes.push_back(make_memory(pe, made.pes.size(), setup, made.channels, is_near));
    niu_channel_at(made.pes.back().channel.bytes().data())->near = is_near ? 1 : 0;
    fill_in(made.pes.back(), pe, setup, images.of(made.pes.size() - 1));
  }
  return made;
}

PeMemories mirrors_of(const MachineSetup& setup, const ImageSet& images) {
  PeMemories made;
  const unsigned pes = setup.columns * setup.rows;
  made.channels = make_channels(setup, pes);
  made.pes.reserve(pes);
  std::vector<bool> is_tried(images.images().size());
  for (unsigned pe = 0; pe < pes; ++pe) {
    made.pes.push_back(make_memory(pe, pe, setup, made.channels, true));
    niu_channel_at(made.pes.back().channel.bytes().data())->near = 1;  // its other end is: what is for the PE is lent
    // What is wrong with an image is told here, as in one process.
    if (!is_tried[images.number_of(pe)]) fill_in(made.pes.back(), pe, setup, images.of(pe));
    is_tried[images.number_of(pe)] = true;
  }
  return made;
}

}  // namespace torolux
