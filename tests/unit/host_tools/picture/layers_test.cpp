// SPDX-License-Identifier: MIT
// Proves: an .exr holds each layer's values in the channels that are promised, beside the colours, which stay as they
// were; what the .png of each layer shows; which files stand beside a .png.
#include "host_tools/picture/layers.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "emulator/errors.hpp"
#include "host_tools/files/write_file.hpp"
#include "host_tools/picture/formats.hpp"
#include "host_tools/picture/tone_map.hpp"
#include "tests/unit/host_tools/picture/sample_picture.hpp"

namespace torolux {
namespace {

using protocol::Plane;
using testing_support::sample_picture;
using testing_support::TemporaryFolder;

constexpr float kFar = std::numeric_limits<float>::infinity();

std::vector<Layer> two_pixels() {
  return {{Plane::elements, {}, {7, kNoNumber}},
          {Plane::irradiance, {{1, 2, 3}, {4, 5, 6}}, {}},
          {Plane::depth, {{2.5F, 0, 0}, {kFar, 0, 0}}, {}},
          {Plane::normals, {{0, -1, 0}, {0, 0, 0}}, {}},
          {Plane::owner, {}, {3, 4}},
          {Plane::cost, {}, {25, 100}}};
}

/// Of a file of two pixels.
template <class Value>
std::vector<Value> channel(const std::filesystem::path& file, const char* name, Imf::PixelType type) {
  std::vector<Value> values(2);
  Imf::InputFile input(file.c_str(), 0);
  const Imf::Channel* there = input.header().channels().findChannel(name);
  EXPECT_TRUE(there != nullptr && there->type == type) << name;
  Imf::FrameBuffer frame;
  frame.insert(name, Imf::Slice(type, reinterpret_cast<char*>(values.data()), sizeof(Value), 2 * sizeof(Value)));
  input.setFrameBuffer(frame);
  input.readPixels(0);
  return values;
}

TEST(Layers, StandInTheExrUnderTheirNames) {
  const TemporaryFolder folder;
  const Picture picture = sample_picture(2, 1);
  const std::filesystem::path file = folder.path() / "a.exr";
  write_layers(picture, two_pixels(), file, {});
  EXPECT_EQ(read_picture(file).pixels, picture.pixels);
  const auto floats = [&](const char* name) { return channel<float>(file, name, Imf::FLOAT); };
  const auto numbers = [&](const char* name) { return channel<std::uint32_t>(file, name, Imf::UINT); };
  EXPECT_EQ(floats("irradiance.G"), (std::vector<float>{2, 5}));
  EXPECT_EQ(floats("irradiance.B"), (std::vector<float>{3, 6}));
  EXPECT_EQ(floats("depth.Z"), (std::vector<float>{2.5F, kFar}));
  EXPECT_EQ(floats("N.Y"), (std::vector<float>{-1, 0}));
  EXPECT_EQ(numbers("element.id"), (std::vector<std::uint32_t>{7, kNoNumber}));
  EXPECT_EQ(numbers("owner.id"), (std::vector<std::uint32_t>{3, 4}));
  EXPECT_EQ(numbers("cost.subspaces"), (std::vector<std::uint32_t>{25, 100}));
  EXPECT_EQ(encode_exr(picture), encode_exr(picture, {})) << "without layers nothing is new";
}

std::vector<std::uint8_t> shown(std::size_t layer) {
  return show_layer(two_pixels()[layer], 2, 1, {});
}

TEST(Layers, CanBeLookedAt) {
  const std::vector<std::uint8_t> elements = shown(0);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_GE(elements[c], 56) << "a number has a colour";
    EXPECT_EQ(elements[3 + c], 0) << "none has none";
  }
  EXPECT_EQ(shown(1), tone_map({2, 1, {{1, 2, 3}, {4, 5, 6}}}, {}));
  EXPECT_EQ(shown(2), (std::vector<std::uint8_t>{255, 255, 255, 0, 0, 0})) << "the nearest, and nothing";
  EXPECT_EQ(shown(3), (std::vector<std::uint8_t>{128, 0, 128, 0, 0, 0}));
  const std::vector<std::uint8_t> owners = shown(4);
  EXPECT_FALSE(std::equal(owners.begin(), owners.begin() + 3, owners.begin() + 3)) << "each PE has a colour";
  EXPECT_EQ(shown(5), (std::vector<std::uint8_t>{255, 128, 0, 255, 255, 255})) << "half of the root of the most";
}

TEST(Layers, DepthFallsFromNearToFar) {
  const Layer layer{Plane::depth, {{2, 0, 0}, {3, 0, 0}, {4, 0, 0}}, {}};
  EXPECT_EQ(show_layer(layer, 3, 1, {}), (std::vector<std::uint8_t>{255, 255, 255, 153, 153, 153, 51, 51, 51}));
}

TEST(Layers, StandBesideAPng) {
  const TemporaryFolder folder;
  const auto file = [&](const char* name) { return folder.path() / name; };
  write_layers(sample_picture(2, 1), two_pixels(), file("a.b.png"), {1, ToneCurve::filmic});
  for (const LayerName& layer : kLayerNames) {
    EXPECT_TRUE(std::filesystem::exists(file(("a.b_" + std::string(layer.name) + ".png").c_str()))) << layer.name;
  }
  write_layers(sample_picture(2, 1), two_pixels(), file("c.pfm"), {});
  EXPECT_FALSE(std::filesystem::exists(file("c_depth.pfm")));
}

TEST(Layers, ThatCannotBeWrittenAreFoundBeforehand) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "a_depth.png");
  const std::filesystem::path png = folder.path() / "a.png";
  EXPECT_NO_THROW(check_layers_writable(png, protocol::plane_bit(Plane::normals)));
  EXPECT_THROW(check_layers_writable(png, protocol::plane_bit(Plane::depth)), InputError);
  EXPECT_NO_THROW(check_layers_writable(folder.path() / "a.exr", protocol::plane_bit(Plane::depth)));
  EXPECT_THROW(check_layers_writable(folder.path() / "a.gif", 0), UsageError);
}

}  // namespace
}  // namespace torolux
