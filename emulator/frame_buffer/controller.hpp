// SPDX-License-Identifier: MIT
// The frame buffer controller (FBC): messages of pixels in, sums in the frame buffer out; also to the host that reads.
#pragma once

#include <cstdint>

#include "emulator/description/description.hpp"
#include "emulator/frame_buffer/frame_changes.hpp"
#include "emulator/host/host_program.hpp"
#include "emulator/time/event_queue.hpp"
#include "emulator/torus/block.hpp"

namespace torolux {

/// Takes messages in order; each PixelAdd costs cycles_per_pixel, and so does a pixel that is read. The bus counts its
/// places, and brings no more.
class FrameBufferController {
 public:
  /// layers: planes besides the colours, as bits (protocol::plane_bit).
  FrameBufferController(const MachineDescription::FrameBuffer& parameters, std::uint32_t width, std::uint32_t height,
                        std::uint32_t layers, EventQueue& events, std::uint32_t source, BlockPool& pool);

  /// While it has nothing to do: its sums become those of an empty picture.
  void begin_picture(std::uint32_t width, std::uint32_t height, std::uint32_t layers);

  /// Of a message: PixelAdds, or sums that the host reads (FrameRead).
  static std::uint64_t pixels_of(const Block& block);

  /// A message has come over the bus. Throws MachineFailure: not of pixels, no place for it.
  void arrive(BlockIndex block, Cycles now);
  /// Event pixels_done: adds the message's pixels and frees its place. Throws MachineFailure: a pixel or a plane that
  /// is not in the frame buffer.
  void add_pixels(BlockIndex block);

  /// Event pixels_done of a FrameRead: its sums stand in the message, which goes on to the host; its place is free.
  /// Throws MachineFailure likewise.
  void answer(BlockIndex block);

  std::uint32_t waiting() const { return places_used_; }
  const FrameBuffer& frame_buffer() const { return frame_buffer_; }
  const FrameChanges& changes() const { return changes_; }
  std::uint32_t high_water() const { return high_water_; }   ///< messages that waited or were being added
  Cycles message_cycles() const { return message_cycles_; }  ///< that messages spent here, in all
  Cycles busy_cycles() const { return busy_cycles_; }
  std::uint64_t pixels_added() const { return pixels_added_; }
  /// After its state has been restored.
  void tell_all_changed() { changes_.note_all(pixels_added_); }
  /// All of it that a run changes.
  template <class Archive>
  void archive(Archive& archive) {
    archive(frame_buffer_.planes, places_used_, high_water_, free_at_, busy_cycles_, message_cycles_, pixels_added_);
  }

 private:
  std::uint32_t cycles_per_pixel_, places_;
  EventQueue& events_;
  std::uint32_t source_;
  BlockPool& pool_;
  FrameBuffer frame_buffer_;
  FrameChanges changes_;
  std::uint32_t places_used_ = 0;
  std::uint32_t high_water_ = 0;
  Cycles free_at_ = 0;
  Cycles busy_cycles_ = 0;
  Cycles message_cycles_ = 0;
  std::uint64_t pixels_added_ = 0;
};

}  // namespace torolux
