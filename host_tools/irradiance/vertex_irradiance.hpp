// SPDX-License-Identifier: MIT
// Vertex irradiance: from flux per element to irradiance at the elements' corners, continuous over each smooth surface.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "firmware/protocol/stores.hpp"
#include "host_tools/irradiance/irradiance_plan.hpp"
#include "host_tools/mesh/mesh.hpp"

namespace torolux {

struct VertexIrradiance {
  std::vector<protocol::CornerIrradiance> triangles;  ///< by facet; of each the front, then the back, as present
  std::vector<std::uint32_t> first;                   ///< by facet: into `triangles`
  std::uint64_t fits = 0;                             ///< fits of irradiance that were made for it
  std::uint64_t filtered = 0;                         ///< facets that the filter came by, each time counted
};

/// flux: incident, by global element (Mesh::elements of them), in quanta. watts_per_quantum: of the flux.
/// unit_radiance: values are irradiance / pi in this unit [W/(m^2 sr)].
/// A vertex takes the flux of all elements around it on its smooth surface, divided by their area. A vertex on the edge
/// of a larger element is anchored: it lies on the line between that element's corners. Facets of clusters share their
/// vertices' light but for what their own normals make of it.
/// flux_of_record: by global element, what a record brought in the mean, of the channels [quanta]: the noise that it
/// makes is filtered (light_filter.hpp). Empty: elements' light is shown as it came.
VertexIrradiance make_vertex_irradiance(const IrradiancePlan& plan, std::span<const protocol::Flux> flux,
                                        double watts_per_quantum, double unit_radiance,
                                        std::span<const double> flux_of_record = {});
/// With a plan for this once.
inline VertexIrradiance make_vertex_irradiance(const Mesh& mesh, std::span<const protocol::Flux> flux,
                                               double watts_per_quantum, double unit_radiance) {
  return make_vertex_irradiance(IrradiancePlan(mesh), flux, watts_per_quantum, unit_radiance);
}

}  // namespace torolux
