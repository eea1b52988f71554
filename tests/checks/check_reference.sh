#!/bin/bash
# SPDX-License-Identifier: MIT
# Holds docs/firmware_reference.md to the headers that it is made of, and those to having a comment for each public name.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
made=$(mktemp)
trap 'rm -f "$made"' EXIT
"$root/cmake/make_reference.sh" >"$made"
diff -u "$root/docs/firmware_reference.md" "$made" ||
  { echo 'out of date: cmake/make_reference.sh > docs/firmware_reference.md'; exit 1; }
