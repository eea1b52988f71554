// SPDX-License-Identifier: MIT
// Where QEMU and the translated engine differ at a HINT. Enters: both as they stand there; leaves: what differs, and on
// request a report for people.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "emulator/engines/image/image.hpp"
#include "emulator/engines/lockstep/shadow.hpp"
#include "emulator/engines/qemu/hint_meeting.hpp"
#include "emulator/engines/translated/decode/code_map.hpp"

namespace torolux::lockstep {

/// How the translated engine came to where it stands.
using translated::TranslatedImage;

struct Difference {
  std::string what;                   ///< "its clock", in the order of a sentence: "... differs"
  bool at_hint;                       ///< the translated engine has met a HINT, too
  std::optional<std::uint32_t> word;  ///< address of the first word of local memory that differs, whatever else does
};

/// Nothing where they agree: the same HINT at the same clock after as many instructions, the same phase markers on the
/// way, the same local memory. After a trap QEMU's clock and count are ahead, and are not compared (docs/engines.md).
std::optional<Difference> find_difference(const HintMeeting& qemu, Shadow& shadow, TranslatedImage::Stop stop);

struct PeInQuestion {
  unsigned number;
  std::uint64_t hint;             ///< number of this HINT, phase markers not counted, from 1
  std::uint64_t last_hint_clock;  ///< at the end of the last one
  const Image& image;
  const TranslatedImage& code;     ///< as the shadow runs it
  const translated::CodeMap& map;  ///< as it should be
};

/// Several lines. Takes the shadow back to the last HINT, and so spoils it.
std::string report(const PeInQuestion& pe, const Difference& difference, const HintMeeting& qemu, Shadow& shadow,
                   std::span<const std::byte> qemu_memory);

}  // namespace torolux::lockstep
