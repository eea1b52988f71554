#!/bin/bash
# SPDX-License-Identifier: MIT
# Fails where a C++ file is not formatted as .clang-format says, or does not begin with licence and purpose.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/sources.sh"
cd "$root"

status=0
clang-format --dry-run -Werror "${sources[@]}" || status=1
for file in "${sources[@]}"; do
  { read -r licence && read -r purpose; } <"$file" || true
  if [[ $licence != '// SPDX-License-Identifier: MIT' || $purpose != '// '?* ]]; then
    echo "$file:1: must begin with the licence's line and a sentence that says what the file is for"
    status=1
  fi
done
exit "$status"
