# SPDX-License-Identifier: MIT
# Set-up shared by ./torolux and ./run-tests (bash, sourced with `root` set to the checkout): packages, configure, build.
# Says nothing while there is nothing to do, else a line for each step on stderr. Logs lie in build/.

readonly setup_failed=3  # a machine failure, as in emulator/errors.hpp: the machine cannot be built here

setup_stop() {
  printf 'torolux: %s\n' "$@" >&2
  exit "$setup_failed"
}

# Installs what cmake/packages.txt lists and this computer lacks.
setup_packages() {
  local wanted missing=() name
  mapfile -t wanted < <(sed -e 's/#.*//' -e '/^ *$/d' "$root/cmake/packages.txt")
  command -v dpkg-query >/dev/null ||
    setup_stop 'This is not Debian. Install what these Debian packages hold, then build with the CMake presets:' "${wanted[*]}"
  local installed
  installed=$(dpkg-query -W -f='${db:Status-Status} ${Package}\n' "${wanted[@]}" 2>/dev/null || true)
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
  echo "torolux: building: $preset" >&2
  setup_logged_or_stop "build-$preset" cmake --build "$folder" --target "$@"
  # The table of regions of each image that was linked.
  [[ $preset == firmware ]] && grep -E ' (address|0x[0-9a-f]{8}) ' "$root/build/build-firmware.log" >&2
  return 0
}

# Holds the lock from here on until setup_end: parallel starts build once.
setup_begin() {
  mkdir -p "$root/build"
  exec 9>"$root/build/.lock"
  flock 9
  setup_packages
}

setup_end() {
  exec 9>&-
}
