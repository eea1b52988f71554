// SPDX-License-Identifier: MIT
// The bytes of a text file enter; UTF-8 without marks leaves.
#pragma once

#include <string>

#include "host_tools/scene/notices.hpp"

namespace torolux {

/// Takes a byte order mark away and turns UTF-16 into UTF-8; takes zero bytes and the DOS end of file (0x1A) away from
/// the end. Each is told. Throws InputError for UTF-16 that is none.
std::string plain_text(std::string bytes, const std::string& file, Notices& notices);

}  // namespace torolux
