// SPDX-License-Identifier: MIT
// Finds measured lamps' files and hangs what they say.
#include "host_tools/scene/measured_lamp.hpp"

#include "host_tools/scene/find_file.hpp"
#include "host_tools/scene/plain_text.hpp"
#include "host_tools/scene/statements.hpp"

namespace torolux {
namespace {

/// Of a disc; of one so small [m] that nobody sees its corners.
constexpr std::uint32_t kEdges = 24, kEdgesOfSmall = 12;
constexpr double kSmall = 0.05;

}  // namespace

MeasuredLamp load_measured_lamp(const std::string& name, std::span<const std::filesystem::path> folders,
                                SceneFiles& files, const Place& asked_at, Notices& notices) {
  const auto found = find_file(name, folders, files, asked_at);
  if (!found) refuse(asked_at, "there is no measured lamp " + in_quotes((folders.front() / name).string()));
  if (!found->as_written)
    notices.note("a file is found under another name", asked_at,
                 in_quotes(name) + " is " + in_quotes(found->path.string()));
  const std::string file = found->path.lexically_normal().string();
  const std::string text = plain_text(files.read(found->path, asked_at, kMostTextBytes), file, notices);
  return read_ies(text, file, notices);
}

ShapeMesh opening_of(const MeasuredLamp& measured, const SceneLamp& lamp, const Vec3d& centre, double scale) {
  if (measured.round) {
    const std::uint32_t edges = measured.length < kSmall ? kEdgesOfSmall : kEdges;
    return tessellated(Ring{centre, lamp.nadir, 0, scale * measured.length / 2}, {0, edges, edges});
  }
  const Vec3d along = vec::scale(lamp.x, scale * measured.length / 2);
  const Vec3d aside = vec::scale(vec::cross(lamp.nadir, lamp.x), scale * measured.width / 2);
  const auto corner = [&](double u, double v) {
    return vec::add(centre, vec::add(vec::scale(along, u), vec::scale(aside, v)));
  };
  return tessellated(Quad{{corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)}}, {});
}

SceneLamp hung_lamp(const MeasuredLamp& measured, const Vec3d& nadir, const std::optional<Vec3d>& along) {
  SceneLamp lamp{};
  lamp.nadir = vec::unit(nadir);
  const auto level = [&lamp](const Vec3d& way) {
    return vec::subtract(way, vec::scale(lamp.nadir, vec::dot(way, lamp.nadir)));
  };
  Vec3d begin = level(along.value_or(Vec3d{0, 0, 0}));
  if (along && !(vec::length(begin) > 1e-6 * vec::length(*along))) begin = {0, 0, 0};
  if (!(vec::length(begin) > 0)) begin = level(std::abs(lamp.nadir[0]) > 0.9 ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0});
  lamp.x = vec::unit(begin);
  lamp.y = vec::cross(lamp.x, lamp.nadir);
  const double all = measured.flux[0] + measured.flux[1];
  lamp.share = {measured.flux[0] / all, measured.flux[1] / all};
  return lamp;
}

}  // namespace torolux
