#!/bin/bash
# SPDX-License-Identifier: MIT
# Holds all pages (*.md) to the checkout: check_pages.sh [TOROLUX]. Links and files named in backticks exist, and so do
# identifiers and options; each page can be reached from README.md and docs/README.md; commands of torolux in blocks are
# commands with options that they have (asked of the program TOROLUX), of scenes that there are.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
cd "$root"
torolux=${1-build/native/bin/torolux}
status=0

tell() {  # PAGE WHAT
  echo "$1: $2"
  status=1
}

mapfile -t files < <(find . \( -path ./build -o -path ./.git -o -path ./.cache \) -prune -o -type f -printf '%P\n')
mapfile -t pages < <(printf '%s\n' "${files[@]}" | grep '\.md$' | LC_ALL=C sort)
mapfile -t sources < <(printf '%s\n' "${files[@]}" |
  grep -E '\.(cpp|hpp|h|S|ld|toml|sh|cmake|txt|json)$|^(torolux|run-tests)$|^\.c' | grep -v '^tests/fuzz/\(corpus\|grown\)')

# ---- What there is: files by each end of their path, words and options of the sources ----
declare -A ends words options
for file in "${files[@]}"; do
  while :; do
    ends[$file]=1
    folder=${file%/*}
    while [[ -n $folder && $folder != "$file" ]]; do
      ends[$folder]=1
      [[ $folder == */* ]] || break
      folder=${folder%/*}
    done
    [[ $file == */* ]] || break
    file=${file#*/}
  done
done
while IFS= read -r word; do words[$word]=1; done < <(cat "${sources[@]}" | grep -oE '[A-Za-z_][A-Za-z0-9_]*' | sort -u)
# Names of headers, sources and tests are words, too.
while IFS= read -r word; do words[$word]=1; done < <(printf '%s\n' "${files[@]}" | grep -oE '[A-Za-z_][A-Za-z0-9_]*' | sort -u)
while IFS= read -r option; do options[$option]=1; done < <(cat "${sources[@]}" | grep -ohE -e '--[a-z][a-z0-9_-]*' | sort -u)
# Compilers, QEMU, ctest, mpirun, Slurm and others have options of their own; keys of `torolux study` are options without dashes.
readonly foreign=' --allow-run-as-root --benchmark_filter --bind-to --enable-recovery --help --kill-on-bad-exit --oversubscribe --target '
# What files of others may hold: keys of PNG and MTL that are not read, forms of a face.
readonly others=' gAMA map_Ke map_Ns a/t a//n a/t/n '

# ---- Tokens in backticks ----
check_token() {  # PAGE TOKEN
  local page=$1 token=$2 part
  case $token in
    *[*\<\>\{\}\$~]* | *://* | /* | build/* | *'NAME'* | *'PATH'*) return ;;  # patterns, places on a user's computer
  esac
  [[ $others != *" $token "* ]] || return 0
  if [[ $token =~ ^--[a-z][a-z0-9-]* ]]; then
    part=${BASH_REMATCH[0]}
    [[ -n ${options[$part]-} || $foreign == *" $part "* ]] || tell "$page" "there is no option $part"
    return
  fi
  if [[ $token =~ ^[A-Za-z0-9_./-]+$ && ($token == */* || $token =~ \.(cpp|hpp|md|sh|cmake|ld|S)$) && ! $token =~ ^[0-9./]+$ ]]; then
    token=${token%/}
    token=${token#./}
    [[ -n ${ends[$token]-} || -n ${ends[$token.cpp]-} || -n ${ends[$token.hpp]-} || -e $(dirname "$page")/$token ]] || tell "$page" "there is no file $token"
    return
  fi
  # Identifiers: with an underscore, a scope, a call or a capital inside.
  if [[ $token =~ ^[A-Za-z_][A-Za-z0-9_:.]*(\(\))?$ && $token =~ (_|::|\(\)|[a-z][A-Z]) && ! $token =~ \.(png|exr|pfm|ply|csv|json|rad|obj|mtl|toml|svg|elf|txt|tsv)$ ]]; then
    for part in ${token//[^A-Za-z0-9_]/ }; do
      [[ -n ${words[$part]-} || $part =~ ^[0-9]+$ ]] || tell "$page" "there is no $part (\`$token\`)"
    done
  fi
}

declare -A links
for page in "${pages[@]}"; do
  # Blocks of commands and code are looked at below.
  text=$(awk '/^ *```/ { block = !block; next } !block' "$page")
  while IFS= read -r token; do
    check_token "$page" "$token"
  done < <(grep -o '`[^`]*`' <<<"$text" | tr -d '`' | sort -u)
  # ---- Tables of a folder's files ----
  while IFS= read -r token; do
    compgen -G "$(dirname "$page")/$token*" >/dev/null || tell "$page" "there is no file $token in its folder"
  done < <([[ $page == *README.md ]] && awk '/^\| file \|/ { table = 1; next } !/^\|/ { table = 0 } table' <<<"$text" | cut -d '|' -f 2 |
    grep -o '`[^`]*`' | tr -d '`' | sort -u)
  # ---- Links ----
  while IFS= read -r link; do
    [[ $link != *://* && $link != mailto:* ]] || continue
    target=$(dirname "$page")/${link%%#*}
    [[ -n ${link%%#*} ]] || target=$page
    target=$(realpath -m --relative-to=. "$target")
    if [[ ! -e $target ]]; then
      tell "$page" "the link $link leads nowhere"
      continue
    fi
    [[ ! -d $target || ! -e $target/README.md ]] || target=$target/README.md
    links[$page]+=" $target"
    if [[ $link == *#* && $target == *.md ]]; then
      # As GitHub names headings: in small letters, blanks to dashes, without signs.
      grep -E '^#+ ' "$target" | sed -E 's/^#+ +//; s/[^A-Za-z0-9 _-]//g; s/ /-/g' | tr '[:upper:]' '[:lower:]' |
        grep -qxF -- "${link##*#}" || tell "$page" "the link $link has no such heading"
    fi
  done < <(grep -oP '\]\(\K[^)\s]+' <<<"$text" | sort -u)
done

# ---- Each page can be reached ----
declare -A reached
queue=(README.md docs/README.md)
while ((${#queue[@]})); do
  page=${queue[0]}
  queue=("${queue[@]:1}")
  [[ -z ${reached[$page]-} ]] || continue
  reached[$page]=1
  for target in ${links[$page]-}; do [[ $target != *.md ]] || queue+=("$target"); done
done
for page in "${pages[@]}"; do [[ -n ${reached[$page]-} ]] || tell "$page" 'no page that can be reached links to it'; done

# ---- Commands ----
declare -A help
check_command() {  # PAGE LINE
  local page=$1 line=${2%%#*} word command rest
  line=$(sed 's/"[^"]*"/""/g' <<<"$line")  # values, maybe with options of another program
  rest=${line#*torolux }
  [[ $line != *torolux ]] || return 0
  read -r command rest <<<"$rest"
  [[ $command != *'|'* && $command != [A-Z]* ]] || return 0  # a form, not a command
  if [[ $command == --* ]]; then
    rest="$command $rest" command=
  fi
  if [[ -z ${help[$command]-} ]]; then
    # shellcheck disable=SC2086
    help[$command]=$("$torolux" $command --help 2>&1) || true
  fi
  # Asked for help of an unknown command, the program tells of all commands.
  if [[ ${help[$command]} != *Usage:*"torolux ${command:-[OPTIONS]}"* ]]; then
    tell "$page" "there is no command $command: $line"
    return
  fi
  for word in $rest; do
    if [[ $word == --* ]]; then
      grep -qE -- "(^|[ ,])${word%%=*}([ ,]|$)" <<<"${help[$command]}" || tell "$page" "$command has no option $word: $line"
    elif [[ $word == scenes/* || $word == studies/* ]]; then
      [[ -e $word ]] || tell "$page" "there is no $word: $line"
    fi
  done
}
if [[ -x $torolux ]]; then
  for page in "${pages[@]}"; do
    while IFS= read -r line; do
      check_command "$page" "$line"
    done < <(awk '/^ *```/ { block = !block; next } block' "$page" | grep -E '^ *(\./)?torolux ' || true)
  done
else
  tell "$torolux" 'is not built: commands cannot be checked'
fi
exit "$status"
