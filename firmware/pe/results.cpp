// SPDX-License-Identifier: MIT
// Results and credits on their way home. Enters: a pixel's light, a record's end; leaves: bus messages.
#include "firmware/pe/results.hpp"

namespace torolux::pe {

std::int64_t to_quanta(float value) {
  const std::int32_t b = bits(value);
  const std::int32_t exponent = ((b >> 23) & 0xFF) - 150;  // value = mantissa * 2^exponent
  const std::int64_t mantissa = (b & 0x007F'FFFF) | 0x0080'0000;
  std::int64_t size = 0;
  if (exponent > 32) {
    size = std::int64_t{1} << 56U;
  } else if (exponent >= 0) {
    size = mantissa << exponent;
  } else if (exponent >= -24) {
    size = (mantissa + (std::int64_t{1} << (-exponent - 1))) >> -exponent;
  }
  return b < 0 ? -size : size;
}

void Results::add(Niu& niu, protocol::Plane plane, std::uint32_t pixel, const std::array<std::int64_t, 3>& value) {
  auto* adds = reinterpret_cast<protocol::PixelAdd*>(niu.batch().bytes.data());
  const bool same = pixels_ > 0 && adds[pixels_ - 1].pixel == pixel && adds[pixels_ - 1].plane == plane;
  if (!same) {
    if (pixels_ == protocol::kMostPixelsPerMessage) flush_pixels(niu);
    adds[pixels_++] = {{0, 0, 0}, pixel, plane};
  }
  for (std::size_t c = 0; c < 3; ++c) {
    std::int64_t& sum = adds[pixels_ - 1].value[c];  // light that is not finite may wrap round: added without sign
    sum = static_cast<std::int64_t>(static_cast<std::uint64_t>(sum) + static_cast<std::uint64_t>(value[c]));
  }
}

void Results::add_credits(Niu& niu, std::uint32_t count) {
  credits_ += count;
  if (credits_ >= kManyCredits) flush(niu);
}

void Results::flush(Niu& niu) {
  flush_pixels(niu);
  if (credits_ == 0) return;
  niu.send(protocol::MessageKind::credits, protocol::Credits{credits_});
  credits_ = 0;
}

void Results::flush_pixels(Niu& niu) {
  if (pixels_ == 0) return;
  MessageBuffer& message = niu.batch();
  message.header.kind = static_cast<std::uint16_t>(protocol::MachineMessage::pixels);
  message.header.bytes = pixels_ * static_cast<std::uint32_t>(sizeof(protocol::PixelAdd));
  niu.send_message(protocol::kFrameBuffer, message.header);
  pixels_ = 0;
}

}  // namespace torolux::pe
