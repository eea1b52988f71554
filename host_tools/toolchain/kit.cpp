// SPDX-License-Identifier: MIT
// The program's own place enters, the compiler's words leave.
#include "host_tools/toolchain/kit.hpp"

#include <algorithm>
#include <cstddef>

#include "emulator/errors.hpp"
#include "emulator/installed_file.hpp"
#include "host_tools/files/write_file.hpp"

namespace torolux {
namespace {

constexpr std::size_t kMostBytesOfFlags = 65536;

}  // namespace

std::filesystem::path kit_folder() {
  const std::filesystem::path specs =
      installed_file("share/torolux/kit/torolux.specs", "../../firmware/kit/torolux.specs");
  std::error_code error;
  if (!std::filesystem::is_regular_file(specs, error))
    throw InputError(specs.parent_path().string() +
                     ": there is no kit to make images of; build it (./torolux does, or cmake --build --preset "
                     "firmware), or install Torolux anew");
  return specs.parent_path();
}

std::vector<std::string> flags_of(std::string_view text, const std::vector<std::string_view>& sections) {
  std::vector<std::string> flags;
  bool wanted = false;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.starts_with('[') && line.ends_with(']'))
      wanted = std::ranges::find(sections, line.substr(1, line.size() - 2)) != sections.end();
    else if (wanted && line.starts_with('-'))
      flags.emplace_back(line);
  }
  return flags;
}

std::vector<std::string> compiler_words(const std::filesystem::path& kit) {
  const std::vector<std::byte> bytes = read_file(kit / "pe_flags.txt", kMostBytesOfFlags);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  std::vector<std::string> words = {kCompiler};
  const std::vector<std::string> flags = flags_of(text, {"all", "compiled", "defaults"});
  words.insert(words.end(), flags.begin(), flags.end());
  const std::string folder = kit.string();
  words.insert(words.end(),
               {"--sysroot=" + folder, "-specs=" + folder + "/torolux.specs", "-isystem", folder + "/include",
                "-isystem", folder + "/include/firmware/niu/riscv", "-idirafter", folder + "/libc/include"});
  return words;
}

}  // namespace torolux
