// SPDX-License-Identifier: MIT
// What an image is made of, beside the user's own files: where it is, and the compiler's command.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace torolux {

/// The compiler for the PEs, as Debian names it and the package that it is in.
inline constexpr const char* kCompiler = "riscv64-unknown-elf-gcc";
inline constexpr const char* kCompilerPackage = "gcc-riscv64-unknown-elf";

/// The kit's folder: share/torolux/kit of the installation, else where the build put it (cmake/stage_kit.sh).
/// Throws InputError where there is none.
std::filesystem::path kit_folder();

/// The flags of some sections of the kit's pe_flags.txt, in their order. text: of the file. Comments and empty lines
/// are passed over.
std::vector<std::string> flags_of(std::string_view text, const std::vector<std::string_view>& sections);

/// Everything that `torolux cc` puts in front of the user's own words: compiler, flags, the kit's headers. What else
/// depends on a file's language, or on whether there is a link, GCC finds in the kit's torolux.specs.
/// Throws InputError where the kit cannot be read.
std::vector<std::string> compiler_words(const std::filesystem::path& kit);

}  // namespace torolux
