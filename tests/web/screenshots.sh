#!/bin/bash
# SPDX-License-Identifier: MIT
# Makes the screenshots in docs/images anew: screenshots.sh TOROLUX. Exit code 77: packages cannot be had.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
torolux=$(realpath "$1")
modules=$("$root/host_tools/web/modules.sh")
MODULES=$modules node "$root/tests/web/screenshots.mjs" "$torolux" "$root"
