#!/bin/bash
# SPDX-License-Identifier: MIT
# Bundles the pages: bundle.sh [FOLDER], by default bundle/, which is committed. Packages go to build/web. Exit code 77:
# they could not be had (no npm, or no registry to be reached).
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
out=$(realpath -m "${1:-$here/bundle}")
modules=$("$here/modules.sh")
for page in report display; do
  NODE_PATH=$modules "$modules/.bin/esbuild" "$here/$page/main.jsx" --bundle --minify --format=iife --target=es2020 \
    --jsx-factory=h --jsx-fragment=Fragment --inject:"$here/shared/jsx.js" --charset=utf8 --legal-comments=none --log-level=warning \
    --banner:js='/*! With preact (c) 2015 Jason Miller, uPlot (c) 2022 Leon Sorokin: MIT licence */' \
    --outfile="$out/$page.js"
done
