// SPDX-License-Identifier: MIT
// The pages' scripts and styles, as esbuild has bundled them (bundle/) and the build has taken them in.
#pragma once

#include <string_view>

namespace torolux {

/// Of the report: JavaScript and CSS, UTF-8, neither with "</script" or "</style" in it.
std::string_view report_script();
std::string_view report_style();

/// Of the display, likewise.
std::string_view display_script();
std::string_view display_style();

}  // namespace torolux
