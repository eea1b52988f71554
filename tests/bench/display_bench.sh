#!/bin/bash
# SPDX-License-Identifier: MIT
# What a display costs a run: display_bench.sh TOROLUX [REPETITIONS] renders with 1,024 PEs without a display and with one
# that a page looks at 30 times a second, in turn, and prints wall and CPU time [s] of each, as its statistics have them,
# and their medians.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
torolux=$(realpath "$1") repetitions=${2:-5}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
words=(render "$root/scenes/cornell_box" --pes 32x32 --quality draft --size 256x256 --no-picture --quiet)

note() {  # KIND
  grep -oE '"(wall_seconds|scheduler_seconds|engine_seconds)": [0-9.e-]+' "$folder/stats.json" |
    awk '/wall/ { wall = $2 } /_seconds/ && !/wall/ { cpu += $2 } END { print wall, cpu }' |
    tee -a "$folder/$1" | sed "s/^/$1: wall and CPU /"
}

plain() {
  "$torolux" "${words[@]}" --stats "$folder/stats.json"
  note plain
}

# A page that takes all that is told, until the run is done.
display() {
  "$torolux" "${words[@]}" --stats "$folder/stats.json" --display 0 2>"$folder/told" &
  local run=$! url
  until url=$(grep -m1 -o 'http://[^ ]*' "$folder/told"); do kill -0 $run && sleep 0.05; done
  curl -sN "${url}stream" >"$folder/stream" &
  local page=$!
  until grep -aq '"state":"done"' "$folder/stream"; do kill -0 $run && sleep 1; done
  curl -s -H 'Content-Type: application/json' -d '{"do":"end"}' "${url}command" >"$folder/end"
  wait $run $page || true
  note display
}

for ((i = 0; i < repetitions; ++i)); do
  plain
  display
done
median() { sort -n | awk '{ v[NR] = $1 } END { print v[int((NR + 1) / 2)] }'; }
for kind in plain display; do
  echo "$kind, medians: wall $(cut -d' ' -f1 "$folder/$kind" | median) s, CPU $(cut -d' ' -f2 "$folder/$kind" | median) s"
done
echo "looks in the last run: $(grep -ao '"elapsed"' "$folder/stream" | wc -l), bytes: $(wc -c <"$folder/stream")"
