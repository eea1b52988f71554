// SPDX-License-Identifier: MIT
// Whether surfaces are closed decides: light that enters a body must leave it, and a sheet has no inside.
#include "host_tools/scene/decide_panes.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "host_tools/scene/components.hpp"
#include "host_tools/scene/statements.hpp"

namespace torolux {
namespace {

/// Less than this of the cube around it, and a closed surface holds nothing.
constexpr double kNoVolume = 1e-9;

bool is_body(const Component& component) {
  const double size = vec::largest(component.box.extent());
  return component.closed && std::abs(component.volume) > kNoVolume * size * size * size;
}

/// How many triangles of a material are of bodies and of sheets.
struct Uses {
  std::size_t body = 0, sheet = 0;
};

void leave_out_repeated(Scene& scene, const std::vector<bool>& sheet, Notices& notices, const Place& place) {
  std::set<std::array<std::uint32_t, 3>> seen;
  std::vector<SceneTriangle> kept;
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
    const SceneTriangle& triangle = scene.triangles[t];
    auto corners = triangle.position;
    std::ranges::sort(corners);
    if (!sheet[t] || seen.insert(corners).second)
      kept.push_back(triangle);
    else
      notices.note("a pane that stands twice, its fronts both ways, is one", place,
                   in_quotes(scene.materials[triangle.material].name));
  }
  scene.triangles = std::move(kept);
}

}  // namespace

void decide_panes(Scene& scene, Notices& notices, const Place& place) {
  const auto open = [&scene](std::uint32_t t) { return scene.materials[scene.triangles[t].material].thin_where_open; };
  if (std::ranges::none_of(scene.materials, &SceneMaterial::thin_where_open)) return;
  std::vector<bool> sheet(scene.triangles.size(), false);
  std::vector<Uses> uses(scene.materials.size());
  for (const Component& component : components(scene)) {
    const bool body = is_body(component);
    for (const std::uint32_t t : component.triangles) {
      if (!open(t)) continue;
      sheet[t] = !body;
      ++(body ? uses[scene.triangles[t].material].body : uses[scene.triangles[t].material].sheet);
    }
  }
  std::vector<std::uint32_t> as_pane(uses.size());
  for (std::uint32_t m = 0; m < uses.size(); ++m) {
    as_pane[m] = m;
    if (!scene.materials[m].thin_where_open) continue;
    const std::string name = in_quotes(scene.materials[m].name);
    scene.materials[m].thin_where_open = false;
    if (uses[m].sheet == 0) {
      notices.note("transparent material of closed bodies is solid glass", place, name);
    } else if (uses[m].body == 0) {
      notices.note("transparent material of open sheets is a pane, which does not bend light", place, name);
      scene.materials[m].thin = true;
    } else {
      notices.note("transparent material of both is solid glass on closed bodies and a pane on open sheets", place,
                   name);
      as_pane[m] = static_cast<std::uint32_t>(scene.materials.size());
      scene.materials.push_back(scene.materials[m]);
      scene.materials.back().thin = true;
    }
  }
  for (std::size_t t = 0; t < sheet.size(); ++t)
    if (sheet[t]) scene.triangles[t].material = as_pane[scene.triangles[t].material];
  leave_out_repeated(scene, sheet, notices, place);
}

}  // namespace torolux
