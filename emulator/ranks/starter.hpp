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
  enum class Kind : std::uint32_t { keeps, died, begins, ends };  ///< two of a rank's keeper, two of the rank

  Kind kind;
  std::uint32_t rank;
  std::int32_t status;  ///< died: as waitpid has it; ends: the exit code
};

/// First of all in a process. Where a starter listens, the rank goes on in a child; this process is its keeper: it
/// tells the starter of the child's death before the launcher can notice it, and ends as the child did. True: somebody
/// listens, and this is that child.
bool join_starter();
/// What join_starter said.
bool has_starter();
/// Says that this rank is about to end, and with which exit code; the last one said counts. Whoever ends without a word
/// is lost. Nothing where nobody listens.
void tell_starter(int exit_code);

}  // namespace torolux::ranks
