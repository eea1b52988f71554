# SPDX-License-Identifier: MIT
# Toolchain of the PEs: rv32imafc, ilp32f, bare metal, newlib; no heap, exceptions or RTTI.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR riscv32)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES TOROLUX_SYSROOT)

if(NOT TOROLUX_SYSROOT)
  execute_process(
    COMMAND ${CMAKE_CURRENT_LIST_DIR}/build_sysroot.sh
    OUTPUT_VARIABLE TOROLUX_SYSROOT
    OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  set(TOROLUX_SYSROOT
      ${TOROLUX_SYSROOT}
      CACHE PATH "newlib, libstdc++'s headers and GLM for the PEs (cmake/build_sysroot.sh)")
endif()

set(CMAKE_C_COMPILER riscv64-unknown-elf-gcc)
set(CMAKE_CXX_COMPILER riscv64-unknown-elf-g++)
set(CMAKE_ASM_COMPILER riscv64-unknown-elf-gcc)

# pe_flags.txt, as words of a command line.
include(${CMAKE_CURRENT_LIST_DIR}/pe_flags.cmake)
foreach(section IN ITEMS all compiled c++ link)
  pe_flags(${section} flags)
  list(JOIN flags " " torolux_${section})
endforeach()
string(REPLACE "--" "-Wl,--" torolux_link "${torolux_link}")
set(CMAKE_ASM_FLAGS_INIT "${torolux_all}")
set(CMAKE_C_FLAGS_INIT "${torolux_all} ${torolux_compiled}")
set(CMAKE_CXX_FLAGS_INIT "${torolux_all} ${torolux_compiled} ${torolux_c++}")
set(CMAKE_C_FLAGS_RELEASE
    "-O2 -DNDEBUG"
    CACHE STRING "Optimisation of the images")
set(CMAKE_CXX_FLAGS_RELEASE
    "-O2 -DNDEBUG"
    CACHE STRING "Optimisation of the images")

set(CMAKE_C_STANDARD_INCLUDE_DIRECTORIES ${TOROLUX_SYSROOT}/include)
set(CMAKE_CXX_STANDARD_INCLUDE_DIRECTORIES
    ${TOROLUX_SYSROOT}/c++ ${TOROLUX_SYSROOT}/c++/riscv64-unknown-elf ${TOROLUX_SYSROOT}/shim
    ${TOROLUX_SYSROOT}/include ${TOROLUX_SYSROOT}/glm)
set(CMAKE_EXE_LINKER_FLAGS_INIT "-nostdlib -Wl,--fatal-warnings ${torolux_link}")

set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
