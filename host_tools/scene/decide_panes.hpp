// SPDX-License-Identifier: MIT
// A scene enters some of whose glass may be panes or bodies; it leaves with each of them the one or the other.
#pragma once

#include "host_tools/scene/notices.hpp"
#include "host_tools/scene/scene.hpp"

namespace torolux {

/// Of materials that are thin_where_open: what belongs to a closed surface is the boundary of solid glass, what does
/// not is a pane. A closed surface around nothing, such as a sheet that stands twice, its fronts both ways, is a pane,
/// and of those that stand in one place the first stays. A material of both becomes two. Tells what each was. place:
/// of the scene.
void decide_panes(Scene& scene, Notices& notices, const Place& place);

}  // namespace torolux
