// SPDX-License-Identifier: MIT
// Numbers of the mesh, the placements, the layouts and the solution are brought together.
#include "host_tools/inspect/inspector.hpp"

#include <algorithm>
#include <numbers>
#include <set>
#include <string>

#include "emulator/errors.hpp"
#include "host_tools/inspect/light_sources.hpp"
#include "host_tools/scene/vec.hpp"
#include "host_tools/solution/foreseen_flux.hpp"

namespace torolux {
namespace {

CameraRays picture_rays(const Inspected& of) {
  const std::uint32_t seed = of.setup.parameters.seed;
  return {of.camera,
          of.setup.mesh.space,
          of.quality.width,
          of.quality.height,
          PixelSamples(of.quality.filter, of.quality.samples, seed),
          seed};
}

/// As the statistics name it.
constexpr const char* name_of(protocol::Stage stage) {
  return stage == protocol::Stage::radiosity ? "radiosity" : "ray_tracing";
}

}  // namespace

Inspector::Inspector(const Inspected& of)
    : of_(of), view_(of.scene, of.setup.mesh, of.setup.ray_placement, of_.setup.units, picture_rays(of)) {}

Picture Inspector::picture() const {
  return view_.picture(foreseen_flux(of_.setup.mesh, of_.solution, false));
}

std::optional<std::uint32_t> Inspector::element_at(std::uint32_t column, std::uint32_t row) const {
  if (column >= view_.width() || row >= view_.height())
    throw InputError("there is no pixel " + std::to_string(column) + "," + std::to_string(row) + ": the picture has " +
                     std::to_string(view_.width()) + " x " + std::to_string(view_.height()) + ", counted from 0");
  const Sight& sight = view_.sights()[std::size_t{row} * view_.width() + column];
  return sight.element ? sight.element->element : std::nullopt;
}

/// Polygons, centre, who has it.
void Inspector::find_place(const ElementPlace& place, ElementAnswer& answer) const {
  const Mesh& mesh = of_.setup.mesh;
  const MeshPatch& patch = mesh.patches[place.patch];
  std::set<std::uint32_t> polygons;
  for (std::uint32_t i = 0; i < patch.facets; ++i) {
    const MeshFacet& facet = mesh.facets[patch.first_facet + i];
    if (facet.element != place.element) continue;
    if (polygons.empty()) {
      const auto corner = grid_corners(mesh.triangles[facet.triangle], facet.code);
      Vec3d centre{};
      for (std::size_t axis = 0; axis < 3; ++axis)
        centre[axis] = (corner[0][axis] + corner[1][axis] + corner[2][axis]) / 3;
      answer.centre = mesh.space.to_user(centre);
    }
    polygons.insert(facet.triangle);
  }
  answer.polygons.assign(polygons.begin(), polygons.end());
  const PatchHome& home = of_.setup.placement.patch_home[place.patch];
  answer.owner = home.pe;
  answer.subspace = of_.setup.placement.grid.cell(home.cell);
  const Placement& rays = of_.setup.ray_placement;
  for (const std::uint32_t polygon : polygons) {
    const MeshTriangle& triangle = mesh.triangles[polygon];
    for (std::uint32_t i = 0; i < 1U << (2U * triangle.patch_level); ++i) {
      const std::uint32_t part = triangle.first_part + i;
      if (mesh.parts[part].patch == place.patch && rays.has_keeper(part)) answer.keeper = rays.keeper_of_part[part];
    }
  }
}

ElementAnswer Inspector::element(std::uint32_t number) const {
  const Mesh& mesh = of_.setup.mesh;
  const ElementPlace place = place_of_element(mesh, number);
  const MeshPatch& patch = mesh.patches[place.patch];
  ElementAnswer answer;
  answer.element = number;
  answer.patch = place.patch;
  answer.of_patch = place.element;
  answer.patch_elements = patch.elements;
  answer.side = place.side;
  const std::uint32_t other = patch.first_element[1 - place.side];
  if (other != protocol::kNoSide) answer.other_side = other + place.element;
  answer.material = of_.scene.materials[patch.material].name;
  answer.area = mesh.element_area(patch, place.element);
  answer.reflectance = reflectance_of(patch);
  find_place(place, answer);
  const SolvedElement& held = of_.solution.elements[number];
  const SolvedSide& side = of_.solution.sides[patch.side[place.side]];
  answer.incident = watts_of(held.flux, of_.setup.units);
  const Vec3d apart = watts_of(held.apart, of_.setup.units);
  if (has_gathered(of_.solution)) {
    answer.apart = apart;
    answer.gathered = vec::scale(watts_of(held.gathered, of_.setup.units), 1.0 / std::max(held.points, 1U));
  } else {
    answer.direct = apart;
  }
  const Vec3d emitted = emitted_radiance(of_.scene, patch, place.side, of_.setup.units);
  const Vec3d incident = watts_of(side.incident, of_.setup.units), shot = watts_of(side.shot, of_.setup.units);
  for (std::size_t c = 0; c < 3; ++c) {
    answer.irradiance[c] = answer.area > 0 ? answer.incident[c] / answer.area : 0;
    answer.emission[c] = std::numbers::pi * emitted[c];
    answer.radiosity[c] = answer.emission[c] + answer.reflectance[c] * answer.irradiance[c];
    answer.patch_unshot[c] = incident[c] - shot[c];
  }
  answer.sources = light_sources(of_.scene, of_.setup, of_.solution, place);
  answer.pixels = static_cast<std::uint64_t>(std::ranges::count_if(
      view_.sights(), [number](const Sight& sight) { return sight.element && sight.element->element == number; }));
  return answer;
}

PeStage Inspector::stage_of(unsigned pe, protocol::Stage stage) const {
  const RenderSetup& setup = of_.setup;
  const Placement& placement = setup.placement_of(stage);
  const PeLayout layout =
      lay_out(setup.mesh, placement, static_cast<protocol::PeNumber>(pe), stage, setup.parameters, setup.map);
  PeStage answer;
  answer.name = name_of(stage);
  answer.common_subspaces = placement.common_cells;
  for (const CellIndex cell : std::span(placement.cells_of_pe[pe]).subspan(placement.common_cells))
    answer.subspaces.push_back(placement.grid.cell(cell));
  answer.polygons = placement.polygons_of_pe[pe].size();
  if (stage == protocol::Stage::radiosity) answer.patches = placement.patches_of_pe[pe].size();
  answer.stores = layout.bytes;
  answer.image_bytes = setup.map.stores_begin - protocol::kLocalMemoryBase;
  answer.used_bytes = layout.end - protocol::kLocalMemoryBase;
  answer.available_bytes = setup.memory.value_or(0);
  for (const StageFigures& figures : of_.figures.stages)
    if (figures.name == answer.name) answer.figures = figures.figures.pes[pe];
  return answer;
}

void Inspector::find_in_picture(unsigned pe, PeAnswer& answer) const {
  const Placement& placement = of_.setup.ray_placement;
  for (std::uint32_t row = 0; row < view_.height(); ++row) {
    for (std::uint32_t column = 0; column < view_.width(); ++column) {
      const auto& cell = view_.sights()[std::size_t{row} * view_.width() + column].first_cell;
      if (!cell || placement.common_cell[*cell] || placement.pe_of_cell[*cell] != pe) continue;
      ++answer.pixels;
      if (!answer.box) answer.box = PictureBox{column, row, column, row};
      PictureBox& box = *answer.box;
      box = {std::min(box.left, column), box.top, std::max(box.right, column), row};
    }
  }
}

PeAnswer Inspector::pe(unsigned number, std::vector<PassedPacket> last_packets) const {
  const unsigned pes = of_.machine.columns * of_.machine.rows;
  if (number >= pes)
    throw InputError("there is no PE " + std::to_string(number) + "; the machine has 0 to " + std::to_string(pes - 1));
  PeAnswer answer;
  answer.pe = number;
  answer.column = number % of_.machine.columns;
  answer.row = number / of_.machine.columns;
  answer.stages = {stage_of(number, protocol::Stage::radiosity), stage_of(number, protocol::Stage::ray_tracing)};
  answer.figures = of_.figures.pes.at(number);
  answer.last_packets = std::move(last_packets);
  find_in_picture(number, answer);
  return answer;
}

PixelAnswer Inspector::pixel(const FollowedPixel& pixel, const Story& story, const Picture& picture) const {
  PixelAnswer answer;
  answer.pixel = pixel;
  answer.element = element_at(pixel.column, pixel.row);
  const auto& value = picture.pixels.at(std::size_t{pixel.row} * picture.width + pixel.column);
  for (std::size_t c = 0; c < 3; ++c) answer.radiance[c] = double{value[c]};
  answer.story = story.events();
  return answer;
}

}  // namespace torolux
