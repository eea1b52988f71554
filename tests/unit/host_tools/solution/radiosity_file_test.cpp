// SPDX-License-Identifier: MIT
// Saved radiosities: what was saved comes back; any byte that is wrong or missing is refused; so is another scene's.
#include "host_tools/solution/radiosity_file.hpp"

#include <gtest/gtest.h>

#include "emulator/errors.hpp"
#include "host_tools/settings/options.hpp"
#include "host_tools/settings/overloaded.hpp"
#include "tests/unit/host_tools/test_scenes.hpp"

namespace torolux {
namespace {

class RadiosityFileTest : public testing::Test {
 protected:
  RadiosityFileTest() {
    solution_.sides.resize(mesh_.patch_sides);
    solution_.elements.resize(mesh_.elements);
    for (std::uint32_t i = 0; i < mesh_.patch_sides; ++i) solution_.sides[i] = {{i + 5, 2, 3}, {i, 1, 0}, {7, 8, i}};
    for (std::uint32_t i = 0; i < mesh_.elements; ++i)
      solution_.elements[i] = {{i, i + 1, i + 2}, {1, 2, 3}, {i, 5, 6}, i + 1};
    solution_.tally.escaped = {1, 2, 3};
    solution_.emitted_shot = {4, 5, 6};
    solution_.shots = 99;
  }

