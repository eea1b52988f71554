#!/bin/bash
# SPDX-License-Identifier: MIT
# A program that has been built has nothing left to build: check_up_to_date.sh BUILD_FOLDER. Else every ./torolux would
# build something, say so, and be slow to start.
set -euo pipefail
left=$(ninja -C "$1" -n -d explain torolux 2>&1)
[[ $left == *'no work to do.' ]] && exit 0
echo "check_up_to_date: a build right after a build has something to do:"
head -n 5 <<<"$left"
exit 1
