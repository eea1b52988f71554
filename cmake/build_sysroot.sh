#!/bin/bash
# SPDX-License-Identifier: MIT
# Builds the PEs' C library (newlib), libstdc++'s headers and containers, and GLM from Debian's packages; prints where they are:
# in this checkout's build folder, so that it is complete for whoever runs it. Enters: newlib-source, gcc-12-source,
# libglm-dev, the cross compiler. Leaves: one folder, complete or not there at all, and a copy of it in the user's cache
# where there is one, from which other checkouts take theirs; two builds at once do no harm.
set -euo pipefail

target=riscv64-unknown-elf
arch=(-march=rv32imafc -mabi=ilp32f)
newlib_flags="-O2 ${arch[*]} -ffp-contract=off -ffunction-sections -fdata-sections"

newlib_archive=$(compgen -G '/usr/src/newlib/newlib-*.tar.xz' | sort | tail -n 1) ||
  { echo "build_sysroot: Debian package newlib-source is missing" >&2; exit 1; }
gcc_archive=$(compgen -G '/usr/src/gcc-12/gcc-12*.tar.xz' | sort | tail -n 1) ||
  { echo "build_sysroot: Debian package gcc-12-source is missing" >&2; exit 1; }
gcc_version=$("$target-gcc" -dumpfullversion)

key=$( { cat "${BASH_SOURCE[0]}"; echo "$gcc_version"; stat -L -c '%n %s' "$newlib_archive" "$gcc_archive" \
  /usr/include/glm/glm.hpp; } | sha256sum | cut -c 1-16)
build=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)/build
sysroot=$build/sysroot-$key
if [ -d "$sysroot" ]; then
  echo "$sysroot"
  exit 0
fi

# The user's cache, or nothing: never a folder for a home that is not there.
cache=
case ${XDG_CACHE_HOME-} in
  /*) cache=$XDG_CACHE_HOME/torolux ;;
  *) [ ! -d "${HOME-}" ] || cache=$HOME/.cache/torolux ;;
esac
kept=$cache/sysroot-$key

# put FOLDER PLACE: a copy, complete from one moment to the next. Where another was first, its result is the same.
put() {
  local staged
  mkdir -p "$(dirname "$2")" && staged=$(mktemp -d "$2.XXXXXX") || return
  if cp -r "$1/include" "$1/lib" "$1/shim" "$1/c++" "$1/glm" "$staged/" && chmod 755 "$staged"; then
    mv -T "$staged" "$2" 2>/dev/null && return
  fi
  rm -rf "$staged"
  [ -d "$2" ]
}

if [ -n "$cache" ] && [ -d "$kept" ]; then
  put "$kept" "$sysroot"
  echo "$sysroot"
  exit 0
fi

# newlib's and libstdc++'s builds do not work in a path with a space: build in one without, then copy.
work=$(mktemp -d /tmp/torolux-sysroot.XXXXXX)
trap 'rm -rf "$work"' EXIT
log=$work/log
jobs=$(nproc)
stage=$work/stage
include=$stage/$target/include

build_newlib() {
  mkdir "$work/newlib" "$work/newlib-build"
  tar -xf "$newlib_archive" -C "$work/newlib" --strip-components=1
  cd "$work/newlib-build"
  "$work/newlib/configure" --target=$target --prefix="$stage" --disable-multilib \
    --disable-newlib-supplied-syscalls --disable-nls --disable-libgloss --enable-newlib-io-long-long \
    --enable-newlib-io-c99-formats --enable-newlib-reent-small CFLAGS_FOR_TARGET="$newlib_flags -ffile-prefix-map=$work/newlib/="
  make -j"$jobs" all-target-newlib
  make install-target-newlib
}

# Headers, and the few parts of the library that containers need; no exceptions, RTTI and streams.
build_libstdcxx() {
  mkdir "$work/gcc"
  local part parts=()
  for part in libstdc++-v3 'config*' libgcc include libiberty install-sh ltmain.sh 'lt*.m4' libtool.m4 mkinstalldirs \
    missing depcomp compile move-if-change multilib.am symlink-tree gcc/BASE-VER gcc/DATESTAMP; do
    parts+=("gcc-*/$part")
  done
  tar -xf "$gcc_archive" -C "$work/gcc" --strip-components=1 --wildcards --no-wildcards-match-slash "${parts[@]}"
  mkdir "$work/libstdcxx-build"
  cd "$work/libstdcxx-build"
  # newlib has C99's math functions, but configure's test programs would have to be linked to see it.
  glibcxx_cv_c99_math_tr1=yes "$work/gcc/libstdc++-v3/configure" --host=$target --prefix="$stage" \
    --with-newlib --with-target-subdir=. --disable-multilib --enable-libstdcxx-backtrace=no --disable-libstdcxx-pch \
    --disable-libstdcxx-filesystem-ts --disable-nls --with-gxx-include-dir="$stage/c++" \
    CC="$target-gcc ${arch[*]} -isystem $include" CXX="$target-g++ ${arch[*]} -isystem $include"
  make -C include install
  make -C libsupc++ install-stdHEADERS install-bitsHEADERS
  local source=$work/gcc/libstdc++-v3 part
  for part in src/c++98/tree src/c++98/list src/c++11/hashtable_c++0x libsupc++/hash_bytes; do
    "$target-g++" -O2 "${arch[@]}" -mcmodel=medany -ffunction-sections -fdata-sections -fno-exceptions -fno-rtti \
      -isystem "$stage/c++" -isystem "$stage/c++/$target" -isystem "$include" -c "$source/$part.cc" \
      -o "$work/$(basename "$part").o"
  done
  "$target-ar" rcs "$stage/$target/lib/libstdc++.a" "$work"/{tree,list,hashtable_c++0x,hash_bytes}.o
}

