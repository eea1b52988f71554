# SPDX-License-Identifier: MIT
# Files enter, a C++ source that holds their bytes leaves: cmake -D FOLDER=bundle -D OUTPUT=bundle.cpp -P embed.cmake
set(text "// Made by host_tools/web/embed.cmake.\n#include \"host_tools/web/bundle.hpp\"\n\nnamespace torolux {\nnamespace {\n")
set(functions "")
foreach(pair IN ITEMS report_script:report.js report_style:report.css display_script:display.js display_style:display.css)
  string(REPLACE ":" ";" pair ${pair})
  list(GET pair 0 name)
  list(GET pair 1 file)
  file(READ ${FOLDER}/${file} bytes HEX)
  string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
  # Lines of 32 bytes.
  string(REGEX REPLACE "(................................................................................................................................................................)" "\\1\n" bytes "${bytes}")
  string(APPEND text "constexpr unsigned char k_${name}[] = {\n${bytes}\n};\n")
  string(APPEND functions "std::string_view ${name}() {\n  return {reinterpret_cast<const char*>(k_${name}), sizeof k_${name}};\n}\n")
endforeach()
file(WRITE ${OUTPUT} "${text}}  // namespace\n\n${functions}}  // namespace torolux\n")
