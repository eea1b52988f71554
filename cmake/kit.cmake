# SPDX-License-Identifier: MIT
# Target kit: what an image of one's own is made of, in one folder that may be moved: headers, libraries, linker script,
# flags. `torolux cc` takes it from the build, or from share/torolux/kit of an installation.
include(${PROJECT_SOURCE_DIR}/cmake/pe_flags.cmake)
pe_flags(c++ flags)
set(cxx "")
foreach(flag IN LISTS flags)
  # Unless the user asks for the opposite.
  if(flag MATCHES "^-fno-(.*)")
    set(flag "%{!f${CMAKE_MATCH_1}:${flag}}")
  endif()
  string(APPEND cxx " ${flag}")
endforeach()
pe_flags(link link)
list(JOIN link " " link)
set(libraries "-ltorolux -ltorolux_boot -lstdc++ -lm -lc")
configure_file(${PROJECT_SOURCE_DIR}/cmake/torolux.specs.in ${PROJECT_BINARY_DIR}/torolux.specs @ONLY)

# An archive, so that an image with a start of its own leaves it out.
add_library(torolux_boot_archive STATIC $<TARGET_OBJECTS:torolux_boot>)
set_target_properties(torolux_boot_archive PROPERTIES OUTPUT_NAME torolux_boot LINKER_LANGUAGE CXX)

set(kit ${PROJECT_BINARY_DIR}/kit)
add_custom_command(
  OUTPUT ${kit}/torolux.specs
  COMMAND ${PROJECT_SOURCE_DIR}/cmake/stage_kit.sh ${kit} ${PROJECT_BINARY_DIR}/torolux.specs ${TOROLUX_SYSROOT}
          $<TARGET_FILE:torolux_boot_archive> $<TARGET_FILE:torolux_kit>
  DEPENDS ${PROJECT_BINARY_DIR}/torolux.specs
          ${PROJECT_SOURCE_DIR}/cmake/pe_flags.txt
          ${PROJECT_SOURCE_DIR}/cmake/print_regions.sh
          ${PROJECT_SOURCE_DIR}/cmake/stage_kit.sh
          ${PROJECT_SOURCE_DIR}/cmake/torolux.mk
          ${PROJECT_SOURCE_DIR}/linker/pe.ld
          torolux_boot_archive
          torolux_kit
  DEPFILE ${kit}.d  # the headers; a glob would be looked through at each build, and at each call of torolux
  VERBATIM)
add_custom_target(kit ALL DEPENDS ${kit}/torolux.specs)
