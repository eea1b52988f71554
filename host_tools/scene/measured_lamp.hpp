// SPDX-License-Identifier: MIT
// A file's name and where a lamp hangs enter; what was measured, and the triangles of its opening, leave.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "host_tools/scene/files.hpp"
#include "host_tools/scene/ies.hpp"
#include "host_tools/scene/shapes.hpp"

namespace torolux {

/// folders: where the file may lie. Throws InputError: it is nowhere, or is no measured lamp (read_ies).
MeasuredLamp load_measured_lamp(const std::string& name, std::span<const std::filesystem::path> folders,
                                SceneFiles& files, const Place& asked_at, Notices& notices);

/// Its front looks along lamp.nadir. scale: scene units for each metre.
ShapeMesh opening_of(const MeasuredLamp& measured, const SceneLamp& lamp, const Vec3d& centre, double scale);

/// nadir: any length above 0. along: to where the turn begins; absent, or along nadir: x, or z where nadir lies along
/// x. web is not set.
SceneLamp hung_lamp(const MeasuredLamp& measured, const Vec3d& nadir, const std::optional<Vec3d>& along);

}  // namespace torolux
