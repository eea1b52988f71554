// SPDX-License-Identifier: MIT
// A rank that a torolux with `--ranks` has started enters; that one hears that the rank is there, and how it ends.
#pragma once

#include <cstdint>

namespace torolux::ranks {

/// The environment variable with the name of the starter's socket: an abstract one, which is no file and is found on
/// its own computer only.
inline constexpr const char* kStarterVariable = "TOROLUX_STARTER";

/// One message of that socket, which keeps messages apart (SOCK_SEQPACKET).
struct StarterWord {
  enum class Kind : std::uint32_t { begins, ends };

  Kind kind;
  std::uint32_t rank;
  std::int32_t exit_code;  ///< where it ends
};

/// At the start of the process: says that this rank begins, where it was started so. True: somebody listens.
bool greet_starter();
/// Says that this rank is about to end, and with which exit code; the last one said counts. Whoever ends without a word
/// is lost. Nothing where nobody listens.
void tell_starter(int exit_code);

}  // namespace torolux::ranks
