#!/bin/bash
# SPDX-License-Identifier: MIT
# Runs a libFuzzer target on its corpus, earlier finds and dictionary: fuzz.sh FUZZER NAME RUNS. An input that ends it is named and kept
# in the current folder; exit code as libFuzzer's.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
fuzzer=$1 name=$2 runs=$3

found=$(mktemp -d)
trap 'rm -rf "$found"' EXIT
arguments=(-runs="$runs" -seed=1 -timeout=20 "$found")
[[ ! -e $here/$name.dict ]] || arguments+=(-dict="$here/$name.dict")
for folder in corpus grown; do
  [[ ! -d $here/$folder/$name ]] || arguments+=("$here/$folder/$name")
done
"$fuzzer" "${arguments[@]}"
