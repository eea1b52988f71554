// SPDX-License-Identifier: MIT
// Tries other options, by what takes most of the fullest PE's memory, until the scene fits.
#include "host_tools/setup/advice.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <numeric>
#include <optional>

#include "emulator/errors.hpp"
#include "host_tools/setup/placements.hpp"
#include "host_tools/subspace/grid.hpp"

namespace torolux {
namespace {

/// Of one way, each with other values.
constexpr int kMostTries = 4;
/// Triangles, elements and a part of the subspaces, of all tries of a way together: of what is larger there is one try,
/// as it takes long.
constexpr std::uint64_t kMostWork = 500'000;
/// A try that leaves more than this of what was needed has not helped.
constexpr double kHelps = 0.9;
/// The fullest PE has so many times more than all have on average: it owns too much that is in one piece.
constexpr double kUneven = 2;
/// Of a length, or of PEs along an axis, at a try.
constexpr double kMostFactor = 8;

/// Settings that were changed, and what they need.
struct Way {
  Quality quality;
  MachineChoice machine;
  MeshLengths lengths;
  std::array<std::uint32_t, 3> cells{};
  MemoryNeed need;
  bool fits = false;
  bool has_pes = false, has_cells = false, has_patches = false, has_elements = false, has_texels = false;
  bool has_hemicube = false, has_host_rays = false, has_refine = false;
};

std::string three_digits(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 3);
  return {text.data(), end.ptr};
}

/// As the option's words say it.
double rounded(double value) {
  return std::stod(three_digits(value));
}

std::string words_of(const Way& way) {
  std::string words;
  const auto add = [&words](bool has, const char* option, const std::string& value) {
    if (has) words += (words.empty() ? "--" : " --") + std::string(option) + " " + value;
  };
  add(way.has_pes, "pes", std::to_string(way.machine.columns) + "x" + std::to_string(way.machine.rows));
  add(way.has_cells, "subspaces",
      std::to_string(way.cells[0]) + "x" + std::to_string(way.cells[1]) + "x" + std::to_string(way.cells[2]));
  add(way.has_host_rays, "camera-rays", "host");
  add(way.has_refine, "refine", "0");
  add(way.has_elements, "elements", three_digits(way.lengths.element));
  add(way.has_patches, "patches", three_digits(way.lengths.patch));
  add(way.has_texels, "texels", std::to_string(way.quality.texels));
  add(way.has_hemicube, "hemicube", std::to_string(way.quality.hemicube));
  return words;
}

double mean(const std::vector<std::uint64_t>& bytes) {
  return static_cast<double>(std::accumulate(bytes.begin(), bytes.end(), std::uint64_t{0})) /
         static_cast<double>(bytes.size());
}

/// Of a length whose square `bytes` go by, so that they fit beside the rest: a power of two.
double factor_for(std::uint64_t bytes, const MemoryNeed& need, std::uint64_t available) {
  const double room = static_cast<double>(available) - static_cast<double>(need.most() - bytes);
  const double wanted = room > 0 ? std::sqrt(static_cast<double>(bytes) / room) : kMostFactor;
  return std::clamp(std::exp2(std::ceil(std::log2(wanted))), 2.0, kMostFactor);
}

class Adviser {
 public:
  Adviser(const Scene& scene, const Camera& camera, const Quality& quality, const MachineChoice& machine,
          const Image& image, const std::vector<Split>& splits, const RenderSetup& setup)
      : scene_(scene), camera_(camera), image_(image), splits_(splits), setup_(setup) {
    available_ = machine.pe_memory.value_or(protocol::kLargestLocalMemory);
    start_.quality = quality;
    start_.machine = machine;
    start_.lengths = setup.mesh.lengths;
    start_.cells = setup.placement.grid.cells;
    start_.need = setup.need;
  }

  std::string text() {
    std::string fit;
    const auto add = [&fit](const std::string& words) { fit += (fit.empty() ? "" : "; or ") + words; };
    if (const auto memory = memory_that_fits()) add("--pe-memory " + memory_text(*memory));
    std::string least;
    if (start_.need.lessened_by(Lessened::nothing) < available_) {
      const Way larger = larger_machine();
      const Way rougher = rougher_solution();
      for (const Way* way : {&larger, &rougher}) {
        if (way->fits) add(words_of(*way));
      }
      const Way& best = larger.need.most() < rougher.need.most() ? larger : rougher;
      if (best.need.most() < start_.need.most())
        least = "; with " + words_of(best) + " the fullest would still need " + with_commas(best.need.most());
    }
    const std::string refusal = setup_.need.refusal(available_);
    if (!fit.empty()) return refusal + ": it fits with " + fit;
    return refusal + ": no other settings were found with which it fits" + least;
  }

 private:
  std::optional<std::uint32_t> memory_that_fits() const {
    for (std::uint64_t bytes = std::bit_ceil(std::max<std::uint64_t>(available_ + 1, setup_.need.most()));
         bytes <= protocol::kLargestLocalMemory; bytes *= 2) {
      Way way = start_;
      way.machine.pe_memory = static_cast<std::uint32_t>(bytes);
      if (place(way); way.fits) return way.machine.pe_memory;
    }
    return std::nullopt;
  }

  /// Another machine with the mesh that there is. A UsageError (too many of something) does not fit.
  void place(Way& way) const {
    try {
      const Placements placements =
          choose_placements(scene_, camera_, way.quality, way.machine, setup_.mesh, setup_.parameters, setup_.map);
      way.need = placements.need;
      way.fits = placements.memory.has_value();
    } catch (const UsageError&) {
      way.fits = false;
    }
  }

