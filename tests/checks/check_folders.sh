#!/bin/bash
# SPDX-License-Identifier: MIT
# Holds the folders to their order: check_folders.sh [ROOT]. No circle of folders by their #include lines; nothing in
# firmware knows of the emulator or the host's tools, nothing in the emulator of the tools, or of more of the firmware
# than its protocol. And tests, many of which run at once, write into a TemporaryFolder each, not where all others do.
set -euo pipefail
root=${1-$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)}
cd "$root"
status=0

# Lines `FILE INCLUDED`. Firmware includes by paths from the root, too; "platform/..." is the NIU's own.
includes=$(grep -rHoE --include='*.cpp' --include='*.hpp' --include='*.h' '^ *# *include "[^"]+"' firmware emulator host_tools |
  sed -E 's/: *# *include "/ /; s/"$//')
[[ -n $includes ]] || { echo "$root: there is nothing to look at"; exit 1; }

upward=$(awk '$1 ~ /^firmware/ && $2 ~ /^(emulator|host_tools)\// ||
              $1 ~ /^emulator/ && ($2 ~ /^host_tools\// || ($2 ~ /^firmware/ && $2 !~ /^firmware\/protocol\//))' <<<"$includes")
if [[ -n $upward ]]; then
  echo 'dependencies point from host_tools to emulator to firmware/protocol; these do not:'
  echo "$upward"
  status=1
fi

folders=$(awk '{ if ($2 !~ /\//) next
                 a = $1; sub(/\/[^\/]*$/, "", a); b = $2; sub(/\/[^\/]*$/, "", b); if (a != b) print a, b }' <<<"$includes" | sort -u)
if ! circle=$(tsort 2>&1 >/dev/null <<<"$folders"); then
  echo 'circles of folders, each including the next, the last the first:'
  sed -E 's/^tsort: (-: input contains a loop:)?//' <<<"$circle"
  status=1
fi

if [[ -d tests ]] && shared=$(grep -rn --include='*.cpp' --include='*.hpp' 'TempDir()' tests); then
  echo 'tests run at the same time; take a folder from tests/support/temporary_folder.hpp in place of:'
  echo "$shared"
  status=1
fi
exit "$status"
