// SPDX-License-Identifier: MIT
// The picture so far: a running render enters; picture and layers leave, or planes of floats by name.
#pragma once

#include <string>
#include <vector>

#include "host_tools/picture/layers.hpp"
#include "host_tools/picture/picture.hpp"
#include "host_tools/render/running_render.hpp"

namespace torolux {

/// Pixels that no ray has reached yet are black; those whose rays are on their way have what has come of their light.
struct PictureState {
  Picture picture;
  std::vector<Layer> layers;
};

PictureState picture_state(const RunningRender& running);

struct NamedPlane {
  std::string channel;
  std::vector<float> values;  ///< by pixel, row 0 on top
};

/// R, G, B, then each channel of each layer under the name that it has in an .exr; numbers as floats, and -1 where
/// there is none.
std::vector<NamedPlane> planes_of(const PictureState& state);

}  // namespace torolux
