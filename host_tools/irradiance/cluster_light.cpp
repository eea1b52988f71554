// SPDX-License-Identifier: MIT
// A fit at each vertex, over the clusters near it. What the fits on a cluster's facets miss of its own irradiance, the
// residual, is then shared out to the vertices around.
#include "host_tools/irradiance/cluster_light.hpp"

#include <algorithm>

#include "host_tools/scene/vec.hpp"

namespace torolux {

ClusterLight::ClusterLight(const ClusterVertices& vertices, std::span<const protocol::Flux> flux) : of_(vertices) {
  for (const ClusterVertices::Cluster& cluster : of_.clusters()) {
    const protocol::Flux& from = flux[cluster.element];
    const Vec3d sum{static_cast<double>(from[0]), static_cast<double>(from[1]), static_cast<double>(from[2])};
    irradiance_.push_back(vec::scale(sum, 1 / cluster.area));
  }
  fit();
  add_residual();
}

void ClusterLight::fit() {
  std::vector<IrradianceSample> samples;
  for (const ClusterVertices::Vertex& vertex : of_.vertices()) {
    samples.clear();
    for (const ClusterVertices::Near& at : of_.near(vertex)) {
      samples.push_back({of_.clusters()[at.cluster].normal, at.offset, irradiance_[at.cluster], at.weight});
    }
    fits_.push_back(fit_irradiance(samples));
  }
}

void ClusterLight::add_residual() {
  std::vector<Vec3d> residual = irradiance_;
  for (const ClusterVertices::Facet& facet : of_.facets()) {
    const double share = facet.area / of_.clusters()[facet.cluster].area / 3;
    for (const std::uint32_t v : facet.vertex) {
      residual[facet.cluster] =
          vec::subtract(residual[facet.cluster], vec::scale(fits_[v].facing(facet.normal), share));
    }
  }
  for (std::size_t v = 0; v < fits_.size(); ++v) {
    Vec3d sum{0, 0, 0};
    double weight = 0;
    for (const ClusterVertices::Near& at : of_.near(of_.vertices()[v])) {
      sum = vec::add(sum, vec::scale(residual[at.cluster], at.weight));
      weight += at.weight;
    }
    fits_[v].value = vec::add(fits_[v].value, vec::scale(sum, 1 / weight));
  }
}

void ClusterLight::add_flux(std::vector<Vec3d>& sums) const {
  for (std::size_t v = 0; v < fits_.size(); ++v) {
    const ClusterVertices::Vertex& vertex = of_.vertices()[v];
    Vec3d& sum = sums[vertex.surface_vertex];
    sum = vec::add(sum, vec::scale(fits_[v].facing(vertex.normal), vertex.area));
  }
}

Vec3d ClusterLight::facing(std::uint32_t facet, std::size_t corner, const Vec3d& irradiance) const {
  const ClusterVertices::Facet& of = of_.facets()[facet];
  const IrradianceFit& fit = fits_[of.vertex[corner]];
  const Vec3d& normal = of_.vertices()[of.vertex[corner]].normal;
  const Vec3d light = vec::add(irradiance, vec::subtract(fit.facing(of.normal), fit.facing(normal)));
  return {std::max(0.0, light[0]), std::max(0.0, light[1]), std::max(0.0, light[2])};
}

}  // namespace torolux
