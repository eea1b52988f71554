// SPDX-License-Identifier: MIT
// The version that `torolux --version`, statistics and saved radiosities name.
#pragma once

namespace torolux {

inline constexpr const char* kVersion = "0.1.0";

/// The commit of the checkout that this program was built from, 40 digits, with "-dirty" where files had been changed
/// when the build looked it up; empty where it was not built from one.
const char* program_commit();

}  // namespace torolux
