// SPDX-License-Identifier: MIT
// NAME=FILE into files; lines onto standard output and standard error.
#include "host_tools/cli/program_options.hpp"

#include <CLI/CLI.hpp>
#include <iostream>
#include <set>

#include "emulator/errors.hpp"
#include "emulator/printable.hpp"
#include "firmware/protocol/host_services.hpp"
#include "host_tools/files/write_file.hpp"

namespace torolux {
namespace {

GivenFile parse_given_file(const std::string& option, const std::string& text) {
  const std::size_t equals = text.find('=');
  const bool good =
      equals != std::string::npos && equals > 0 && equals <= protocol::kMostFileName && equals + 1 < text.size();
  if (!good) {
    throw UsageError(option + ": \"" + text + "\" is not NAME=FILE, NAME of 1 to " +
                     std::to_string(protocol::kMostFileName) + " characters");
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

void add_files(CLI::App& command, const std::string& option, std::vector<GivenFile>& files, const std::string& help) {
  const auto take = [option, &files](const std::vector<std::string>& texts) {
    for (const std::string& text : texts) files.push_back(parse_given_file(option, text));
  };
  command.add_option_function<std::vector<std::string>>(option, take, help)
      ->type_name("NAME=FILE")
      ->allow_extra_args(false);
}

std::vector<NamedFile> named(const std::string& option, const std::vector<GivenFile>& files) {
  std::vector<NamedFile> named;
  named.reserve(files.size());
  for (const GivenFile& given : files) named.push_back({option + " " + given.name, given.file});
  return named;
}

}  // namespace

void add_program_options(CLI::App& command, ProgramOptions& options) {
  command.add_option("ARGUMENTS", options.arguments, "Of the program's main: what stands behind --")->type_name("");
  add_files(command, "--input", options.inputs,
            "A file that programs may open to read, by this name; `stdin`: their standard input. May be repeated");
  add_files(
      command, "--output", options.outputs,
      "A file that programs may open to write, by this name; `host`: what they send TOROLUX_HOST. May be repeated");
  command.add_flag("--raw", options.raw, "What the PEs say without their numbers and cycles, byte for byte");
}

void check_files(const ProgramOptions& options) {
  std::set<std::string> names;
  for (const std::vector<GivenFile>* files : {&options.inputs, &options.outputs}) {
    for (const GivenFile& given : *files) {
      if (!names.insert(given.name).second)
        throw UsageError("two files have the name " + given.name + " (--input, --output): one name, one file");
    }
  }
  for (const GivenFile& given : options.outputs) check_file_writable(given.file);
}

std::vector<NamedFile> written_files(const ProgramOptions& options) {
  return named("--output", options.outputs);
}

std::vector<NamedFile> read_files(const ProgramOptions& options) {
  return named("--input", options.inputs);
}

void print_text(const PeText& text, bool raw) {
  std::ostream& stream = text.stream == PeStream::errors ? std::cerr : std::cout;
  if (raw) {
    stream << text.text << (text.ended ? "\n" : "") << std::flush;
  } else {
    stream << "PE " << text.pe << " @ " << text.time << ": " << printable(text.text) << std::endl;
  }
}

}  // namespace torolux
