// SPDX-License-Identifier: MIT
// Puts messages together.
#include "host_tools/growing_picture/viewer_messages.hpp"

#include <bit>
#include <cstring>

namespace torolux {
namespace {

static_assert(std::endian::native == std::endian::little);

class Message {
 public:
  explicit Message(ViewerMessage kind) {
    number(0);  // the length, known at the end
    byte(static_cast<std::uint8_t>(kind));
  }
  void byte(std::uint8_t value) { bytes_.push_back(std::byte{value}); }
  void number(std::uint32_t value) { append(std::as_bytes(std::span(&value, 1))); }
  void text(const std::string& value) { append(std::as_bytes(std::span(value.c_str(), value.size() + 1))); }
  void floats(std::span<const float> values) { append(std::as_bytes(values)); }
  std::vector<std::byte> finish() {
    const auto length = static_cast<std::uint32_t>(bytes_.size());
    std::memcpy(bytes_.data(), &length, sizeof length);
    return std::move(bytes_);
  }

 private:
  void append(std::span<const std::byte> more) { bytes_.insert(bytes_.end(), more.begin(), more.end()); }

  std::vector<std::byte> bytes_;
};

}  // namespace

std::vector<std::byte> create_image_message(const std::string& name, std::uint32_t width, std::uint32_t height,
                                            const std::vector<std::string>& channels) {
  Message message(ViewerMessage::create_image);
  message.byte(1);
  message.text(name);
  message.number(width);
  message.number(height);
  message.number(static_cast<std::uint32_t>(channels.size()));
  for (const std::string& channel : channels) message.text(channel);
  return message.finish();
}

std::vector<std::byte> update_image_message(const std::string& name, const std::string& channel, const Rectangle& part,
                                            std::span<const float> plane, std::uint32_t width) {
  Message message(ViewerMessage::update_image);
  message.byte(0);
  message.text(name);
  message.text(channel);
  for (const std::uint32_t value : {part.x, part.y, part.width, part.height}) message.number(value);
  for (std::uint32_t row = part.y; row < part.y + part.height; ++row)
    message.floats(plane.subspan(std::size_t{row} * width + part.x, part.width));
  return message.finish();
}

}  // namespace torolux
