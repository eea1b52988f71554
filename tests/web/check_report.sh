#!/bin/bash
# SPDX-License-Identifier: MIT
# Reports of a small render, of an image and of a profile, opened in Chromium: check_report.sh TOROLUX FOLDER. Screenshots go to FOLDER.
# Exit code 77 (skipped): packages cannot be had.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
torolux=$1 folder=$(realpath -m "$2")
modules=$("$root/host_tools/web/modules.sh")
mkdir -p "$folder"
"$torolux" render "$root/scenes/cornell_box" --quality draft --size 96x96 --max-shots 40 --pes 4x3 --replicate 0 --quiet \
  --no-picture --report "$folder/render.html"
"$torolux" run "$root/build/firmware/bin/token.elf" --quiet --report "$folder/run.html" >/dev/null
"$torolux" profile "$root/build/firmware/bin/known_calls.elf" --pes 2x1 --quiet --report "$folder/profile.html" >/dev/null
MODULES=$modules timeout 240 node "$root/tests/web/report_test.mjs" "$folder"
