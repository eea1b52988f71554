// SPDX-License-Identifier: MIT
// Builds MGF's surfaces.
#include "host_tools/scene/mgf_surfaces.hpp"

#include <algorithm>
#include <array>

#include "host_tools/scene/polygon_holes.hpp"
#include "host_tools/scene/polygon_triangles.hpp"

namespace torolux {
namespace {

/// Greatest distance between a curved surface and its triangles, over the size of the whole; of what bends light, less.
constexpr double kTolerance = 3e-4, kLensTolerance = 1e-5;

}  // namespace

bool MgfVertices::knows(std::string_view keyword) {
  return keyword == "v" || keyword == "p" || keyword == "n";
}

void MgfVertices::handle(const MgfStatement& statement) {
  if (statement.keyword() == "v") {
    vertices_.select(statement);
    return;
  }
  MgfVertex& vertex = vertices_.current();
  Vec3d values{0, 0, 0};
  vertex.fault.clear();
  if (statement.count() != 3) vertex.fault = "'" + std::string(statement.keyword()) + "' is followed by three numbers";
  for (std::size_t i = 0; i < 3 && vertex.fault.empty(); ++i) {
    const ReadNumber number = parse_number(statement.word(i));
    values[i] = number.value;
    vertex.fault = number.fault;
    if (vertex.fault.empty() && !(std::abs(number.value) <= kMostCoordinate))
      vertex.fault = "a coordinate beyond 1e15 in magnitude; use other units";
  }
  if (!vertex.fault.empty()) {
    vertex.fault_place = statement.place();
  } else if (statement.keyword() == "p") {
    vertex.point = values;
  } else {
    const double length = vec::length(values);
    vertex.normal = length > 1e-100 ? vec::scale(values, 1 / length) : Vec3d{0, 0, 0};
  }
}

const MgfVertex& MgfVertices::found(const MgfStatement& statement, std::string_view name) {
  const MgfVertex& vertex = vertices_.found(statement, name);
  if (!vertex.fault.empty()) refuse(vertex.fault_place, vertex.fault);
  return vertex;
}

bool MgfSurfaces::knows(std::string_view keyword) {
  constexpr std::array<std::string_view, 8> known{"f", "fh", "sph", "cyl", "cone", "ring", "prism", "torus"};
  return std::ranges::find(known, keyword) != known.end();
}

void MgfSurfaces::handle(const MgfStatement& statement, const MgfPlacement& placement, std::size_t line) {
  material_ = materials_.current(statement);
  line_ = static_cast<std::uint32_t>(line);
  const std::string_view keyword = statement.keyword();
  const auto add = [this](const Shape& shape) { curved_.push_back({shape, material_, line_}); };
  if (keyword == "f") {
    face(statement, placement);
  } else if (keyword == "fh") {
    face_with_holes(statement, placement);
  } else if (keyword == "prism") {
    prism(statement, placement);
  } else if (keyword == "sph") {
    add(sphere(statement, placement));
  } else if (keyword == "cyl" || keyword == "cone") {
    add(cone(statement, placement));
  } else {
    add(ring_or_torus(statement, placement));
  }
  check_count(statement);
}

std::string MgfSurfaces::too_many() const {
  return "more than " + std::to_string(most_) + " triangles; make arrays (xf -a) smaller, or leave parts out";
}

/// Each curved surface makes twelve triangles or more. Faces of many corners and few triangles count by their corners.
void MgfSurfaces::check_count(const MgfStatement& statement) const {
  const std::size_t curved = 12 * curved_.size();
  if (mesh_.triangles.size() + curved > most_) statement.refuse_with(too_many());
  if (mesh_.positions.size() / 3 + curved > most_)
    statement.refuse_with("more than " + std::to_string(3 * most_) +
                          " corners of faces and curved surfaces; make arrays (xf -a) smaller, or leave parts out");
}

MgfSurfaces::Corner MgfSurfaces::corner(const MgfStatement& statement, std::string_view name) {
  const MgfVertex& vertex = vertices_.found(statement, name);
  return {vertex.point, vertex.normal};
}

double MgfSurfaces::radius(const MgfStatement& statement, std::size_t i) const {
  const double value = statement.number(i);
  if (!(std::abs(value) <= kMostCoordinate)) statement.refuse_with("a radius beyond 1e15; use other units");
  return value;
}

void MgfSurfaces::face(const MgfStatement& statement, const MgfPlacement& placement) {
  statement.expect(3, statement.count(), "f VERTEX VERTEX VERTEX ...");
  std::vector<Corner> corners;
  for (const std::string_view name : statement.arguments()) corners.push_back(corner(statement, name));
  add_polygon(std::move(corners), statement, placement);
}

void MgfSurfaces::face_with_holes(const MgfStatement& statement, const MgfPlacement& placement) {
  std::vector<Corner> corners;
  std::vector<Vec3d> points;
  std::vector<std::vector<std::uint32_t>> contours(1);
  for (const std::string_view name : statement.arguments()) {
    if (name == "-") {
      contours.emplace_back();
      continue;
    }
    contours.back().push_back(static_cast<std::uint32_t>(corners.size()));
    corners.push_back(corner(statement, name));
    points.push_back(corners.back().point);
  }
  for (const auto& contour : contours)
    if (contour.size() < 3)
      statement.refuse_with("an outline of fewer than three vertices; it is written fh VERTEX ... - VERTEX ...");
  std::vector<Corner> outline;
  for (const std::uint32_t i : joined_contours(points, contours)) outline.push_back(corners[i]);
  add_polygon(std::move(outline), statement, placement);
}

void MgfSurfaces::prism(const MgfStatement& statement, const MgfPlacement& placement) {
  statement.expect(4, statement.count(), "prism VERTEX VERTEX VERTEX ... LENGTH");
  const std::size_t n = statement.count() - 1;
  const double length = radius(statement, n);
  if (length == 0) statement.refuse_with("a prism without a length");
  std::vector<Corner> end;
  Vec3d normal{0, 0, 0};
  for (std::size_t i = 0; i < n; ++i) {
    end.push_back(corner(statement, statement.word(i)));
    const Vec3d from = vec::subtract(end[i > 0 ? i - 1 : 0].point, end[0].point);
    normal = vec::add(normal, vec::cross(from, vec::subtract(end[i].point, end[0].point)));
  }
  if (!(vec::length(normal) > 0)) statement.refuse_with("the end of a prism has no area");
  const Vec3d along = vec::scale(vec::unit(normal), -length);
  std::vector<Corner> far = end;
  for (Corner& moved : far) moved.point = vec::add(moved.point, along);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t j = (i + 1) % n;
    add_polygon({far[i], far[j], end[j], end[i]}, statement, placement);
  }
  // Normals are of the sides alone.
  for (std::vector<Corner>* face : {&end, &far})
    for (Corner& flat : *face) flat.normal = {0, 0, 0};
  std::ranges::reverse(far);
  add_polygon(std::move(end), statement, placement);
  add_polygon(std::move(far), statement, placement);
}

