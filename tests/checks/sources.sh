# SPDX-License-Identifier: MIT
# Sets `sources`: all C++ files of the checkout, sorted; `root` is set to it (bash, sourced).
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
mapfile -d '' -t sources < <(cd "$root" &&
  find firmware emulator host_tools tests \( -name '*.cpp' -o -name '*.hpp' \) -print0 | LC_ALL=C sort -z)
