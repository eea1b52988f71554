// SPDX-License-Identifier: MIT
// The frame buffer controller: a queue of messages, and integer additions in their order.
#include "emulator/frame_buffer/controller.hpp"

#include <algorithm>
#include <cstring>
#include <string>

#include "emulator/errors.hpp"
#include "firmware/protocol/niu_window.hpp"

namespace torolux {

using protocol::PixelAdd;

FrameBufferController::FrameBufferController(const MachineDescription::FrameBuffer& parameters, std::uint32_t width,
                                             std::uint32_t height, std::uint32_t layers, EventQueue& events,
                                             std::uint32_t source, BlockPool& pool)
    : cycles_per_pixel_(parameters.cycles_per_pixel),
      places_(parameters.queue_messages),
      events_(events),
      source_(source),
      pool_(pool) {
  begin_picture(width, height, layers);
}

void FrameBufferController::begin_picture(std::uint32_t width, std::uint32_t height, std::uint32_t layers) {
  frame_buffer_.width = width;
  frame_buffer_.height = height;
  changes_.resize(std::size_t{width} * height);
  const std::uint32_t planes = layers | protocol::plane_bit(protocol::Plane::colour);
  for (std::uint32_t plane = 0; plane < protocol::kPlanes; ++plane) {
    const bool there = (planes >> plane & 1U) != 0;
    frame_buffer_.planes[plane].assign(there ? std::size_t{width} * height : 0, PixelSums{});
  }
}

std::uint64_t FrameBufferController::pixels_of(const Block& block) {
  if (block.source == protocol::kHost) return (block.bytes - sizeof(FrameRead)) / sizeof(PixelSums);
  return block.bytes / sizeof(PixelAdd);
}

void FrameBufferController::arrive(BlockIndex index, Cycles now) {
  const Block& block = pool_[index];
  const bool pixels = block.message_kind == static_cast<std::uint16_t>(protocol::MachineMessage::pixels) &&
                      block.bytes % sizeof(PixelAdd) == 0;
  if (!pixels && block.source != protocol::kHost) {
    throw MachineFailure("PE " + std::to_string(block.source) +
                         ": sent the frame buffer controller a message of kind " + std::to_string(block.message_kind) +
                         " with " + std::to_string(block.bytes) + " bytes; it takes whole pixels only");
  }
  if (++places_used_ > places_) {
    throw MachineFailure("the frame buffer controller has " + std::to_string(places_) + " places, and got message " +
                         std::to_string(places_used_));
  }
  high_water_ = std::max(high_water_, places_used_);
  const Cycles duration = pixels_of(block) * cycles_per_pixel_;
  free_at_ = std::max(free_at_, now) + duration;
  busy_cycles_ += duration;
  message_cycles_ += free_at_ - now;
  events_.push(free_at_, source_, EventKind::pixels_done, 0, 0, index);
}

void FrameBufferController::add_pixels(BlockIndex index) {
  const Block& block = pool_[index];
  for (std::size_t at = 0; at < block.bytes; at += sizeof(PixelAdd)) {
    PixelAdd pixel{};
    std::memcpy(&pixel, &block.payload()[at], sizeof pixel);
    const auto plane = static_cast<std::uint32_t>(pixel.plane);
    if (plane >= protocol::kPlanes || pixel.pixel >= frame_buffer_.planes[plane].size()) {
      throw MachineFailure("PE " + std::to_string(block.source) + ": added to pixel " + std::to_string(pixel.pixel) +
                           " of plane " + std::to_string(plane) + "; the frame buffer has " +
                           std::to_string(frame_buffer_.width) + " x " + std::to_string(frame_buffer_.height) +
                           ", and the planes that were asked for");
    }
    auto& sums = frame_buffer_.planes[plane][pixel.pixel];
    for (std::size_t c = 0; c < sums.size(); ++c) {
      // Modulo 2^64, as the hardware adds: no order of additions may matter.
      sums[c] =
          static_cast<std::int64_t>(static_cast<std::uint64_t>(sums[c]) + static_cast<std::uint64_t>(pixel.value[c]));
    }
    changes_.note(pixel.pixel, ++pixels_added_);
  }
  --places_used_;
  pool_.give_back(index);
}

void FrameBufferController::answer(BlockIndex index) {
  const Block& block = pool_[index];
  FrameRead read{};
  std::memcpy(&read, block.payload().data(), sizeof read);
  const auto plane = static_cast<std::uint32_t>(read.plane);
  const std::size_t pixels = plane < protocol::kPlanes ? frame_buffer_.planes[plane].size() : 0;
  if (read.count > pixels || read.first > pixels - read.count) {
    throw MachineFailure("the host program reads " + std::to_string(read.count) + " pixels from " +
                         std::to_string(read.first) + " on of plane " + std::to_string(plane) +
                         " of the frame buffer, which has " + std::to_string(pixels) + " of them");
  }
  std::memcpy(&block.payload_to_write()[sizeof read], &frame_buffer_.planes[plane][read.first],
              read.count * sizeof(PixelSums));
  --places_used_;
}

}  // namespace torolux
