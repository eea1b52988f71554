#!/bin/bash
# SPDX-License-Identifier: MIT
# stage_kit.sh KIT SPECS SYSROOT ARCHIVE...: puts the kit together, from one moment to the next, without a path of this
# computer in it. Enters: GCC's specs, the PEs' C library, our archives, and from the checkout headers and linker script.
# Beside it lies KIT.d, which names for ninja what was copied of the sources.
set -euo pipefail
kit=$1 specs=$2 sysroot=$3
shift 3
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
staged=$kit.new
rm -rf "$staged"
mkdir -p "$staged/include" "$staged/lib" "$staged/libc"
cp -r "$sysroot"/{c++,glm,include,lib,shim} "$staged/libc/"
cp "$@" "$staged/lib/"
# libtorolux.a has these; whichever the linker meets first must be the only one.
riscv64-unknown-elf-ar d "$staged/libc/lib/libc.a" lib_a-{abort,assert,calloc,malign,malloc,realloc}.o
rm -f "$staged/libc/lib/libg.a"  # another name of libc.a
riscv64-unknown-elf-strip --strip-debug "$staged"/libc/lib/*.a  # lines of a folder that is gone
cp "$root/firmware/kit/include/torolux.h" "$staged/include/"
cd "$root"
sources=(firmware/{boot,examples,niu,protocol}/*.hpp firmware/niu/*/platform/*.hpp firmware/niu/native/fake_torus.?pp)
cp --parents "${sources[@]}" "$staged/include/"
{
  printf '%s:' "${kit// /\\ }/torolux.specs"
  for source in "${sources[@]}" firmware/kit/include/torolux.h; do printf ' \\\n  %s' "${root// /\\ }/$source"; done
  echo
} >"$kit.d"
cp "$root/linker/pe.ld" "$root/cmake/pe_flags.txt" "$root/cmake/print_regions.sh" "$root/cmake/torolux.mk" "$staged/"
chmod -R u+w,go+rX "$staged"
# Last of all, so that what is newer than this file is not in the kit yet.
cp "$specs" "$staged/torolux.specs"
rm -rf "$kit"
mv -T "$staged" "$kit"
