# SPDX-License-Identifier: MIT
# Makes a C++ source that holds other files' text: cmake -DOUTPUT=.. -DROOT=.. -DFILES="a|b" -P embed.cmake
set(text "// SPDX-License-Identifier: MIT\n// Made by embed.cmake: headers that translated code is compiled with.\n")
string(APPEND text "#include \"emulator/engines/translated/generate/semantics_text.hpp\"\n\n")
string(APPEND text "namespace torolux::translated {\n\nstd::vector<SourceText> semantics_texts() {\n  return {\n")
string(REPLACE "|" ";" FILES "${FILES}")
foreach(file IN LISTS FILES)
  file(READ "${ROOT}/${file}" contents)
  string(APPEND text "      {\"${file}\", R\"embedded(${contents})embedded\"},\n")
endforeach()
string(APPEND text "  };\n}\n\n}  // namespace torolux::translated\n")
file(WRITE "${OUTPUT}" "${text}")
