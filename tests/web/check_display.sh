#!/bin/bash
# SPDX-License-Identifier: MIT
# The display of small runs in Chromium: check_display.sh TOROLUX FOLDER. Screenshots go to FOLDER. Exit code 77
# (skipped): packages cannot be had.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
torolux=$(realpath "$1") folder=$(realpath -m "$2")
modules=$("$root/host_tools/web/modules.sh")
mkdir -p "$folder"
MODULES=$modules timeout 280 node "$root/tests/web/display_test.mjs" "$torolux" "$root" "$folder"
