#!/bin/bash
# SPDX-License-Identifier: MIT
# make_reference.sh > docs/firmware_reference.md. Enters: the headers that images include, whose comments are the page's
# text, of some one name alone; leaves: the page. Fails where a public name has no comment. tests/checks/check_reference.sh compares.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

readonly headers=(firmware/kit/include/torolux.h firmware/boot/boot.hpp firmware/niu/niu.hpp firmware/niu/memory.hpp
  firmware/protocol/niu_window.hpp firmware/protocol/hints.hpp firmware/protocol/machine.hpp
  firmware/protocol/messages.hpp:FaultCode firmware/niu/native/fake_torus.hpp)

cat <<'HEAD'
# Reference of the firmware's interfaces

Made of the headers' own comments by `cmake/make_reference.sh`: change them, not this page. How to begin is in [writing_firmware.md](writing_firmware.md).

HEAD
for entry in "${headers[@]}"; do
  IFS=: read -r header only <<<"$entry"
  awk -v header="$header" -v only="$only" '
    # Braces that a line opens, less those that it closes; what stands in comments and literals does not count.
    function depth_of(text,  open) {
      gsub(/\/\/.*|"[^"]*"|'"'.'"'/, "", text)
      open = gsub(/\{/, "", text)
      return open - gsub(/\}/, "", text)
    }
    function trimmed(text) { sub(/^[ \t]+/, "", text); sub(/[ \t]+$/, "", text); return text }
    function paragraph(text) { sub(/^(\/\*\*|\*\/|\*|\/\/\/) ?/, "", text); sub(/ *\*\/$/, "", text); return text }
    # Code, then its comment; names below one comment share it.
    function emit() {
      if (code == "") return
      if (only != "" && code !~ only) { code = comment = ""; return }
      if (comment == "") { print header ": without a comment: " code > "/dev/stderr"; failed = 1 }
      printf "```%s\n%s```\n\n%s\n\n", language, code, comment
      code = comment = ""
    }
    function take(text) { code = code text "\n" }
    BEGIN { language = header ~ /\.h$/ ? "c" : "cpp"; public = 1
            printf "## `%s`\n\n", header ~ /torolux\.h$/ ? "torolux.h" : header }
    # The head of a file: a sentence or two, which end where the code begins.
    !begun && NR > 1 && /^(\/\/|\/\*| \*)/ { text = $0; sub(/^(\/\/|\/\*| \*\/?) ?/, "", text); head = head (head == "" ? "" : " ") text; next }
    !begun && NR > 1 { begun = 1; gsub(/  +/, " ", head); print trimmed(head) "\n" }
    !begun { next }
    /^\/\* ---- .* ---- \*\/$/ { emit(); text = $0; gsub(/^\/\* -+ | -+ \*\/$/, "", text); printf "### %s\n\n", text; next }
    whole > 0 || continued { }
    # Inside of what is shown as it stands.
    whole > 0 { take(substr($0, indent + 1)); whole += depth_of($0); if (whole <= 0) whole = 0; next }
    # Inside of a function with its body.
    body > 0 { body += depth_of($0); next }
    in_comment { comment = comment " " trimmed(paragraph(trimmed($0))); if (/\*\//) in_comment = 0; next }
    /^[ \t]*(\/\/\/|\/\*\*)/ {
      if (code != "") emit()
      comment = comment (comment == "" ? "" : " ") trimmed(paragraph(trimmed($0)))
      if (/\/\*\*/ && !/\*\//) in_comment = 1
      next
    }
    /^[ \t]*$/ { if (!continued) { emit(); comment = "" } next }
    /^[ \t]*(\/\/|\/\*)/ { next }
    /^ *private:/ { emit(); public = 0; next }
    /^ *public:/ { public = 1; next }
    /^#define TOROLUX_[A-Z_]+(\(| |$)/ && !/TOROLUX_H$/ && !/_\(/ {
      text = $0; define = /\\$/
      if (comment == "" && code == "" && !/#define TOROLUX_[A-Z_0-9]+ [-0-9(]/) next
      if (/\(.*\).* /) sub(/\).*/, ")", text)
      take(trimmed(text)); continued = define; next
    }
    continued { continued = /\\$/; next }
    /^#/ || /^(extern "C" \{|using |\})/ || /^ *static_assert/ || /^namespace/ { if (/^\}/) { public = 1 } next }
    !public { if (/^};/) public = 1; next }
    # A declaration, of one line or more.
    { if (pending == "") { match($0, /^ */); indent = RLENGTH }
      pending = pending (pending == "" ? "" : "\n") substr($0, indent + 1) }
    pending ~ /^(template <[^>]*>\n)?class[^;]*\{/ { text = pending; sub(/ *\{.*/, "", text); pending = ""; take(text); emit(); next }
    pending ~ /^(class|struct) [A-Za-z]+;/ { pending = ""; next }
    pending ~ /^(struct|enum)[^;(]*\{ +\/\/\/< / || pending ~ /^enum[^;(]*\{.*\}; +\/\/\/< / {
      comment = pending; sub(/.*\/\/\/< */, "", comment); sub(/ *\/\/\/<.*/, "", pending)
    }
    pending ~ /^(struct|enum)[^;(]*\{/ { d = depth_of(pending); take(pending); pending = ""; if (d > 0) whole = d; next }
    pending ~ /^(enum)[^;(]*\{.*\};/ { take(pending); pending = ""; next }
    # A function with a body: what stands before it.
    pending ~ /^[^{]*\(.*\{/ {
      d = depth_of(pending); text = pending; pending = ""
      sub(/ *\{.*/, "", text); sub(/ : [a-z_]+\(.*/, "", text); if (text !~ /^~/) take(text ";"); body = d > 0 ? d : 0; next
    }
    pending ~ /;[ \t]*(\/\/\/<.*)?$/ && depth_of(pending) <= 0 {
      if (pending ~ /^~|= (default|delete);/) { pending = ""; next }
      if (pending ~ /\/\/\/</ && comment == "") {
        text = pending; sub(/.*\/\/\/< */, "", text); comment = text; sub(/ *\/\/\/<.*/, "", pending) }
      take(pending); pending = ""
    }
    END { emit(); if (failed) exit 1 }' "$header"
done
