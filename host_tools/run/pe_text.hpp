// SPDX-License-Identifier: MIT
// What a PE says: a line, whose it is and when.
#pragma once

#include <cstdint>
#include <string>

#include "emulator/host/host_program.hpp"

namespace torolux {

enum class PeStream : std::uint8_t { output, errors };

/// A message of text, or a line of a PE's standard output or standard error; in the order of virtual time.
struct PeText {
  Cycles time;  ///< when the host took its end in
  PeNumber pe;
  std::string text;  ///< bytes as the PE sent them, without the line's end
  PeStream stream = PeStream::output;
  bool ended = true;  ///< false: the program, or the longest line, ended before the line did
};

}  // namespace torolux
