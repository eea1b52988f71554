// SPDX-License-Identifier: MIT
// Joins what inspections of the scene find, and reads the energy balance and the picture for what they miss.
#include "host_tools/cli/findings.hpp"

#include <algorithm>
#include <numeric>

#include "host_tools/report/text.hpp"
#include "host_tools/scene/components.hpp"
#include "host_tools/scene/dark_view.hpp"
#include "host_tools/scene/inspect.hpp"

namespace torolux {
namespace {

/// Of what is emitted. Less may slip through where polygons meet.
constexpr double kMostEscaping = 1e-3;

double sum(const std::array<double, 3>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// The name of a closed surface that holds the whole scene; "" where there is none.
std::string closed_around(const Scene& scene) {
  vec::Box box;
  for (const Vec3d& position : scene.positions) box.include(position);
  for (const Component& component : components(scene)) {
    if (component.closed && component.box.low == box.low && component.box.high == box.high)
      return scene.materials[scene.triangles[component.triangles[0]].material].name;
  }
  return "";
}

}  // namespace

std::vector<std::string> findings_before(const Scene& scene, const Resolved& resolved) {
  std::vector<std::string> found = inspect(scene);
  const double aspect = static_cast<double>(resolved.quality.width) / resolved.quality.height;
  for (std::string& reason : inspect_view(scene, resolved.camera, aspect, resolved.quality.two_sided_lights))
    found.push_back(std::move(reason));
  return found;
}

std::vector<std::string> findings_after(const Scene& scene, const RenderResult& result) {
  std::vector<std::string> found;
  const double emitted = sum(result.figures.energy.emitted);
  const double escaped = emitted > 0 ? sum(result.figures.energy.escaped) / emitted : 0;
  const std::string share = significant(100 * escaped, 3) + " % of the light has left the scene";
  if (escaped > kMostEscaping) {
    if (const std::string room = closed_around(scene); !room.empty())
      found.push_back(share + ", though '" + room +
                      "' closes it: a lamp outside of it, or surfaces that overlap in one plane");
  }
  const std::array<float, 3> black{0, 0, 0};
  if (!result.picture.pixels.empty() &&
      std::ranges::all_of(result.picture.pixels, [&black](const auto& pixel) { return pixel == black; }))
    found.push_back("the picture is black: " + (escaped > 0.5 ? share + " (lamps that face away?)"
                                                              : "light falls on surfaces, but on none that is seen"));
  return found;
}

}  // namespace torolux