  bool is_last_try(int tries, std::uint64_t& work, std::uint64_t elements) const {
    work += setup_.mesh.triangles.size() + elements + setup_.placement.grid.count() / 8;
    return tries + 1 >= kMostTries || work > kMostWork;
  }

  static void change_cells(Way& way, bool finer) {
    for (std::uint32_t& cells : way.cells) cells = finer ? cells * 2 : std::max(1U, cells / 2);
    way.machine.subspaces = way.cells;
    way.has_cells = true;
  }

  /// More PEs share what a smaller number had; where large subspaces leave most of them nothing, finer ones do. The
  /// picture stays as it is.
  Way larger_machine() const {
    Way best = start_;
    Way way = start_;
    bool more_pes = true;
    bool coarser_helps = true;
    std::uint64_t work = 0;
    for (int tries = 0; tries < kMostTries; ++tries) {
      const std::uint64_t fixed = way.need.lessened_by(Lessened::nothing);
      if (fixed >= available_) break;  // batches for more PEs
      const std::uint64_t grid = way.need.lessened_by(Lessened::subspaces);
      const bool coarser = grid >= way.need.most() - std::min(way.need.most(), available_) && coarser_helps;
      if (coarser) {
        change_cells(way, false);
      } else if (more_pes) {
        const auto factor = static_cast<unsigned>(factor_for(way.need.most() - fixed, way.need, available_));
        way.machine.columns *= factor;
        way.machine.rows *= factor;
        way.has_pes = true;
      } else {
        change_cells(way, true);
      }
      if (std::uint64_t{way.machine.columns} * way.machine.rows > protocol::kMostPes) break;
      place(way);
      if (way.fits) return way;
      if (static_cast<double>(way.need.most()) < kHelps * static_cast<double>(best.need.most())) {
        best = way;
      } else if (coarser) {
        coarser_helps = false;
        way = best;
      } else {
        more_pes = !more_pes;
      }
      if (is_last_try(tries, work, setup_.mesh.elements)) break;
    }
    return best;
  }

  /// Makes less of what takes most. False: even without all that settings of the picture make smaller it does not fit.
  bool roughen(Way& way) const {
    constexpr std::array kGroups{Lessened::elements, Lessened::patches, Lessened::texels, Lessened::hemicube,
                                 Lessened::samples};
    std::uint64_t all = 0;
    for (const Lessened by : kGroups) all += way.need.lessened_by(by);
    if (way.need.most() - all >= available_) return false;
    const Lessened most =
        *std::ranges::max_element(kGroups, {}, [&way](Lessened by) { return way.need.lessened_by(by); });
    switch (most) {
      case Lessened::texels:
        way.quality.texels = std::max(1U, way.quality.texels / 4);
        way.has_texels = true;
        return true;
      case Lessened::hemicube:
        way.quality.hemicube = std::max(4U, way.quality.hemicube / 4 * 2);
        way.has_hemicube = true;
        return true;
      case Lessened::samples:
        way.machine.camera_rays = RayMaker::host;
        way.has_host_rays = true;
        return true;
      default:
        change_lengths(way, most);
        return true;
    }
  }

  void change_lengths(Way& way, Lessened by) const {
    const bool uneven = static_cast<double>(way.need.most()) > kUneven * mean(way.need.pe_bytes);
    const bool has_large_patches = way.lengths.patch > 2 * way.lengths.element;
    if (by == Lessened::elements && way.need.fullest_stage == protocol::Stage::radiosity && uneven &&
        has_large_patches) {
      way.lengths.patch = rounded(way.lengths.patch / 2);  // a patch's owner holds all elements of it
      way.has_patches = true;
    } else if (by == Lessened::elements) {
      way.lengths.element = rounded(way.lengths.element * factor_for(way.need.lessened_by(by), way.need, available_));
      way.has_elements = true;
    } else {
      way.lengths.patch = rounded(way.lengths.patch * factor_for(way.need.lessened_by(by), way.need, available_));
      way.has_patches = true;
    }
    if (way.lengths.patch < way.lengths.element) {
      way.lengths.patch = way.lengths.element;
      way.has_patches = true;
    }
    if (way.has_patches) way.quality.patch_length = way.lengths.patch;
    if (!way.has_elements) return;
    way.quality.element_length = way.lengths.element;
    way.quality.cluster_factor = 1;  // as where elements are given
  }

  /// Fewer elements, patches or texels, which the picture shows.
  Way rougher_solution() const {
    Way best = start_;
    Way way = start_;
    std::vector<Split> splits = splits_;
    std::uint64_t work = 0;
    for (int tries = 0; tries < kMostTries; ++tries) {
      if (!splits.empty()) {
        splits.clear();
        way.quality.refine = 0;
        way.has_refine = true;
      } else if (!roughen(way)) {
        break;
      }
      std::uint64_t elements = 0;
      try {
        const RenderSetup setup = make_setup(scene_, camera_, way.quality, way.machine, image_, splits);
        way.need = setup.need;
        way.lengths = setup.mesh.lengths;
        way.fits = setup.memory.has_value();
        elements = setup.mesh.elements;
      } catch (const std::runtime_error&) {
        break;
      }
      if (way.fits) return way;
      if (way.need.most() < best.need.most()) best = way;
      if (is_last_try(tries, work, elements)) break;
    }
    return best;
  }

  const Scene& scene_;
  const Camera& camera_;
  const Image& image_;
  const std::vector<Split>& splits_;
  const RenderSetup& setup_;
  std::uint64_t available_ = 0;
  Way start_;
};

}  // namespace

std::string does_not_fit(const Scene& scene, const Camera& camera, const Quality& quality, const MachineChoice& machine,
                         const Image& image, const std::vector<Split>& splits, const RenderSetup& setup) {
  return Adviser(scene, camera, quality, machine, image, splits, setup).text();
}

}  // namespace torolux
