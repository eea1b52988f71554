// SPDX-License-Identifier: MIT
// --preview and --display-server: options enter; a picture that is shown while it grows leaves.
#pragma once

#include <memory>
#include <string>

#include "host_tools/cli/resolve.hpp"
#include "host_tools/growing_picture/growing_picture.hpp"

namespace CLI {
class App;
}

namespace torolux {

/// --preview, --display-server.
void add_growing_options(CLI::App& command, GrowingPictureChoice& choice, const std::string& group);

/// title: of the scene. Null: neither is asked for. Throws UsageError: a preview without a .png; InputError.
std::unique_ptr<GrowingPicture> growing_picture(const GrowingPictureChoice& choice, const std::string& title,
                                                const Resolved& resolved);

}  // namespace torolux
