#!/bin/bash
# SPDX-License-Identifier: MIT
# Runs clang-tidy on the C++ sources that a native build compiles: check_tidy.sh BUILD_FOLDER quick|full
# full: all sources, all rules. quick: what the last commits and the working tree have changed, but for the tests' sources,
# and without the static analyser: all of it would take longer than all tests together. A file that has passed is not
# looked at again until it, a header of its own or the rules change.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/sources.sh"
cd "$root"
export build=$1
export passed=$build/tidy
export extra=

# changed_sources: those that the working tree and the last commits have changed, tests aside; a header stands for the
# source beside it, or the first that includes it. Where this is no checkout of git's, or has no such history, all.
changed_sources() {
  local commits=40 changed file
  if [[ $(git rev-parse --show-toplevel 2>/dev/null) != "$root" ]] ||
    ! changed=$(git diff --name-only "HEAD~$commits" 2>/dev/null && git ls-files --others --exclude-standard); then
    printf '%s\n' "${sources[@]}"
    return
  fi
  while IFS= read -r file; do
    case $file in
      tests/*) ;;
      *.cpp) echo "$file" ;;
      *.hpp)
        if [[ -e ${file%.hpp}.cpp ]]; then
          echo "${file%.hpp}.cpp"
        else
          printf '%s\n' "${sources[@]}" | grep -v '^tests/' | grep '\.cpp$' | xargs grep -lF "#include \"$file\"" | sed -n 1p || true
        fi
        ;;
    esac
  done <<<"$changed" | sort -u | grep -xFf - <(printf '%s\n' "${sources[@]}") || true
}

case $2 in
  quick)
    extra=--checks=-clang-analyzer-*
    mapfile -t sources < <(changed_sources)
    ;;
  full) ;;
  *) echo 'check_tidy: quick or full?' >&2; exit 1 ;;
esac
mkdir -p "$passed"
# As the compiler is called, but for precompiled headers: those of GCC are nothing to clang, and each file has to include
# what it needs.
sed -E 's/ -Winvalid-pch//; s/( -Xclang)? -include(-pch)?( -Xclang)? [^ ]*cmake_pch\.hxx(\.pch)?//g' "$build/compile_commands.json" >"$passed/compile_commands.json"
rules=$( (cat .clang-tidy && clang-tidy --version && echo "$extra") | sha256sum)
export rules

# The command that preprocesses a source, made of the one that CMake has written down for compiling it; nothing for a
# source that is not compiled natively.
preprocess_command() {
  awk -v file="\"file\": \"$1\"" '/^ *"command": / { line = $0 } index($0, file) { print line; exit }' \
    "$passed/compile_commands.json" | sed -e 's/^ *"command": "//' -e 's/",$//' -e 's/\\"/"/g' -e 's/\\\\/\\/g' \
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
  clang-tidy --quiet -p "$passed" ${extra:+"$extra"} --extra-arg=-Wno-unknown-warning-option "$file" 2> >(grep -v 'warnings generated' >&2) || return 1
  touch "$stamp"
}
export -f check preprocess_command

((${#sources[@]} > 0)) || exit 0
printf '%s\0' "${sources[@]}" | grep -z '\.cpp$' | xargs -0 -n 1 -P "$(nproc)" bash -c 'check "$1"' check
