// SPDX-License-Identifier: MIT
// Answers to what is asked of a run: of a pixel, a PE, an element. As text (answer_text.hpp) or JSON (answer_json.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "emulator/machine/machine.hpp"
#include "host_tools/layout/stage_layout.hpp"
#include "host_tools/scene/scene.hpp"
#include "host_tools/trace/story.hpp"

namespace torolux {

/// A patch from which an element has its light. [W], R G B
struct LightSource {
  std::uint32_t patch = 0;
  std::string material;
  protocol::PeNumber pe = 0;  ///< that owns it
  Vec3d emitted{}, reflected{};

  Vec3d watts() const { return {emitted[0] + reflected[0], emitted[1] + reflected[1], emitted[2] + reflected[2]}; }
  double sum() const { return watts()[0] + watts()[1] + watts()[2]; }
};

/// One side of an element.
struct ElementAnswer {
  std::uint32_t element = 0;  ///< global number
  std::uint32_t patch = 0, of_patch = 0, patch_elements = 0;
  std::uint32_t side = 0;                   ///< 0 front, 1 back
  std::optional<std::uint32_t> other_side;  ///< its number
  std::vector<std::uint32_t> polygons;      ///< on which it lies, ascending
  std::string material;
  Vec3d centre{};       ///< of its first facet [user units]
  double area = 0;      ///< [m^2]
  Vec3d reflectance{};  ///< diffuse, a texture's mean
  protocol::PeNumber owner = 0;
  std::array<std::uint32_t, 3> subspace{};      ///< that holds the patch's centre, radiosity stage
  std::optional<protocol::PeNumber> keeper;     ///< ray tracing stage: who alone has its surface
  Vec3d incident{};                             ///< [W], as shots brought it
  std::optional<Vec3d> direct;                  ///< [W]; of it, straight from emitters; absent: it has gathered
  std::optional<Vec3d> gathered, apart;         ///< [W]; then: what its points found, and of `incident` what is kept
  Vec3d irradiance{}, emission{}, radiosity{};  ///< [W/m^2]; radiosity: emission and what is reflected
  Vec3d patch_unshot{};                         ///< of its patch's side: incident flux that it has not shot on [W]
  std::vector<LightSource> sources;             ///< the greatest first
  std::uint64_t pixels = 0;                     ///< of the picture, in which it is seen
};

/// Of a PE, in one stage.
struct PeStage {
  std::string name;
  std::uint32_t common_subspaces = 0;                   ///< which all PEs have
  std::vector<std::array<std::uint32_t, 3>> subspaces;  ///< its own
  std::uint64_t polygons = 0, patches = 0;
  std::vector<StoreBytes> stores;
  std::uint64_t image_bytes = 0;  ///< the firmware with its stack
  std::uint64_t used_bytes = 0, available_bytes = 0;
  std::optional<PeFigures> figures;  ///< absent: the stage was left out
};

struct PassedPacket {
  Cycles time;
  bool sent;  ///< by the PE, or received
  protocol::PeNumber other;
  std::uint64_t records, bytes;
};

/// Where in the picture something is seen; right and bottom included.
struct PictureBox {
  std::uint32_t left, top, right, bottom;
};

struct PeAnswer {
  unsigned pe = 0, column = 0, row = 0;
  std::vector<PeStage> stages;
  PeFigures figures;  ///< of the run
  std::vector<PassedPacket> last_packets;
  std::uint64_t pixels = 0;       ///< that see first a polygon in one of its subspaces (ray tracing stage)
  std::optional<PictureBox> box;  ///< of those
};

struct PixelAnswer {
  FollowedPixel pixel{};
  Vec3d radiance{};                      ///< of the pixel, all its samples [W/(m^2 sr)]
  std::optional<std::uint32_t> element;  ///< that its first sample sees, through mirrors and glass
  std::vector<StoryEvent> story;
};

}  // namespace torolux
