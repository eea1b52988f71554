#!/bin/bash
# SPDX-License-Identifier: MIT
# Proves of cmake/setup.sh: who may not write to the build folder runs what is built and is told where something is to be
# built; the C library is the checkout's, whatever HOME is; a build says how far it is. As root and as any user.
set -euo pipefail
checkout=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
work=$(mktemp -d)
trap 'chmod -R u+w "$work"; rm -rf "$work"' EXIT
status=0

# expect WHAT WANTED FOUND: WANTED is a pattern of bash.
expect() {
  # shellcheck disable=SC2053
  [[ $3 == $2 ]] && return
  printf 'check_setup: %s: wanted %s, found: %s\n' "$1" "$2" "$3"
  status=1
}

# A checkout that is built, of which nothing may be written; Ninja says there what is to be done.
mkdir -p "$work/checkout/build/native" "$work/programs"
touch "$work/checkout/build/.lock" "$work/checkout/build/native/build.ninja"
printf '#!/bin/bash\necho "$NINJA_SAYS"\n' >"$work/programs/ninja"
chmod 755 "$work" "$work/programs/ninja" "$work/programs" "$work/checkout" "$work/checkout/build/native"
chmod 444 "$work/checkout/build/.lock"
chmod 555 "$work/checkout/build"
cp "$checkout/cmake/setup.sh" "$work/setup.sh"
as_user=()
((EUID != 0)) || as_user=(setpriv --reuid 65534 --regid 65534 --clear-groups)

set_up() {
  NINJA_SAYS=$1 PATH=$work/programs:$PATH timeout 20 "${as_user[@]}" bash -c 'set -euo pipefail
    root=$1
    source "$2"
    setup_packages() { :; }
    setup_begin
    setup_preset native torolux
    setup_end
    echo runs' - "$work/checkout" "$work/setup.sh" 2>&1 && echo "code 0" || echo "code $?"
}
expect 'nothing to build' $'runs\ncode 0' "$(set_up 'ninja: no work to do.')"
expect 'something to build' '*is to be built in*belongs to*you may not write to it*code 3' "$(set_up '[1/2] Building')"

wanted=$("$checkout/cmake/build_sysroot.sh" 2>&1)
expect 'the C library' "$checkout/build/sysroot-*" "$wanted"
expect 'the C library without HOME' "$wanted" "$(timeout 20 env -u HOME "$checkout/cmake/build_sysroot.sh" 2>&1)"
expect 'the C library elsewhere at home' "$wanted" "$(HOME=$work/none timeout 20 "$checkout/cmake/build_sysroot.sh" 2>&1)"
expect 'a home that is not there' '' "$(ls -d "$work/none" 2>/dev/null)"

progress=$(bash -c 'source "$1"; for i in 1 2 3 4 5; do echo "[$i/5] Building x.o"; done 2>&1 | setup_tell_progress native' \
  - "$work/setup.sh" 2>&1)
expect 'progress' $'torolux: building: native: 20 %, 1 of 5 steps\n*100 %, 5 of 5 steps' "$progress"
exit "$status"
