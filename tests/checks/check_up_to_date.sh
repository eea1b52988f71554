#!/bin/bash
# SPDX-License-Identifier: MIT
# What has been built has nothing left to build: check_up_to_date.sh BUILD_FOLDER. The images' folder beside it likewise.
# Else every ./torolux would build something, say so, and be slow to start.
set -euo pipefail
status=0

# nothing_left FOLDER TARGET
nothing_left() {
  local left
  left=$(ninja -C "$1" -n -d explain "$2" 2>&1)
  [[ $left == *'no work to do.' ]] && return
  echo "check_up_to_date: a build of $1 right after a build has something to do:"
  head -n 5 <<<"$left"
  status=1
}

nothing_left "$1" torolux
nothing_left "$(dirname "$1")/firmware" all
exit "$status"
