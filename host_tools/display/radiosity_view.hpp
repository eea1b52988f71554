// SPDX-License-Identifier: MIT
// The scene as the camera sees it while the radiosity stage runs: what elements hold so far, read where it lies in the
// PEs' memories, enters; a rough picture leaves. The machine knows nothing of it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "host_tools/picture/picture.hpp"
#include "host_tools/render/running_render.hpp"

namespace torolux {

/// One ray for every so many pixels, and each surface's light as it leaves the element met; mirrors and glass are
/// black.
class RadiosityView {
 public:
  /// At least this many pixels at an edge, where the picture has them; more where finding what they see is soon done.
  static constexpr std::uint32_t kLeastEdge = 16, kMostEdge = 160;

  explicit RadiosityView(const RunningRender& running);

  std::uint32_t width() const { return width_; }
  std::uint32_t height() const { return height_; }

  /// Finds out what pixels see, for about so long; nothing is left to do once all is known. running: as it was.
  void work(const RunningRender& running, double seconds);
  bool whole() const { return next_ == seen_.size(); }
  /// What is known so far; elsewhere it is black. Only in the radiosity stage.
  Picture picture(const RunningRender& running) const;

 private:
  /// What a pixel sees.
  struct Seen {
    std::uint32_t patch = 0;
    std::uint32_t element = 0;  ///< of the patch
    std::uint8_t side = 0;
    bool any = false;
  };
  /// Where a PE keeps what it owns.
  struct Home {
    std::uint32_t sides = 0, elements = 0;  ///< addresses
    std::vector<std::uint32_t> first_side;  ///< of each of its patches, counted
  };

  Seen first_hit(const RunningRender& running, std::size_t pixel) const;
  const Home& home_of(const RunningRender& running, protocol::PeNumber pe);
  std::array<float, 3> light_of(const RunningRender& running, const Seen& seen) const;

  std::uint32_t step_, width_, height_;
  std::vector<Seen> seen_;
  std::size_t next_ = 0;  // of seen_, in the order in which they are found
  std::vector<std::uint32_t> patch_of_facet_;
  std::vector<std::optional<Home>> homes_;  // by PE
};

}  // namespace torolux