  std::string refusal(std::span<const std::byte> bytes, const RadiosityOrigin& expected) const {
    try {
      unpack_radiosity(parse_radiosity(bytes, "file"), expected, mesh_);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  Scene scene_ = test::room_with_box();
  Quality quality_ = [] {
    Quality quality;
    quality.patch_length = quality.element_length = 0.9;
    return quality;
  }();
  Mesh mesh_ = make_mesh(scene_, {quality_.patch_length, quality_.element_length, false});
  RadiosityOrigin origin_ = radiosity_origin(scene_, quality_, mesh_);
  std::vector<Split> splits_{{2, 1}, {2, 6}, {5, 1}};
  Solution solution_;
};

TEST_F(RadiosityFileTest, ComesBackAsItWas) {
  const auto bytes = pack_radiosity(origin_, splits_, solution_);
  const Solution back = unpack_radiosity(parse_radiosity(bytes, "file"), origin_, mesh_);
  EXPECT_EQ(pack_radiosity(origin_, splits_, back), bytes);
  EXPECT_EQ(back.sides[3].incident, solution_.sides[3].incident);
  EXPECT_EQ(back.elements[5].apart, solution_.elements[5].apart);
  EXPECT_EQ(back.elements[5].gathered, solution_.elements[5].gathered);
  EXPECT_EQ(back.elements[5].points, 6U);
  EXPECT_EQ(back.tally.escaped, solution_.tally.escaped);
  EXPECT_EQ(back.shots, 99U);
  EXPECT_EQ(parse_radiosity(bytes, "file").splits, splits_);
}

TEST_F(RadiosityFileTest, EveryDamagedByteIsRefused) {
  auto bytes = pack_radiosity(origin_, splits_, solution_);
  for (std::size_t at = 0; at < bytes.size(); at += at < 400 ? 1 : 37) {
    bytes[at] ^= std::byte{0x10};
    EXPECT_NE(refusal(bytes, origin_), "") << "byte " << at;
    bytes[at] ^= std::byte{0x10};
  }
  EXPECT_EQ(refusal(bytes, origin_), "");
}

TEST_F(RadiosityFileTest, EveryLengthButTheRightOneIsRefused) {
  auto bytes = pack_radiosity(origin_, splits_, solution_);
  for (std::size_t length = 0; length < bytes.size(); length += length < 400 ? 1 : 37) {
    EXPECT_NE(refusal(std::span(bytes).first(length), origin_), "") << length;
  }
  bytes.push_back(std::byte{0});
  EXPECT_NE(refusal(bytes, origin_), "");
}

TEST_F(RadiosityFileTest, SplitsOutOfOrderAreRefused) {
  splits_ = {{5, 1}, {2, 1}};
  EXPECT_NE(refusal(pack_radiosity(origin_, splits_, solution_), origin_).find("splits"), std::string::npos);
  splits_ = {{5, 1}, {5, 1}};
  EXPECT_NE(refusal(pack_radiosity(origin_, splits_, solution_), origin_).find("splits"), std::string::npos);
}

TEST_F(RadiosityFileTest, WhatNoElementCanHaveGatheredIsRefused) {
  solution_.elements[4].points = protocol::kMostGatherPoints + 1;
  EXPECT_NE(refusal(pack_radiosity(origin_, splits_, solution_), origin_).find("gathered"), std::string::npos);
  solution_.elements[4].points = 1;
  for (const std::int64_t value : {std::int64_t{-1}, std::int64_t{1} << 58U}) {
    solution_.elements[4].gathered[1] = value;
    EXPECT_NE(refusal(pack_radiosity(origin_, splits_, solution_), origin_).find("out of range"), std::string::npos);
  }
  solution_.elements[4].gathered = {0, 1, 0};
  solution_.elements[4].points = 0;
  EXPECT_NE(refusal(pack_radiosity(origin_, splits_, solution_), origin_).find("out of range"), std::string::npos);
}

// Elements that have gathered keep apart what shadow rays do not bring: with the other way of direct light some would
// be missing.
TEST_F(RadiosityFileTest, WhatWasGatheredServesOneWayOfDirectLight) {
  quality_.final_gather = 48;
  origin_ = radiosity_origin(scene_, quality_, mesh_);
  const auto bytes = pack_radiosity(origin_, splits_, solution_);
  EXPECT_EQ(refusal(bytes, origin_), "");
  Quality quality = quality_;
  quality.final_gather = 96;
  EXPECT_NE(refusal(bytes, radiosity_origin(scene_, quality, mesh_)).find("give --final-gather 48"), std::string::npos);
  quality = quality_;
  quality.shadow_rays = !quality.shadow_rays;
  EXPECT_NE(refusal(bytes, radiosity_origin(scene_, quality, mesh_)).find("--direct"), std::string::npos);
}

TEST_F(RadiosityFileTest, SaysWhatDiffers) {
  const auto bytes = pack_radiosity(origin_, splits_, solution_);
  Quality quality = quality_;
  quality.hemicube = 32;
  quality.seed = 77;
  EXPECT_NE(refusal(bytes, radiosity_origin(scene_, quality, mesh_))
                .find("--seed 1, this run has 77; give --seed 1 --hemicube 4, or make them anew"),
            std::string::npos);
  Scene scene = scene_;
  scene.positions[3][1] += 1e-9;
  EXPECT_NE(refusal(bytes, radiosity_origin(scene, quality_, mesh_)).find("geometry"), std::string::npos);
  scene = scene_;
  scene.materials[1].emission[2] = 5;
  EXPECT_NE(refusal(bytes, radiosity_origin(scene, quality_, mesh_)).find("materials"), std::string::npos);
  quality = quality_;
  quality.two_sided_lights = true;
  EXPECT_NE(refusal(bytes, radiosity_origin(scene_, quality, mesh_)).find("leave --two-sided-lights out"),
            std::string::npos);
  quality = quality_;
  quality.shadow_rays = !quality.shadow_rays;  // nothing was split for either way
  EXPECT_EQ(refusal(bytes, radiosity_origin(scene_, quality, mesh_)), "");
  quality = quality_;
  quality.width = 999;  // the view is free
  quality.samples = 9;
  EXPECT_EQ(refusal(bytes, radiosity_origin(scene_, quality, mesh_)), "");
}

TEST_F(RadiosityFileTest, SplitsForAnotherDirectLightAreRefused) {
  quality_.refine = 4;
  const auto bytes = pack_radiosity(radiosity_origin(scene_, quality_, mesh_), splits_, solution_);
  const SavedRadiosity saved = parse_radiosity(bytes, "file");
  EXPECT_NO_THROW(check_radiosity(saved, scene_, quality_));
  quality_.shadow_rays = false;
  EXPECT_NE(refusal(bytes, radiosity_origin(scene_, quality_, mesh_))
                .find("--direct shadow-rays, this run has radiosity; give --direct shadow-rays"),
            std::string::npos);
  EXPECT_THROW(check_radiosity(saved, scene_, quality_), InputError) << "known before there is a mesh";
}

/// Gives the option another value than any in this file.
void change(const Option& option, AllSettings& settings) {
  std::visit(Overloaded{
                 [&]<class Integer>(const option::Count<Integer>& kind) {
                   kind.member.in(settings) = static_cast<Integer>(kind.least + 8);
                 },
                 [&](const option::Number& kind) { kind.member.in(settings) += 0.25; },
                 [&](const option::Length& kind) { kind.member.in(settings) = 0.7; },
                 [&](const option::Choice& kind) { kind.member.put(settings, kind.member.of(settings) == 0 ? 1 : 0); },
                 [&](const option::Flag& kind) { kind.member.in(settings) = !kind.member.of(settings); },
                 [&](const option::White& kind) { kind.member.in(settings).kind = WhiteBalance::Kind::automatic; },
                 [&](const option::Layers& kind) { kind.member.in(settings) = 1; },
                 [](const auto&) {},
             },
             option.kind);
}

/// By which a refusal names it.
std::string named(const Option& option) {
  if (option.key == "cluster_factor") return "--elements";
  return option.name.empty() ? "--quality" : option.name;
}

// What splits and sums depend on is refused, before there is a mesh as well; the view is free.
TEST_F(RadiosityFileTest, EverySettingOfTheSolutionIsRefusedAndNoOther) {
  quality_.refine = 4;
  const auto bytes = pack_radiosity(radiosity_origin(scene_, quality_, mesh_), splits_, solution_);
  const SavedRadiosity saved = parse_radiosity(bytes, "file");
  for (const Option& option : all_options()) {
    if (option.bears_on == BearsOn::machine) continue;
    SCOPED_TRACE(option.key);
    AllSettings settings{quality_, {}, {}};
    change(option, settings);
    EXPECT_FALSE(same_value(option, settings, {quality_, {}, {}}));
    const std::string refused = refusal(bytes, radiosity_origin(scene_, settings.quality, mesh_));
    if (option.bears_on == BearsOn::picture) {
      EXPECT_EQ(refused, "");
      EXPECT_NO_THROW(check_radiosity(saved, scene_, settings.quality));
    } else {
      EXPECT_NE(refused.find(named(option)), std::string::npos) << refused;
      EXPECT_THROW(check_radiosity(saved, scene_, settings.quality), InputError);
    }
  }
}

TEST_F(RadiosityFileTest, ImpossibleFluxIsRefused) {
  solution_.sides[2].shot = {1000000, 0, 0};
  EXPECT_NE(refusal(pack_radiosity(origin_, splits_, solution_), origin_), "");
  solution_.sides[2].shot = {};
  solution_.elements[0].flux[0] = -1;
  EXPECT_NE(refusal(pack_radiosity(origin_, splits_, solution_), origin_), "");
}

}  // namespace
}  // namespace torolux
