#!/bin/bash
# SPDX-License-Identifier: MIT
# Prints the table of regions of an image: print_regions.sh IMAGE.elf. Enters: the symbols that linker/pe.ld sets.
set -euo pipefail

image=$1
declare -A address
while read -r value _ symbol; do
  address[$symbol]=$((16#$value))
done < <(riscv64-unknown-elf-nm "$image")

base=${address[_start]}
# row NAME FIRST USED_UP_TO NEXT: a region from FIRST to NEXT, filled up to USED_UP_TO.
row() {
  printf '%-24s 0x%08x %9d %9d\n' "$1" "$2" $(($3 - $2)) $(($4 - $3))
}

printf '%-24s %10s %9s %9s\n' "$(basename "$image")" address used free
row 'code, constants' "$base" "${address[image_code_used]}" "${address[image_code_end]}"
row 'stack' "${address[image_stack_begin]}" "${address[image_stack_end]}" "${address[image_stack_end]}"
row 'data' "${address[image_stack_end]}" "${address[image_bss_end]}" "${address[__niu_window]}"
row 'NIU window' "${address[__niu_window]}" "${address[__stores_begin]}" "${address[__stores_begin]}"
for kib in 256 1024; do
  row "stores ($kib KiB memory)" "${address[__stores_begin]}" "${address[__stores_begin]}" $((base + kib * 1024))
done
