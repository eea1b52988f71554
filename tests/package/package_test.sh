#!/bin/bash
# SPDX-License-Identifier: MIT
# Proves that the Debian package is whole: package_test.sh BUILD_FOLDER makes it, installs it into a root that holds
# nothing but what it depends on, and renders there as another user, from a file system that cannot be written to: the
# bytes are those of the build's program. Also a prefix that is moved. Needs root, mmdebstrap and Debian's mirror.
set -euo pipefail
build=$(cd "$1" && pwd)
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
((EUID == 0)) || { echo 'package_test: only root can make another root'; exit 77; }
command -v mmdebstrap >/dev/null || { echo 'package_test: mmdebstrap is missing'; exit 77; }
work=$(mktemp -d)
trap 'rm -rf --one-file-system "$work"' EXIT
chmod 755 "$work"
readonly scene='cornell_box --quality draft --size 64x48 --max-shots 40 --quiet'

step() { printf -- '--- %s\n' "$*"; }
fail() { printf 'package_test: %s\n' "$*"; exit 1; }

step 'the picture of the program as built'
# shellcheck disable=SC2086
"$build/bin/torolux" render $scene --output "$work/built.exr" --stats "$work/built.json"

step 'a prefix, moved, that another user cannot write to'
cmake --install "$build" --prefix "$work/first" >/dev/null
mv "$work/first" "$work/moved"
chmod -R go-w "$work/moved"
mkdir -m 777 "$work/of_nobody"
# shellcheck disable=SC2086
(cd "$work/of_nobody" && setpriv --reuid=nobody --regid=nogroup --clear-groups env -i PATH=/usr/bin HOME=/nonexistent \
  "$work/moved/bin/torolux" render $scene --output moved.exr)
cmp "$work/built.exr" "$work/of_nobody/moved.exr" || fail 'the moved program makes another picture'
grep -rlF "$root" "$work/moved/bin" "$work/moved/share/torolux" "$work/moved/share/man" &&
  fail 'an installed file names the checkout'

step 'an image of one of nobody'"'"'s own sources, by the moved program'
cat >"$work/of_nobody/main.c" <<'SOURCE'
#include <stdio.h>
#include <torolux.h>
int main(void) {
  printf("%u of %u\n", torolux_pe(), torolux_pes());
  return 0;
}
SOURCE
readonly own_image='torolux cc main.c -o main.elf && torolux run main.elf --pes 4x4 --raw --quiet | grep -c " of 16$" | grep -qx 16'
(cd "$work/of_nobody" && setpriv --reuid=nobody --regid=nogroup --clear-groups env -i PATH="$work/moved/bin:/usr/bin" \
  HOME=/nonexistent bash -euo pipefail -c "$own_image") || fail 'the moved program makes no image'

step 'a Debian package'
(cd "$work" && cpack --config "$build/CPackConfig.cmake" -B "$work/package" >/dev/null)
package=$(echo "$work"/package/*.deb)
dpkg-deb --info "$package" | grep -E '^ (Depends|Installed-Size)'

step 'a clean root with it'
# shellcheck disable=SC1091
suite=$(. /etc/os-release && echo "$VERSION_CODENAME")
mmdebstrap --quiet --variant=apt --mode=root --include="$package,gcc-riscv64-unknown-elf" \
  --hook-dir=/usr/share/mmdebstrap/hooks/file-mirror-automount "$suite" "$work/root" >"$work/mmdebstrap.log" 2>&1 ||
  { cat "$work/mmdebstrap.log"; fail 'the package cannot be installed'; }
for file in man/man1/torolux.1 bash-completion/completions/torolux zsh/site-functions/_torolux \
  fish/vendor_completions.d/torolux.fish torolux/firmware/pe.elf torolux/kit/torolux.specs torolux/scenes/cornell_box/scene.toml; do
  [[ -r $work/root/usr/share/$file ]] || fail "the package lacks $file"
done

step 'renders there, as nobody, from a file system that cannot be written to'
cp "$work/of_nobody/main.c" "$work/root/main.c"
cat >"$work/inside.sh" <<'INSIDE'
set -euo pipefail
mount --bind "$1/root" "$1/root"
mount -o remount,ro,bind "$1/root"
mount -t tmpfs -o mode=1777 none "$1/root/tmp"
mount -t proc none "$1/root/proc"
mount --rbind /dev "$1/root/dev"
chroot --userspec=nobody:nogroup "$1/root" /usr/bin/env -i PATH=/usr/bin:/bin HOME=/tmp/home /bin/bash -euc "
  cd /tmp
  torolux | grep -q 'torolux render cornell_box'
  torolux --version
  ! touch /usr/share/torolux/x 2>/dev/null
  torolux render $2 --output box.exr --stats box.json
  torolux rerun box.json >/dev/null
  torolux render $2 --output interpreted.exr --engine interpreted --max-shots 1 --samples 1
  test -d home/.cache/torolux
  cp /main.c main.c
  $3"
cp "$1/root/tmp/box.exr" "$1/clean.exr"
INSIDE
unshare --mount --propagation private bash "$work/inside.sh" "$work" "$scene" "$own_image"
cmp "$work/built.exr" "$work/clean.exr" || fail 'the installed program makes another picture'
step 'done'
