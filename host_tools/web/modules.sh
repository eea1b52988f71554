#!/bin/bash
# SPDX-License-Identifier: MIT
# Installs what package-lock.json names into build/web, once, and prints the folder. Exit code 77 where that cannot be.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
folder=$(realpath -m "$here/../../build/web")
mkdir -p "$folder"
exec 9>"$folder/.lock"
flock 9
if ! cmp -s "$here/package-lock.json" "$folder/installed.json"; then
  rm -f "$folder/installed.json"
  cp "$here/package.json" "$here/package-lock.json" "$here/.npmrc" "$folder"
  if ! command -v npm >/dev/null || ! npm --prefix "$folder" ci --ignore-scripts --no-audit --no-fund >"$folder/npm.log" 2>&1; then
    echo "npm could not install what host_tools/web/package-lock.json names: $folder/npm.log" >&2
    exit 77
  fi
  cp "$here/package-lock.json" "$folder/installed.json"
fi
echo "$folder/node_modules"
