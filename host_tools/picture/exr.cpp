// SPDX-License-Identifier: MIT
// OpenEXR, in memory: a picture enters, the bytes of an .exr leave, and the other way round.
#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <mutex>

#include "emulator/errors.hpp"
#include "host_tools/picture/formats.hpp"

namespace torolux {
namespace {

class MemoryOutput : public Imf::OStream {
 public:
  MemoryOutput() : OStream("memory") {}
  void write(const char* data, int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (position_ + size > bytes.size()) bytes.resize(position_ + size);
    std::memcpy(bytes.data() + position_, data, size);
    position_ += size;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }

  std::vector<std::byte> bytes;

 private:
  std::size_t position_ = 0;
};

class MemoryInput : public Imf::IStream {
 public:
  explicit MemoryInput(std::span<const std::byte> bytes) : IStream("memory"), bytes_(bytes) {}
  bool read(char* data, int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (count < 0 || position_ > bytes_.size() || size > bytes_.size() - position_)
      throw InputError("the file is cut off");
    std::memcpy(data, bytes_.data() + position_, size);
    position_ += size;
    return position_ < bytes_.size();
  }
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override { position_ = position; }

 private:
  std::span<const std::byte> bytes_;
  std::uint64_t position_ = 0;
};

/// Channels of a picture that is written, each in header and frame.
class Channels {
 public:
  Channels(Imf::Header& header, std::size_t width) : header_(header), width_(width) {}

  /// component: 4-byte word of each value.
  template <class Value>
  void add(const std::string& name, Imf::PixelType type, const std::vector<Value>& values, std::size_t component) {
    header_.channels().insert(name, Imf::Channel(type));
    // The library takes pointers to what it only reads as pointers to char.
    auto* first = reinterpret_cast<char*>(const_cast<Value*>(values.data()));
    frame.insert(name, Imf::Slice(type, first + 4 * component, sizeof(Value), sizeof(Value) * width_));
  }

  Imf::FrameBuffer frame;

 private:
  Imf::Header& header_;
  std::size_t width_;
};

/// Reads a file that is already open; the data window is the picture.
Picture read_pixels(Imf::InputFile& file, const std::string& name) {
  const Imath::Box2i window = file.header().dataWindow();
  const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
  const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
  check_picture_size(static_cast<std::uint64_t>(std::max<std::int64_t>(width, 0)),
                     static_cast<std::uint64_t>(std::max<std::int64_t>(height, 0)), name);
  const Imf::ChannelList& channels = file.header().channels();
  const bool colour = channels.findChannel("R") && channels.findChannel("G") && channels.findChannel("B");
  if (!colour && !channels.findChannel("Y")) throw InputError("it has neither channels R, G, B nor Y");

  Picture picture{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), {}};
  picture.pixels.resize(static_cast<std::size_t>(width * height));
  const std::array<const char*, 3> names{colour ? "R" : "Y", "G", "B"};
  const Imath::V2i origin = window.min;
  Imf::FrameBuffer frame;
  for (std::size_t c = 0; c < (colour ? 3U : 1U); ++c) {
    const Imf::Channel& channel = channels[names[c]];
    if (channel.xSampling != 1 || channel.ySampling != 1) throw InputError("its channels are subsampled");
    frame.insert(names[c], Imf::Slice::Make(Imf::FLOAT, picture.pixels.data()->data() + c, origin, width, height,
                                            sizeof(picture.pixels[0]),
                                            sizeof(picture.pixels[0]) * static_cast<std::size_t>(width)));
  }
  file.setFrameBuffer(frame);
  file.readPixels(window.min.y, window.max.y);
  if (!colour)
    for (auto& pixel : picture.pixels) pixel = {pixel[0], pixel[0], pixel[0]};
  return picture;
}

}  // namespace

std::vector<std::byte> encode_exr(const Picture& picture, std::span<const Layer> layers) {
  Imf::Header header(static_cast<int>(picture.width), static_cast<int>(picture.height));
  header.compression() = Imf::ZIP_COMPRESSION;
  Channels channels(header, picture.width);
  for (std::size_t c = 0; c < 3; ++c) channels.add(&"R\0G\0B"[2 * c], Imf::FLOAT, picture.pixels, c);
  for (const Layer& layer : layers) {
    for (const LayerChannel& channel : channels_of(layer)) {
      if (layer.values.empty()) {
        channels.add(channel.name, Imf::UINT, layer.numbers, 0);
      } else {
        channels.add(channel.name, Imf::FLOAT, layer.values, channel.component);
      }
    }
  }
  MemoryOutput output;
  {
    // No helper threads: the bytes do not depend on them, and the machine's own threads have the cores.
    Imf::OutputFile file(output, header, 0);
    file.setFrameBuffer(channels.frame);
    file.writePixels(static_cast<int>(picture.height));
  }
  return std::move(output.bytes);
}

Picture decode_exr(std::span<const std::byte> bytes, const std::string& name) {
  // A damaged header must not make the library ask for memory before the size has been checked.
  static std::once_flag limits_set;
  std::call_once(limits_set, [] {
    Imf::Header::setMaxImageSize(static_cast<int>(kMostPictureEdge), static_cast<int>(kMostPictureEdge));
    Imf::Header::setMaxTileSize(4096, 4096);
  });
  try {
    MemoryInput input(bytes);
    Imf::InputFile file(input, 0);
    return read_pixels(file, name);
  } catch (const std::exception& error) {
    throw InputError(name + ": not an OpenEXR picture that can be read: " + error.what());
  }
}

}  // namespace torolux