Shape MgfSurfaces::sphere(const MgfStatement& statement, const MgfPlacement& placement) {
  statement.expect(2, 2, "sph CENTRE RADIUS");
  const double r = radius(statement, 1) * placement.scale;
  if (r == 0) statement.refuse_with("a sphere without a radius");
  return Sphere{placement.point(corner(statement, statement.word(0)).point), r};
}

Shape MgfSurfaces::cone(const MgfStatement& statement, const MgfPlacement& placement) {
  const bool cylinder = statement.keyword() == "cyl";
  const std::size_t count = cylinder ? 3 : 4;
  statement.expect(count, count, cylinder ? "cyl VERTEX RADIUS VERTEX" : "cone VERTEX RADIUS VERTEX RADIUS");
  const double from = radius(statement, 1) * placement.scale;
  const double to = cylinder ? from : radius(statement, 3) * placement.scale;
  if (from == 0 && to == 0) statement.refuse_with("both radii are zero");
  if ((from < 0 && to > 0) || (from > 0 && to < 0))
    statement.refuse_with("one radius is above and one below zero; both are negative where the front looks inwards");
  const Cone cone{placement.point(corner(statement, statement.word(0)).point), from,
                  placement.point(corner(statement, statement.word(2)).point), to};
  if (!(vec::length(vec::subtract(cone.to, cone.from)) > 0))
    statement.refuse_with("both ends are one point; a flat disc is 'ring'");
  return cone;
}

