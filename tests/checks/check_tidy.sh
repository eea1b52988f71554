#!/bin/bash
# SPDX-License-Identifier: MIT
# Runs clang-tidy on the C++ sources that a native build compiles: check_tidy.sh BUILD_FOLDER quick|full
# full: all sources, all rules. quick: not the tests' sources, and without the static analyser, which takes three quarters
# of the time. A file that has passed is not looked at again until it, a header of its own or the rules change.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/sources.sh"
cd "$root"
export build=$1
export passed=$build/tidy
export extra=
case $2 in
  quick)
    extra=--checks=-clang-analyzer-*
    for i in "${!sources[@]}"; do
      [[ ${sources[i]} != tests/* ]] || unset 'sources[i]'
    done
    ;;
  full) ;;
  *) echo 'check_tidy: quick or full?' >&2; exit 1 ;;
esac
mkdir -p "$passed"
rules=$( (cat .clang-tidy && clang-tidy --version && echo "$extra") | sha256sum)
export rules

# The command that preprocesses a source, made of the one that CMake has written down for compiling it; nothing for a
# source that is not compiled natively.
preprocess_command() {
  awk -v file="\"file\": \"$1\"" '/^ *"command": / { line = $0 } index($0, file) { print line; exit }' \
    "$build/compile_commands.json" | sed -e 's/^ *"command": "//' -e 's/",$//' -e 's/\\"/"/g' -e 's/\\\\/\\/g' \
    -e 's/ -o [^ ]* -c / -E -C /'
}

# One source, relative to the checkout. A stamp, named by the hash of all that the result depends on, says that it passed.
check() {
  local file=$1 command stamp
  command=$(preprocess_command "$PWD/$file")
  [[ -n $command ]] || return 0
  # Preprocessed, with comments, as a NOLINT is one.
  stamp=$passed/$( (echo "$rules" && cd "$build" && eval "$command") | sha256sum | cut -c 1-32)
  [[ -e $stamp ]] && return 0
  clang-tidy --quiet -p "$build" ${extra:+"$extra"} --extra-arg=-Wno-unknown-warning-option "$file" 2> >(grep -v 'warnings generated' >&2) || return 1
  touch "$stamp"
}
export -f check preprocess_command

printf '%s\0' "${sources[@]}" | grep -z '\.cpp$' | xargs -0 -n 1 -P "$(nproc)" bash -c 'check "$1"' check
