// SPDX-License-Identifier: MIT
// The version that `torolux --version`, statistics and saved radiosities name.
#pragma once

namespace torolux {

inline constexpr const char* kVersion = "0.1.0";

}  // namespace torolux
