#!/bin/bash
# SPDX-License-Identifier: MIT
# Holds the reader of glTF to Khronos's validator: check_gltf.sh TOROLUX WRITE_GLB FOLDER. What the validator finds no error
# in is read, or refused for an extension that it requires or for having no surfaces; whatever it finds, the exit code is 0
# or 2. The box that tests write has no errors. Exit code 77 (skipped): packages cannot be had.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
torolux=$1 write_glb=$2 folder=$(realpath -m "$3")
MODULES=$("$root/host_tools/web/modules.sh")
export MODULES
models=/usr/share/assimp/models
[[ -d $models ]] || { echo 'the Debian package assimp-testmodels is not installed'; exit 77; }
mkdir -p "$folder"
status=0
complain() { echo "$1" >&2; status=1; }

"$write_glb" "$root/scenes/cornell_box" "$folder/cornell_box.glb"
[[ $(node "$root/tests/gltf/validate.mjs" "$folder/cornell_box.glb") == 0\ * ]] || complain 'the box that tests write has errors'

valid=0 broken=0
while read -r errors file; do
  code=0
  told=$("$torolux" info "$file" 2>&1 >/dev/null) || code=$?
  if ((errors > 0)); then
    broken=$((broken + 1))
    ((code == 0 || code == 2)) || complain "$file has $errors errors; exit code $code: $told"
  else
    valid=$((valid + 1))
    ((code == 0)) || [[ $code == 2 && $told =~ (requires|'nothing to render') ]] ||
      complain "$file has no errors; exit code $code: $told"
  fi
done < <(find "$models" \( -name '*.gltf' -o -name '*.glb' \) -print0 | sort -z | xargs -0 node "$root/tests/gltf/validate.mjs")
echo "$valid without errors, $broken with"
((valid > 20 && broken > 10)) || complain 'too few models to say anything'
exit "$status"
