// SPDX-License-Identifier: MIT
// `torolux cc SOURCES... -o IMAGE.elf`: a compiler's command line enters; an image for the PEs leaves, or whatever else
// the compiler was asked for.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "emulator/errors.hpp"
#include "host_tools/cli/command.hpp"
#include "host_tools/cli/named_value.hpp"
#include "host_tools/cli/parse_values.hpp"
#include "host_tools/files/shell_line.hpp"
#include "host_tools/report/version.hpp"
#include "host_tools/toolchain/compiler_process.hpp"
#include "host_tools/toolchain/kit.hpp"
#include "host_tools/toolchain/link_advice.hpp"

namespace torolux {
namespace {

using Words = std::vector<std::string>;

constexpr std::uint64_t kLeastStack = 4096;
constexpr std::uint64_t kMostStack = 16U << 20U;
constexpr const char* kImageByDefault = "a.elf";

/// Our own options; all else is the compiler's.
struct Asked {
  bool print = false, regions = false, version = false, help = false, makefile = false, kit = false;
  std::optional<std::uint64_t> stack;
  Words compiler;
  std::string output = kImageByDefault;
};

std::uint64_t stack_bytes(const std::string& text) {
  const std::uint64_t bytes = value_of(
      "--stack", [](const std::string& value) { return parse_file_size(value, kLeastStack, kMostStack); }, text);
  if (bytes % kLeastStack != 0) throw InputError("--stack: whole pages of 4 KiB, like 16K");
  return bytes;
}

/// Words that follow one of these belong to it, whatever they look like.
bool takes_the_next(std::string_view word) {
  constexpr auto kWords = std::to_array<std::string_view>(
      {"-Xlinker", "-Xassembler", "-Xpreprocessor", "-MF", "-MT", "-MQ", "-include", "-imacros", "-D", "-U", "-I"});
  return std::ranges::find(kWords, word) != kWords.end();
}

/// True where the word is one of our flags.
bool take_flag(const std::string& word, Asked& asked) {
  struct Flag {
    std::string_view name;
    bool Asked::*value;
  };
  constexpr auto kFlags = std::to_array<Flag>({{"--print", &Asked::print},
                                               {"--regions", &Asked::regions},
                                               {"--version", &Asked::version},
                                               {"--help", &Asked::help},
                                               {"--makefile", &Asked::makefile},
                                               {"--kit", &Asked::kit}});
  const auto* const flag = std::ranges::find(kFlags, word, &Flag::name);
  if (flag == kFlags.end()) return false;
  asked.*flag->value = true;
  return true;
}

Asked parse(const Words& words) {
  Asked asked;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (take_flag(word, asked)) continue;
    if (word == "--stack") {
      if (++i == words.size()) throw UsageError("--stack: a size is missing, like 16K");
      asked.stack = stack_bytes(words[i]);
    } else if (word.starts_with("--stack=")) {
      asked.stack = stack_bytes(word.substr(std::string_view("--stack=").size()));
    } else {
      asked.compiler.push_back(word);
      const bool is_output = word == "-o";
      if (!is_output && word.starts_with("-o")) asked.output = word.substr(2);
      if (!(is_output || takes_the_next(word)) || i + 1 == words.size()) continue;
      asked.compiler.push_back(words[++i]);
      if (is_output) asked.output = words[i];
    }
  }
  return asked;
}

Words command_of(const Asked& asked, const std::filesystem::path& kit) {
  Words command = compiler_words(kit);
  if (asked.stack) command.push_back("-Wl,--defsym=torolux_stack_bytes=" + std::to_string(*asked.stack));
  command.insert(command.end(), asked.compiler.begin(), asked.compiler.end());
  return command;
}

int run(Words command) {
  // The compiler writes to a pipe, but somebody may read it.
  if (::isatty(STDERR_FILENO) != 0) command.insert(command.begin() + 1, "-fdiagnostics-color=always");
  const CompilerEnd end = run_compiler(command, kCompilerPackage);
  if (end.exit_code > 128)
    throw MachineFailure(command[0] + " was ended by signal " + std::to_string(end.exit_code - 128));
  if (end.exit_code == 0) return 0;
  for (const std::string& advice : link_advice(end.errors)) std::cerr << "torolux: " << advice << "\n";
  return static_cast<int>(ExitCode::bad_input);
}

}  // namespace

std::optional<int> run_cc_command(const Words& words) {
  const Asked asked = parse(words);
  if (asked.help) return std::nullopt;
  const std::filesystem::path kit = kit_folder();
  if (asked.makefile || asked.kit) {
    std::cout << (asked.kit ? kit : kit / "torolux.mk").string() << "\n";
    return 0;
  }
  if (asked.version) {
    std::cout << "torolux cc " << kVersion << std::endl;
    return run({kCompiler, "--version"});
  }
  if (asked.compiler.empty()) throw UsageError("nothing to compile: torolux cc SOURCES... -o IMAGE.elf");
  const Words command = command_of(asked, kit);
  if (asked.print) {
    std::cout << shell_line(command) << "\n";
    return 0;
  }
  const int code = run(command);
  if (code != 0 || !asked.regions) return code;
  return run({(kit / "print_regions.sh").string(), asked.output});
}

void add_cc_command(CLI::App& app, CommandAction& action) {
  CLI::App* command = app.add_subcommand("cc", "Compile and link an image of one's own: C, C++ and assembler");
  // For help, manual page and completions; what is typed never comes here (run_cc_command).
  command->add_option("SOURCES", "Files and options as riscv64-unknown-elf-gcc takes them, all of them")->type_name("");
  command->add_option("-o", "The image, or with -c, -S or -E another file")
      ->type_name("FILE")
      ->default_str(kImageByDefault);
  command->add_option("--stack", "The stack's bytes, K = 1024, M = 1024 K; whole 4 KiB, 4K to 16M")
      ->type_name("SIZE")
      ->default_str("16K");
  command->add_flag("--regions")->description("Tell how much of each region of local memory the image takes");
  command->add_flag("--print")->description("Show the compiler's command, and run nothing");
  command->add_flag("--makefile")->description("Where the rules for make are: include $(shell torolux cc --makefile)");
  command->add_flag("--kit")->description("Where headers, libraries and linker script are");
  command->add_flag("--version")->description("Of Torolux and of the compiler");
  command->footer(
      "Whatever else is given goes to the compiler as it is, behind -O2 -g and the flags of the PEs; its own help is "
      "--help=common and the like. Exit codes: 0 done, 1 usage, 2 the compiler found errors.");
  command->callback([&action] { action = [] { return 0; }; });
}

}  // namespace torolux
