# SPDX-License-Identifier: MIT
# find_package(Torolux): images for the PEs, built and run in a project for this computer, without a toolchain file. The
# program lies three folders up, in bin, both in an installation and in the build (the prefix, which CMAKE_PREFIX_PATH or
# Torolux_ROOT may name); it says where the kit is.
#
#   torolux_image(NAME SOURCES FILE... [OPTIONS OPTION...] [LINK_OPTIONS OPTION...] [DEPENDS FILE...])
#       target NAME, part of all: NAME.elf in the current build folder, whose path is also in the target's property
#       TOROLUX_IMAGE. OPTIONS go to every call of `torolux cc`, LINK_OPTIONS (and files to link) to the last.
#   torolux_run(TARGET IMAGE OPTION...)
#       target TARGET: runs an image that torolux_image has made, with options of `torolux run`.
#   Torolux::torolux    the program, for add_test and custom commands
#   Torolux::native     headers with which handlers of one's own are compiled for this computer, and the fake NIU
cmake_policy(PUSH)
cmake_policy(VERSION 3.20...3.25)

get_filename_component(torolux_program "${CMAKE_CURRENT_LIST_DIR}/../../../bin/torolux" ABSOLUTE)
execute_process(
  COMMAND "${torolux_program}" cc --kit
  OUTPUT_VARIABLE torolux_kit
  ERROR_VARIABLE torolux_error
  RESULT_VARIABLE torolux_result
  OUTPUT_STRIP_TRAILING_WHITESPACE)
if(NOT torolux_result EQUAL 0)
  set(Torolux_FOUND FALSE)
  set(Torolux_NOT_FOUND_MESSAGE "${torolux_program}: ${torolux_result} ${torolux_error}")
  cmake_policy(POP)
  return()
endif()
set(Torolux_PROGRAM "${torolux_program}")
set(Torolux_KIT "${torolux_kit}")

if(NOT TARGET Torolux::torolux)
  add_executable(Torolux::torolux IMPORTED)
  set_target_properties(Torolux::torolux PROPERTIES IMPORTED_LOCATION "${Torolux_PROGRAM}")
  add_library(Torolux::native INTERFACE IMPORTED)
  target_include_directories(Torolux::native INTERFACE "${Torolux_KIT}/include" "${Torolux_KIT}/include/firmware/niu/native")
  target_sources(Torolux::native INTERFACE "${Torolux_KIT}/include/firmware/niu/native/fake_torus.cpp")
  target_compile_features(Torolux::native INTERFACE cxx_std_20)
  target_compile_options(Torolux::native INTERFACE -pthread)
  target_link_options(Torolux::native INTERFACE -pthread)
endif()

define_property(TARGET PROPERTY TOROLUX_IMAGE BRIEF_DOCS "The image that torolux_image makes")

function(torolux_image name)
  cmake_parse_arguments(arg "" "" "SOURCES;OPTIONS;LINK_OPTIONS;DEPENDS" ${ARGN})
  if(arg_UNPARSED_ARGUMENTS OR NOT arg_SOURCES)
    message(FATAL_ERROR "torolux_image(${name} SOURCES FILE... [OPTIONS ...] [LINK_OPTIONS ...] [DEPENDS ...])")
  endif()
  set(image "${CMAKE_CURRENT_BINARY_DIR}/${name}.elf")
  set(objects "")
  foreach(source IN LISTS arg_SOURCES)
    get_filename_component(file "${source}" ABSOLUTE)
    # A place of its own for each, wherever the source lies.
    string(MD5 place "${file}")
    string(SUBSTRING ${place} 0 8 place)
    get_filename_component(leaf "${file}" NAME)
    set(object "${CMAKE_CURRENT_BINARY_DIR}/${name}.dir/${leaf}.${place}.o")
    add_custom_command(
      OUTPUT "${object}"
      COMMAND "${CMAKE_COMMAND}" -E make_directory "${CMAKE_CURRENT_BINARY_DIR}/${name}.dir"
      COMMAND "${Torolux_PROGRAM}" cc ${arg_OPTIONS} -MD -MF "${object}.d" -c "${file}" -o "${object}"
      DEPENDS "${file}" "${Torolux_PROGRAM}" "${Torolux_KIT}/torolux.specs" ${arg_DEPENDS}
      DEPFILE "${object}.d"
      COMMENT "torolux cc ${leaf} (${name})"
      VERBATIM)
    list(APPEND objects "${object}")
  endforeach()
  add_custom_command(
    OUTPUT "${image}"
    COMMAND "${Torolux_PROGRAM}" cc ${arg_OPTIONS} ${objects} ${arg_LINK_OPTIONS} -o "${image}"
    DEPENDS ${objects} "${Torolux_PROGRAM}" "${Torolux_KIT}/torolux.specs" ${arg_DEPENDS}
    COMMENT "torolux cc -o ${name}.elf"
    VERBATIM)
  add_custom_target(${name} ALL DEPENDS "${image}")
  set_target_properties(${name} PROPERTIES TOROLUX_IMAGE "${image}")
endfunction()

function(torolux_run target image)
  add_custom_target(
    ${target}
    COMMAND "${Torolux_PROGRAM}" run "$<TARGET_PROPERTY:${image},TOROLUX_IMAGE>" ${ARGN}
    USES_TERMINAL VERBATIM)
  add_dependencies(${target} ${image})
endfunction()

cmake_policy(POP)
