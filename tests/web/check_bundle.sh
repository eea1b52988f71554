#!/bin/bash
# SPDX-License-Identifier: MIT
# Proves: host_tools/web/bundle is what its sources make, byte for byte. Exit code 77 (skipped): packages cannot be had.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
out=$root/build/web/again
rm -rf "$out"
"$root/host_tools/web/bundle.sh" "$out"
if ! diff -rq "$root/host_tools/web/bundle" "$out"; then
  echo 'The bundle is not what its sources make: run host_tools/web/bundle.sh and commit it.'
  exit 1
fi
if grep -nE '"resolved"|https?://[^ "]*\.tgz' "$root/host_tools/web/package-lock.json"; then
  echo 'package-lock.json names where packages were downloaded from; npm leaves that out with host_tools/web/.npmrc.'
  exit 1
fi
