// SPDX-License-Identifier: MIT
// Keys of the sky, each within its range; then its frame, its table, what the ground sends up, and the openings.
#include "host_tools/scene/sky_entry.hpp"

#include <cmath>
#include <numbers>

#include "emulator/nearest_name.hpp"
#include "firmware/protocol/sky.hpp"
#include "host_tools/scene/imported_mesh.hpp"
#include "host_tools/scene/shape_entries.hpp"
#include "host_tools/scene/sky.hpp"
#include "host_tools/scene/sky_models.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

constexpr double kMost = kMostCoordinate;
/// What the ground reflects where nothing else is said: grass, earth and stone together.
constexpr double kGround = 0.2;
/// A clear day with little haze.
constexpr double kTurbidity = 3;

void read_frame(TomlTable& table, Sky& sky) {
  const Vec3d up = table.triple("up", -kMost, kMost, false).value_or(Vec3d{0, 1, 0});
  if (!(vec::length(up) > 0)) refuse(table.place("up"), "[sky] 'up' is zero: it is a direction");
  sky.up = vec::unit(up);
  const auto given = table.triple("north", -kMost, kMost, false);
  const bool z_up = std::abs(sky.up[2]) > std::abs(sky.up[1]);
  const Vec3d north = given.value_or(z_up ? Vec3d{0, 1, 0} : Vec3d{0, 0, -1});
  const Vec3d east = vec::cross(north, sky.up);
  if (!(vec::length(east) > 1e-6 * vec::length(north)))
    refuse(table.place(given ? "north" : "up"), "[sky] 'north' is along 'up': give a level one");
  sky.east = vec::unit(east);
  sky.north = vec::cross(sky.up, sky.east);
}

void read_sun(TomlTable table, Sky& sky) {
  const double elevation = table.required(table.number("elevation", -90, 90), "elevation");
  const double azimuth = table.required(table.number("azimuth", -360, 360), "azimuth");
  sky.sun = sky_direction(sky, elevation, azimuth);
  sky.sun_irradiance = table.required(table.triple("irradiance", 0, kMost, true), "irradiance");
  table.finish();
}

/// The sun's direction in the sky's frame, for a model that needs it.
Vec3d high_sun(const TomlTable& table, const Sky& sky, bool given, const std::string& model) {
  const Vec3d sun{vec::dot(sky.sun, sky.east), vec::dot(sky.sun, sky.north), vec::dot(sky.sun, sky.up)};
  if (!given || !(sun[2] > 0))
    refuse(table.place("model"), "[sky] 'model' is \"" + model +
                                     "\", which depends on where the sun stands: give [sky.sun] an elevation above 0 "
                                     "(and an irradiance of 0 where the sun itself is hidden)");
  return sun;
}

SkyModel read_model(TomlTable& table, const Sky& sky, bool sun_given) {
  const std::string model = table.text("model").value_or("uniform");
  const auto light = [&table](std::string_view key) { return table.required(table.triple(key, 0, kMost, true), key); };
  if (model == "uniform") return uniform_sky(table.triple("radiance", 0, kMost, true).value_or(Vec3d{0, 0, 0}));
  if (model == "overcast") return overcast_sky(light("zenith"));
  if (model == "clear") return clear_sky(light("zenith"), high_sun(table, sky, sun_given, model));
  if (model == "preetham") {
    const double turbidity = table.number("turbidity", 1.9, 10).value_or(kTurbidity);
    return preetham_sky(turbidity, high_sun(table, sky, sun_given, model));
  }
  refuse(table.place("model"), "[sky] 'model': " + no_such_name(model, "no model of a sky",
                                                                {"uniform", "overcast", "clear", "preetham", "image"}));
}

/// Of a picture, which says what the ground sends, too.
SkyImageEntry read_image(TomlTable& table) {
  if (table.triple("ground", 0, 1, true))
    refuse(table.place("ground"), "[sky] 'ground' goes with a model: a picture shows what is below the horizon");
  return {table.required(table.text("file"), "file"), table.triple("scale", 0, kMost, true).value_or(Vec3d{1, 1, 1}),
          table.place("file")};
}

/// Light that comes up from far ground, which is level, diffuse and lit by all of the sky.
void light_ground(const Vec3d& reflectance, Sky& sky) {
  const Vec3d falls = sky_irradiance(sky, sky.up);
  for (std::size_t cell = 0; cell < protocol::kSkyCells / 2; ++cell)
    sky.radiance[cell] = vec::scale(vec::times(falls, reflectance), 1 / std::numbers::pi);
}

SkyQuad read_opening(TomlTable table) {
  const RectangleKeys rectangle(table);
  table.finish();
  const std::array<Vec3d, 4> corners = rectangle.corners(table);
  return {corners[0], vec::subtract(corners[1], corners[0]), vec::subtract(corners[3], corners[0])};
}

}  // namespace

Sky read_sky(TomlTable table, std::optional<SkyImageEntry>& image) {
  Sky sky;
  read_frame(table, sky);
  const toml::table* sun = table.table("sun");
  if (sun != nullptr) read_sun({*sun, table.place().file, "[sky.sun]"}, sky);
  if (table.text("model") == "image") {
    image = read_image(table);
  } else {
    sky.radiance = sky_table(read_model(table, sky, sun != nullptr));
    light_ground(table.triple("ground", 0, 1, true).value_or(Vec3d{kGround, kGround, kGround}), sky);
  }
  for (const toml::table* opening : table.tables("opening"))
    sky.openings.push_back(read_opening({*opening, table.place().file, "[[sky.opening]]"}));
  if (sky.openings.size() > protocol::kMostSkyOpenings)
    refuse(table.place("opening"), "[sky] has " + std::to_string(sky.openings.size()) + " openings; at most " +
                                       std::to_string(protocol::kMostSkyOpenings) + " are possible");
  table.finish();
  if (!image && !(greatest_sky_radiance(sky) > 0))
    refuse(table.place(), "[sky] has no light: give it a 'model', a 'radiance', or a [sky.sun]");
  return sky;
}

}  // namespace torolux
