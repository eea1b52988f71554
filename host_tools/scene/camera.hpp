// SPDX-License-Identifier: MIT
// A camera enters; what is wrong with it leaves. Or a scene's box enters, and a camera leaves, for scenes that bring
// none.
#pragma once

#include <optional>
#include <string>

#include "host_tools/scene/scene.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {

/// What is wrong with it, or nothing: eye and look_at coincide, up has no length or lies along the view, a field of
/// view outside 0..180 degrees, an aperture below zero, a focus that is not before the eye, a value that is not finite.
std::optional<std::string> camera_fault(const Camera& camera);

/// From the eye, along the view, to the plane that is sharp [scene units].
double focus_distance(const Camera& camera);

/// From the front (+z towards the viewer, y up), as far off as shows the whole box in a square picture.
Camera front_camera(const vec::Box& box);

}  // namespace torolux