Shape MgfSurfaces::ring_or_torus(const MgfStatement& statement, const MgfPlacement& placement) {
  const bool torus = statement.keyword() == "torus";
  statement.expect(3, 3, torus ? "torus CENTRE INNER OUTER" : "ring CENTRE INNER OUTER");
  const Corner centre = corner(statement, statement.word(0));
  if (centre.normal == Vec3d{0, 0, 0})
    statement.refuse_with("vertex " + in_quotes(statement.word(0)) + " has no normal (n), which says where a " +
                          std::string(statement.keyword()) + " looks");
  const double inner = radius(statement, 1) * placement.scale;
  const double outer = radius(statement, 2) * placement.scale;
  const bool inwards = torus && outer < 0;
  if (!(std::abs(inner) < std::abs(outer)) || (inwards ? inner > 0 : inner < 0 || outer < 0))
    statement.refuse_with(torus ? "the inner radius is 0 or more and below the outer one, or both are negative"
                                : "the inner radius is 0 or more, and below the outer one");
  const Vec3d point = placement.point(centre.point);
  const Vec3d normal = placement.direction(centre.normal);
  if (torus) return RingTorus{point, normal, inner, outer};
  return Ring{point, normal, inner, outer};
}

void MgfSurfaces::add_polygon(std::vector<Corner> corners, const MgfStatement& statement,
                              const MgfPlacement& placement) {
  for (Corner& c : corners) {
    c.point = placement.point(c.point);
    c.normal = placement.direction(c.normal);
  }
  if (placement.mirrored) std::ranges::reverse(corners);
  std::vector<Vec3d> points;
  bool smooth = true;
  for (const Corner& c : corners) {
    points.push_back(c.point);
    smooth = smooth && c.normal != Vec3d{0, 0, 0};
  }
  const PolygonTriangles cut = cut_polygon(points);
  if (cut.triangles.empty()) notices_.note("a face without area is left out", statement.place());
  if (cut.crosses_itself)
    notices_.note("a face crosses itself; its triangles may not cover what was meant", statement.place());
  const auto first = static_cast<std::uint32_t>(mesh_.positions.size());
  const auto first_normal = static_cast<std::uint32_t>(mesh_.normals.size());
  mesh_.positions.insert(mesh_.positions.end(), points.begin(), points.end());
  if (smooth)
    for (const Corner& c : corners) mesh_.normals.push_back(c.normal);
  for (const auto& triangle : cut.triangles) {
    ImportedTriangle out{{}, {kNoNormal, kNoNormal, kNoNormal}, material_, line_};
    for (std::size_t i = 0; i < 3; ++i) {
      out.position[i] = first + triangle[i];
      if (smooth) out.normal[i] = first_normal + triangle[i];
    }
    mesh_.triangles.push_back(out);
  }
}

Roundness MgfSurfaces::roundness_of(const Curved& curved, double size) const {
  const SceneMaterial& material = mesh_.materials[curved.material].material;
  if (material.kind == SurfaceKind::glass && !material.thin) return {kLensTolerance * size, 32, 128};
  return {kTolerance * size, 12, 64};
}

void MgfSurfaces::finish() {
  vec::Box box;
  for (const Vec3d& p : mesh_.positions) box.include(p);
  for (const Curved& curved : curved_) {
    const vec::Box its = bounds(curved.shape);
    box.include(its.low);
    box.include(its.high);
  }
  const double size = vec::length(box.extent());
  std::size_t count = mesh_.triangles.size();
  for (const Curved& curved : curved_) {
    count += triangles_of(curved.shape, roundness_of(curved, size));
    if (count > most_) refuse({mesh_.file, curved.line}, too_many());
  }
  for (const Curved& curved : curved_) add_curved(curved, roundness_of(curved, size));
}

void MgfSurfaces::add_curved(const Curved& curved, const Roundness& roundness) {
  const ShapeMesh shape = tessellated(curved.shape, roundness);
  std::uint32_t material = curved.material;
  if (emits(mesh_.materials[material].material)) {
    const double flat = shape.area();
    // Rounded, so that equal shapes that lie differently share one material.
    if (flat > 0) material = materials_.brighter(material, std::round(1e9 * area(curved.shape) / flat) / 1e9);
  }
  const auto first = static_cast<std::uint32_t>(mesh_.positions.size());
  const auto first_normal = static_cast<std::uint32_t>(mesh_.normals.size());
  mesh_.positions.insert(mesh_.positions.end(), shape.positions.begin(), shape.positions.end());
  mesh_.normals.insert(mesh_.normals.end(), shape.normals.begin(), shape.normals.end());
  for (const ShapeMesh::Triangle& triangle : shape.triangles) {
    ImportedTriangle out{triangle.position, triangle.normal, material, curved.line};
    for (std::uint32_t& p : out.position) p += first;
    for (std::uint32_t& n : out.normal)
      if (n != kNoNormal) n += first_normal;
    mesh_.triangles.push_back(out);
  }
}

}  // namespace torolux
