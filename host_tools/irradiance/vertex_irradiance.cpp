// SPDX-License-Identifier: MIT
// The plan and the elements' flux enter; sums alone are left to do: means at vertices, spread to what is narrow,
// corrected at borders, filtered, then brought to the machine's unit of radiance.
#include "host_tools/irradiance/vertex_irradiance.hpp"

#include <algorithm>
#include <array>
#include <numbers>

#include "firmware/protocol/element_light.hpp"
#include "host_tools/irradiance/cluster_light.hpp"
#include "host_tools/irradiance/light_filter.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

bool is_dark(const Vec3d& light) {
  return light == Vec3d{0, 0, 0};
}
/// Irradiance at all vertices of one side [quanta / user unit^2].
class SideLight {
 public:
  /// plan, flux: outlive this.
  SideLight(const SidePlan& plan, std::span<const protocol::Flux> flux, std::span<const double> flux_of_record)
      : plan_(plan), flux_(flux), clusters_(plan.clusters, flux) {
    take_means();
    spread_and_anchor();
    follow_to_borders();
    spread_and_anchor();
    if (!flux_of_record.empty()) filter_light(plan.filter, flux, flux_of_record, values_);
    note_lit_sides();
  }

  /// Irradiance at a facet's corners.
  std::array<Vec3d, 3> at_corners(const SidePlan::Facet& facet) const {
    std::array<Vec3d, 3> light{};
    for (std::size_t c = 0; c < 3; ++c) light[c] = values_[facet.corner[c]];
    if (facet.of_cluster != SidePlan::kNone) {
      for (std::size_t c = 0; c < 3; ++c) light[c] = clusters_.facing(facet.of_cluster, c, light[c]);
    }
    if (facet.of_hidden != SidePlan::kNone) show_lit_side(plan_.hidden[facet.of_hidden], light);
    return light;
  }

 private:
  void take_means() {
    values_.assign(plan_.area.size(), {0, 0, 0});
    for (const SidePlan::Facet& facet : plan_.facets) {
      const protocol::Flux& flux = flux_[facet.element];
      Vec3d part{};
      for (std::size_t k = 0; k < 3; ++k) part[k] = facet.of_element * static_cast<double>(flux[k]);
      for (std::size_t c = 0; c < 3; ++c) {
        if ((facet.counts >> c & 1U) == 0) continue;
        for (std::size_t k = 0; k < 3; ++k) values_[facet.corner[c]][k] += part[k];
      }
    }
    clusters_.add_flux(values_);
    for (std::size_t v = 0; v < values_.size(); ++v) {
      for (double& light : values_[v]) light = plan_.area[v] > 0 ? light / plan_.area[v] : 0;
    }
  }

  /// First what is known spreads, then vertices on edges of larger elements take what lies between these's ends.
  void spread_and_anchor() {
    for (const SidePlan::Hanging& hanging : plan_.first_known) values_[hanging.vertex] = between_ends(hanging);
    for (const SidePlan::Spread& spread : plan_.spreads) {
      Vec3d sum{0, 0, 0};
      for (std::uint32_t i = 0; i < spread.count; ++i) sum = vec::add(sum, values_[plan_.sources[spread.first + i]]);
      values_[spread.to] = vec::scale(sum, 1.0 / spread.count);
    }
    for (const SidePlan::Hanging& hanging : plan_.anchored) values_[hanging.vertex] = between_ends(hanging);
  }
  Vec3d between_ends(const SidePlan::Hanging& hanging) const {
    return vec::add(vec::scale(values_[hanging.from], 1 - hanging.along),
                    vec::scale(values_[hanging.to], hanging.along));
  }

  /// What interpolation lacks of each element's own light is added at borders.
  void follow_to_borders() {
    std::vector<Vec3d> missing(plan_.borders.size(), {0, 0, 0});
    for (const SidePlan::BorderFacet& facet : plan_.border_facets) {
      const auto& corner = facet.corner;
      for (std::size_t c = 0; c < 3; ++c) {
        double mean = 0;
        for (std::size_t i = 0; i < 3; ++i) mean += facet.of_mean[i] * values_[corner[i]][c];
        const double lacks = static_cast<double>(flux_[facet.element][c]) - mean * facet.area;
        for (const std::uint32_t at : facet.border) {
          if (at != SidePlan::kNone) missing[at][c] += lacks;
        }
      }
    }
    for (std::size_t at = 0; at < missing.size(); ++at) {
      const SidePlan::Border& border = plan_.borders[at];
      Vec3d& value = values_[border.vertex];
      for (std::size_t c = 0; c < 3; ++c) value[c] = std::max(0.0, value[c] + missing[at][c] / border.area);
    }
  }

  void note_lit_sides() {
    lit_.assign(plan_.lit_places, {0, 0, 0});
    for (const SidePlan::Lit& lit : plan_.lit) {
      const Vec3d& light = values_[lit.vertex];
      if (!is_dark(light) && vec::sum(lit_[lit.place]) < vec::sum(light)) lit_[lit.place] = light;
    }
  }

  /// No light at all on the side of the wall where its middle is: that is what the wall's thing covers, and none of it
  /// is seen. What is seen lies on the other side.
  void show_lit_side(const SidePlan::Corners& places, std::array<Vec3d, 3>& light) const {
    Vec3d sum{0, 0, 0};
    double known = 0;
    for (const std::uint32_t at : places) {
      if (is_dark(lit_[at])) continue;
      sum = vec::add(sum, lit_[at]);
      known += 1;
    }
    if (!(known > 0)) return;
    for (std::size_t c = 0; c < 3; ++c)
      light[c] = is_dark(lit_[places[c]]) ? vec::scale(sum, 1 / known) : lit_[places[c]];
  }

  const SidePlan& plan_;
  std::span<const protocol::Flux> flux_;
  ClusterLight clusters_;
  std::vector<Vec3d> values_;  ///< by vertex; sums of flux at first
  std::vector<Vec3d> lit_;     ///< by lit place
};

}  // namespace

VertexIrradiance make_vertex_irradiance(const IrradiancePlan& plan, std::span<const protocol::Flux> flux,
                                        double watts_per_quantum, double unit_radiance,
                                        std::span<const double> flux_of_record) {
  const double factor = watts_per_quantum / (std::numbers::pi * unit_radiance);
  VertexIrradiance irradiance;
  irradiance.first = plan.first;
  irradiance.triangles.resize(plan.triangles);
  for (const SidePlan& side : plan.side) {
    irradiance.fits += side.clusters.fits();
    if (!flux_of_record.empty()) irradiance.filtered += kFilterPasses * side.filter.triangles().size();
    const SideLight light(side, flux, flux_of_record);
    for (const SidePlan::Facet& facet : side.facets) {
      const std::array<Vec3d, 3> corners = light.at_corners(facet);
      auto& to = irradiance.triangles[facet.triangle].irradiance_over_pi;
      for (std::size_t c = 0; c < 3; ++c) to[c] = to_float(vec::scale(corners[c], factor));
      protocol::mark_concave(irradiance.triangles[facet.triangle], facet.concave);
    }
  }
  return irradiance;
}

}  // namespace torolux
