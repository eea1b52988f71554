#!/bin/bash
# SPDX-License-Identifier: MIT
# One concept, one name: check_names.sh [ROOT]. No two files define a type of one name in one namespace. Compilers do not
# see such a pair, linkers keep one of its two functions, and which one hangs on how each file was compiled.
set -euo pipefail
root=${1-$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)}
cd "$root"

# Lines `NAMESPACE::NAME FILE`; what stands between `namespace {` and `}  // namespace` is its file's own. Of files that
# stand in for each other on each platform, one is built.
types=$(find firmware emulator host_tools scenes tests -name '*.hpp' -o -name '*.cpp' | sort | xargs awk '
  FNR == 1 { space = ""; own = 0 }
  /^namespace \{/ { own = 1 }
  /^namespace [a-z]/ { space = $2 }
  /^}  \/\/ namespace$/ { own = 0 }
  { sub(/alignas\([^)]*\) /, "") }
  !own && /^(struct|class|union|enum class) [A-Za-z_]+.*\{/ { print space "::" ($1 == "enum" ? $3 : $2), FILENAME }')
[[ -n $types ]] || { echo "$root: there is nothing to look at"; exit 1; }
twice=$(awk '{ sub(/^firmware\/niu\/(native|riscv)\/platform/, "firmware/niu/platform", $2) } !known[$0]++' <<<"$types" |
  awk '{ files[$1] = files[$1] " " $2; count[$1]++ } END { for (name in count) if (count[name] > 1) print name ":" files[name] }' | sort)
if [[ -n $twice ]]; then
  echo 'types with one name in one namespace, in several files; give each a name of its own:'
  echo "$twice"
  exit 1
fi
