// SPDX-License-Identifier: MIT
// A solved scene and the machine that solved it enter; answers about its elements, PEs and pixels leave, without a
// further run.
#pragma once

#include <cstdint>
#include <optional>

#include "host_tools/inspect/answers.hpp"
#include "host_tools/inspect/element_view.hpp"
#include "host_tools/solution/solution.hpp"

namespace torolux {

/// What answers are made of; all outlives the inspector.
struct Inspected {
  const Scene& scene;
  const Camera& camera;
  const Quality& quality;
  const MachineChoice& machine;
  const RenderSetup& setup;
  const Solution& solution;
  const MachineFigures& figures;
};

class Inspector {
 public:
  explicit Inspector(const Inspected& of);

  /// Of the picture's size, one ray for each pixel.
  const ElementView& view() const { return view_; }
  /// The scene with what its elements hold.
  Picture picture() const;
  /// That is seen in a pixel, through mirrors and glass. Absent: no lit side of an element is. Throws InputError:
  /// there is no such pixel.
  std::optional<std::uint32_t> element_at(std::uint32_t column, std::uint32_t row) const;
  /// Throws InputError: there is no such element.
  ElementAnswer element(std::uint32_t number) const;
  /// last_packets: a PacketLog's. Throws InputError: there is no such PE.
  PeAnswer pe(unsigned number, std::vector<PassedPacket> last_packets) const;
  /// story: that followed it through the run. picture: the run's.
  PixelAnswer pixel(const FollowedPixel& pixel, const Story& story, const Picture& picture) const;

 private:
  PeStage stage_of(unsigned pe, protocol::Stage stage) const;
  void find_in_picture(unsigned pe, PeAnswer& answer) const;
  void find_place(const ElementPlace& place, ElementAnswer& answer) const;

  Inspected of_;
  ElementView view_;
};

}  // namespace torolux