# newlib does not declare the C99 functions of long double for RISC-V, but <cmath> names them. They are never called.
write_math_shim() {
  local one='acosh asinh atanh cbrt erf erfc exp2 expm1 lgamma log1p log2 logb nearbyint rint round tgamma trunc'
  local two='copysign fdim fmax fmin nextafter nexttoward remainder' name
  mkdir "$stage/shim"
  {
    echo '#pragma once'
    echo '#include_next <math.h>'
    echo '#ifdef __cplusplus'
    echo 'extern "C" {'
    for name in $one; do echo "long double ${name}l(long double);"; done
    for name in $two; do echo "long double ${name}l(long double, long double);"; done
    echo 'double nexttoward(double, long double);'
    echo 'float nexttowardf(float, long double);'
    echo 'int ilogbl(long double);'
    echo 'long long llrintl(long double);'
    echo 'long long llroundl(long double);'
    echo 'long lrintl(long double);'
    echo 'long lroundl(long double);'
    echo 'long double fmal(long double, long double, long double);'
    echo 'long double nanl(const char*);'
    echo 'long double remquol(long double, long double, int*);'
    echo 'long double scalblnl(long double, long);'
    echo 'long double scalbnl(long double, int);'
    echo '}'
    echo '#endif'
  } >"$stage/shim/math.h"
}

try_a_program() {
  printf '%s\n' '#include <algorithm>' '#include <array>' '#include <bit>' '#include <cmath>' '#include <cstdint>' \
    '#include <cstring>' '#include <limits>' '#include <span>' '#include <glm/glm.hpp>' '#include <glm/gtc/quaternion.hpp>' \
    'float f(float x) { return std::fma(std::round(x), std::log2(x), glm::dot(glm::vec3(x), glm::vec3(1, 2, 3))); }' |
    "$target-g++" "${arch[@]}" -std=c++20 -fno-exceptions -fno-rtti -isystem "$stage/c++" \
      -isystem "$stage/c++/$target" -isystem "$stage/shim" -isystem "$include" -isystem "$stage/glm" \
      -x c++ -c - -o "$work/program.o"
}

echo "Building the PEs' C library once, about a minute and a half ..." >&2
# In the background, as `set -e` does not hold inside a condition.
(
  build_newlib
  build_libstdcxx
  write_math_shim
  # Only GLM's own folder may be on the path, never the whole of /usr/include.
  mkdir "$stage/glm"
  cp -r /usr/include/glm "$stage/glm/glm"
  mv "$stage/$target/include" "$stage/include"
  mv "$stage/$target/lib" "$stage/lib"
  include=$stage/include
  try_a_program
) >"$log" 2>&1 &
if ! wait $!; then
  tail -n 30 "$log" >&2
  echo "build_sysroot: the build of newlib or of libstdc++'s headers failed" >&2
  exit 1
fi
put "$stage" "$sysroot"
[ -z "$cache" ] || put "$stage" "$kept" 2>/dev/null || true
echo "$sysroot"
