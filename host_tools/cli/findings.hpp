// SPDX-License-Identifier: MIT
// A scene with its settings, or a result, enters; what changes the picture greatly, and was hardly meant, leaves.
#pragma once

#include <string>
#include <vector>

#include "host_tools/cli/resolve.hpp"

namespace torolux {

/// Before the work: what is wound or placed oddly, and why the picture would be black. A sentence each.
std::vector<std::string> findings_before(const Scene& scene, const Resolved& resolved);

/// After it: light that has left a closed surface; a black picture. A sentence each.
std::vector<std::string> findings_after(const Scene& scene, const RenderResult& result);

}  // namespace torolux
