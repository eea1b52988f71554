# SPDX-License-Identifier: MIT
# torolux_image(name SOURCES ... [LIBRARIES ...]): an image for the PEs, bin/name.elf. One of the sources defines
# torolux::pe::pe_main (firmware/boot/boot.hpp), or main, with the library torolux_kit. The build prints the image's table of regions.
function(torolux_image name)
  cmake_parse_arguments(arg "" "" "SOURCES;LIBRARIES" ${ARGN})
  set(script ${PROJECT_SOURCE_DIR}/linker/pe.ld)
  set(table ${PROJECT_SOURCE_DIR}/cmake/print_regions.sh)
  add_executable(${name} ${arg_SOURCES})
  set_target_properties(${name} PROPERTIES SUFFIX .elf RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin LINK_DEPENDS
                                                                                                   "${script};${table}")
  target_link_libraries(${name} PRIVATE torolux_warnings torolux_boot ${arg_LIBRARIES} stdc++ m c gcc)
  target_link_directories(${name} PRIVATE ${TOROLUX_SYSROOT}/lib)
  target_link_options(${name} PRIVATE -T ${script} -Wl,-Map=${PROJECT_BINARY_DIR}/bin/${name}.map)
  add_custom_command(
    TARGET ${name}
    POST_BUILD
    COMMAND ${table} $<TARGET_FILE:${name}>
    VERBATIM)
endfunction()
