# SPDX-License-Identifier: MIT
# Set-up shared by ./torolux and ./run-tests (bash, sourced with `root` set to the checkout): packages, configure, build.
# Says nothing while there is nothing to do, else on stderr a line for each step and how far it is. Logs lie in build/.
# Whoever may not write to the checkout's build folder can run what is built there, and builds nothing.

readonly setup_failed=3  # a machine failure, as in emulator/errors.hpp: the machine cannot be built here

setup_stop() {
  printf 'torolux: %s\n' "$@" >&2
  exit "$setup_failed"
}

# setup_packages [tests]: installs what cmake/packages.txt lists and this computer lacks: all of it, or what a build needs.
setup_packages() {
  local wanted missing=() name
  mapfile -t wanted < <(awk -v which="${1-}" '/^# Only for .\/run-tests/ && which != "tests" { exit }
    !/^#/ && NF { print $1 }' "$root/cmake/packages.txt")
  command -v dpkg-query >/dev/null ||
    setup_stop 'This is not Debian. Install what these Debian packages hold, then build with the CMake presets:' "${wanted[*]}"
  local installed
  installed=$(dpkg-query -W -f='${db:Status-Status} ${Package}\n' "${wanted[@]}" 2>/dev/null || true)
  # Another package may provide it: a newer nodejs brings its own npm.
  installed+=$'\n'$(dpkg-query -W -f='${db:Status-Status}, ${Provides}\n' | awk -F ', ' '$1 == "installed" {
    for (i = 2; i <= NF; ++i) { sub(/ .*/, "", $i); print "installed " $i } }')
  for name in "${wanted[@]}"; do
    [[ $'\n'"$installed"$'\n' == *$'\n'"installed $name"$'\n'* ]] || missing+=("$name")
  done
  ((${#missing[@]} == 0)) && return

  local as_root=()
  if ((EUID != 0)); then
    if ! { command -v sudo >/dev/null && sudo -n true 2>/dev/null; }; then
      setup_stop 'Debian packages are missing. Install them with this command, then start again:' \
        "sudo apt-get install --no-install-recommends ${missing[*]}"
    fi
    as_root=(sudo -n)
  fi
  echo "torolux: installing Debian packages: ${missing[*]}" >&2
  local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y)
  setup_logged packages "${apt[@]}" install --no-install-recommends "${missing[@]}" ||
    { setup_logged packages "${apt[@]}" update &&
      setup_logged packages "${apt[@]}" install --no-install-recommends "${missing[@]}"; } ||
    setup_stop 'Debian packages could not be installed. The command was:' \
      "apt-get install --no-install-recommends ${missing[*]}" "log: $root/build/packages.log"
}

# setup_logged NAME COMMAND...: output to build/NAME.log. Does not hand the lock on.
setup_logged() {
  local log=$root/build/$1.log
  shift
  "$@" >"$log" 2>&1 </dev/null 9>&-
}

setup_logged_or_stop() {
  local name=$1
  setup_logged "$@" && return
  tail -n 40 "$root/build/$name.log" >&2
  setup_stop "This step failed: $name. The whole log: $root/build/$name.log"
}

# setup_configure PRESET FOLDER: configures where that has not been done yet, or no longer holds: a checkout that was
# moved, presets that have changed, another C library (a cache that was emptied).
setup_configure() {
  local preset=$1 folder=$2 known=$2/CMakeCache.txt sysroot=
  if ((setup_read_only)); then
    [[ -e $folder/build.ninja ]] || setup_stop_read_only
    return 0
  fi
  if [[ $preset == firmware ]]; then
    sysroot=$("$root/cmake/build_sysroot.sh" 9>&-) || setup_stop "The PEs' C library could not be built."
  fi
  if [[ -e $known ]]; then
    if ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$known" ||
      { [[ -n $sysroot ]] && ! grep -qxF "TOROLUX_SYSROOT:PATH=$sysroot" "$known"; }; then
      rm -rf "$folder"
    elif [[ -e $folder/build.ninja ]] && cmp -s "$root/CMakePresets.json" "$folder/presets-used.json"; then
      return
    fi
  fi
  echo "torolux: configuring: $preset" >&2
  setup_logged_or_stop "configure-$preset" cmake -S "$root" --preset "$preset"
  cp "$root/CMakePresets.json" "$folder/presets-used.json"
}

# setup_preset PRESET TARGET...: configures where needed, and builds the targets where they are out of date.
setup_preset() {
  local preset=$1 folder=$root/build/$1
  shift
  setup_configure "$preset" "$folder"
  if [[ $(ninja -C "$folder" -n "$@" 2>&1 9>&- | tail -n 1) == *'no work to do.' ]]; then
    return
  fi
  ((!setup_read_only)) || setup_stop_read_only
  setup_build "$preset" "$folder" "$@"
  # The table of regions of each image that was linked.
  if [[ $preset == firmware ]]; then grep -E ' (address|0x[0-9a-f]{8}) ' "$root/build/build-firmware.log" >&2 || true; fi
}

# setup_build PRESET FOLDER TARGET...: tells how far it is, and stops where it fails.
setup_build() {
  local preset=$1 folder=$2 log=$root/build/build-$1.log
  shift 2
  echo "torolux: building: $preset" >&2
  cmake --build "$folder" --target "$@" 2>&1 </dev/null 9>&- | tee "$log" | setup_tell_progress "$preset" && return
  tail -n 40 "$log" >&2
  setup_stop "This step failed: build-$preset. The whole log: $log"
}

# setup_tell_progress WHAT: Ninja's output in; on a terminal one line that is written again and again, else one line for
# each tenth. The time left is that of the steps done so far, of which there must be some.
setup_tell_progress() {
  local line done_steps steps text left tenth=0 again=0
  local begin=$SECONDS
  [[ ! -t 2 ]] || again=1
  while IFS= read -r line; do
    [[ $line =~ ^\[([0-9]+)/([0-9]+)\] ]] || continue
    done_steps=${BASH_REMATCH[1]} steps=${BASH_REMATCH[2]}
    text="torolux: building: $1: $((100 * done_steps / steps)) %, $done_steps of $steps steps"
    if ((SECONDS - begin >= 10 && done_steps < steps)); then
      left=$(((SECONDS - begin) * (steps - done_steps) / done_steps))
      ((left < 90)) && text+=", about $left s left" || text+=", about $(((left + 30) / 60)) min left"
    fi
    if ((again)); then
      printf '\r\033[K%s' "${text:0:$((${COLUMNS:-80} - 1))}" >&2
    elif ((10 * done_steps / steps > tenth)); then
      tenth=$((10 * done_steps / steps))
      printf '%s\n' "$text" >&2
    fi
  done
  ((!again)) || printf '\r\033[K' >&2
}

setup_stop_read_only() {
  local owner
  owner=$(stat -c %U "$root/build" 2>/dev/null || stat -c %U "$root")
  setup_stop "Something is to be built in $root, whose build folder belongs to $owner: you may not write to it." \
    "Let $owner run ./torolux there once, or work in a checkout of your own (cp -r $root torolux)."
}

# setup_begin [tests]: holds the lock from here on until setup_end: parallel starts build once. Packages as above.
setup_begin() {
  setup_read_only=0
  mkdir -p "$root/build" 2>/dev/null || setup_stop_read_only
  local lock=$root/build/.lock
  if [[ -w $root/build && (! -e $lock || -w $lock) ]]; then
    exec 9>"$lock"
    flock 9
  else
    setup_read_only=1
    # Waits for whoever is building there.
    if [[ -r $lock ]]; then
      exec 9<"$lock"
      flock --shared 9
    fi
  fi
  setup_packages "$@"
}

setup_end() {
  exec 9>&-
}
