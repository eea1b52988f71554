# SPDX-License-Identifier: MIT
# What `cmake --install build/native --prefix PREFIX` puts where, and the Debian package that cpack makes of it. The program
# finds the rest from its own place (emulator/installed_file.hpp), so a prefix may be moved. Target `installed`: all that
# is needed; the images are those of preset firmware.
set(manual ${PROJECT_BINARY_DIR}/manual)
add_custom_command(
  OUTPUT ${manual}/torolux.1 ${manual}/torolux.bash ${manual}/_torolux ${manual}/torolux.fish
  COMMAND ${CMAKE_COMMAND} -E make_directory ${manual}
  COMMAND torolux manual ${manual}
  DEPENDS torolux
  VERBATIM)
add_custom_target(manual ALL DEPENDS ${manual}/torolux.1)
add_custom_target(installed DEPENDS manual torolux torolux_qemu_plugin)

file(STRINGS ${PROJECT_SOURCE_DIR}/host_tools/report/version.hpp version REGEX "kVersion = ")
string(REGEX REPLACE ".*\"(.*)\".*" "\\1" version "${version}")
set(torolux_package ${PROJECT_BINARY_DIR}/lib/cmake/Torolux)
configure_file(${PROJECT_SOURCE_DIR}/cmake/ToroluxConfig.cmake ${torolux_package}/ToroluxConfig.cmake COPYONLY)
include(CMakePackageConfigHelpers)
write_basic_package_version_file(
  ${torolux_package}/ToroluxConfigVersion.cmake
  VERSION ${version}
  COMPATIBILITY SameMinorVersion)

set(firmware ${PROJECT_SOURCE_DIR}/build/firmware/bin)
install(CODE "if(NOT EXISTS \"${firmware}/pe.elf\")
  message(FATAL_ERROR \"${firmware}/pe.elf is missing: cmake --preset firmware && cmake --build --preset firmware\")
endif()")
# Nothing of the place where it was built, nor of the user who builds it.
set(CMAKE_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ
                                                WORLD_EXECUTE)
set(readable OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
install(TARGETS torolux RUNTIME DESTINATION bin)
install(TARGETS torolux_qemu_plugin LIBRARY DESTINATION lib/torolux PERMISSIONS ${readable})
install(
  DIRECTORY ${firmware}/
  DESTINATION share/torolux/firmware
  FILE_PERMISSIONS ${readable}
  FILES_MATCHING
  PATTERN "*.elf"
  PATTERN "calls.elf" EXCLUDE
  PATTERN "faults.elf" EXCLUDE
  PATTERN "jumps.elf" EXCLUDE)
# What images of one's own are made of, and the CMake package, whose place in the build is like that in the prefix.
install(
  DIRECTORY ${PROJECT_SOURCE_DIR}/build/firmware/kit
  DESTINATION share/torolux
  FILE_PERMISSIONS ${readable}
  PATTERN "*.sh" PERMISSIONS ${readable} OWNER_EXECUTE GROUP_EXECUTE WORLD_EXECUTE)
install(DIRECTORY ${torolux_package}/ DESTINATION lib/cmake/Torolux FILE_PERMISSIONS ${readable})
install(
  DIRECTORY ${PROJECT_SOURCE_DIR}/scenes
  DESTINATION share/torolux
  FILE_PERMISSIONS ${readable}
  PATTERN "tools" EXCLUDE
  PATTERN "CMakeLists.txt" EXCLUDE)
install(
  DIRECTORY ${PROJECT_SOURCE_DIR}/docs/
  DESTINATION share/doc/torolux
  FILE_PERMISSIONS ${readable})
install(
  FILES ${PROJECT_SOURCE_DIR}/CHANGELOG.md
  DESTINATION share/doc/torolux
  PERMISSIONS ${readable})
install(
  FILES ${PROJECT_SOURCE_DIR}/LICENSE
  DESTINATION share/doc/torolux
  RENAME copyright
  PERMISSIONS ${readable})
install(FILES ${manual}/torolux.1 DESTINATION share/man/man1)
install(
  FILES ${manual}/torolux.bash
  DESTINATION share/bash-completion/completions
  RENAME torolux)
install(FILES ${manual}/_torolux DESTINATION share/zsh/site-functions)
install(FILES ${manual}/torolux.fish DESTINATION share/fish/vendor_completions.d)

# The package: `cpack --config build/native/CPackConfig.cmake`. Libraries are found by dpkg-shlibdeps; g++ translates.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME torolux)
set(CPACK_PACKAGE_VERSION ${version})
set(CPACK_PACKAGE_CONTACT "The Torolux authors <torolux@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "massively parallel machine for image synthesis, emulated")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS g++)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "gnuplot-nox, gcc-riscv64-unknown-elf")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "qemu-system-misc, binutils-riscv64-unknown-elf")
set(CPACK_VERBATIM_VARIABLES ON)
include(CPack)
