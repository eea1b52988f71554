#!/bin/bash
# SPDX-License-Identifier: MIT
# Lets a corpus grow, and keeps it small: grow.sh NAME [SECONDS] fuzzes for so long (60), then leaves of seeds and finds
# only those that cover something the others do not (libFuzzer's merge). They stand in grown/NAME under their digests, to
# be committed; earlier finds that are covered by now go. What ends the fuzzer stays in the current folder.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
name=$1 seconds=${2-60}
fuzzer=$here/../../build/sanitize/bin/${name}_fuzzer
[[ -x $fuzzer ]] || { echo "grow.sh: there is no $fuzzer: build the preset sanitize" >&2; exit 2; }
readonly most_bytes=8192  # of one input: longer ones find little and make a slow corpus

corpus=$here/corpus/$name grown=$here/grown/$name
mkdir -p "$corpus" "$grown"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/found" "$work/small"
options=(-timeout=20 -verbosity=0)
[[ ! -e $here/$name.dict ]] || options+=(-dict="$here/$name.dict")
"$fuzzer" "${options[@]}" -max_len=$most_bytes -max_total_time="$seconds" "$work/found" "$corpus" "$grown"
# Seeds first, so that a find stays only for what they do not cover.
cp "$corpus"/* "$work/small/" 2>/dev/null || true
seeds=$(cd "$work/small" && ls)
"$fuzzer" "${options[@]}" -set_cover_merge=1 "$work/small" "$grown" "$work/found"
(cd "$work/small" && xargs -r -d '\n' rm -f <<<"$seeds")
before=$(find "$grown" -type f | wc -l)
rm -rf "$grown"
[[ -z $(ls -A "$work/small") ]] || cp -r "$work/small" "$grown"
echo "grow.sh: $name: $before finds, now $(find "$grown" -type f | wc -l), $(du -sb "$grown" | cut -f 1) bytes"
