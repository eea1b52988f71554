// SPDX-License-Identifier: MIT
// LIST=FILE into a file for each PE.
#include "host_tools/cli/image_options.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <set>

#include "emulator/errors.hpp"
#include "host_tools/cli/parse_values.hpp"
#include "host_tools/cli/table_options.hpp"
#include "host_tools/report/text.hpp"

namespace torolux {
namespace {

namespace fs = std::filesystem;

ImageOptions::OfPes parse_image(const std::string& text) {
  const std::size_t sign = text.find('=');
  if (sign == std::string::npos || sign + 1 == text.size()) {
    throw UsageError("\"" + text + "\" is not of the form LIST=FILE, like 0-3=a.elf");
  }
  return {parse_pe_list(text.substr(0, sign)), text.substr(sign + 1)};
}

/// Numbers the files, each once.
class Files {
 public:
  std::uint32_t number_of(const std::string& path) {
    std::error_code error;
    fs::path real = fs::canonical(path, error);
    if (error) real = path;  // whoever reads it says what is wrong
    for (std::uint32_t i = 0; i < real_.size(); ++i) {
      if (real_[i] == real) return i;
    }
    real_.push_back(std::move(real));
    files_.push_back({"image", path, sha256_of_file(path)});
    return static_cast<std::uint32_t>(files_.size() - 1);
  }
  std::vector<InputFile>& all() { return files_; }

 private:
  std::vector<fs::path> real_;
  std::vector<InputFile> files_;
};

void check_all_have_one(const std::vector<std::optional<std::uint32_t>>& file_of_pe) {
  std::vector<unsigned> without;
  for (unsigned pe = 0; pe < file_of_pe.size(); ++pe) {
    if (!file_of_pe[pe]) without.push_back(pe);
  }
  if (without.empty()) return;
  const std::string list = ranges(without);
  throw UsageError((without.size() == 1 ? "PE " : "PEs ") + list + ": no image. Name one for them, --image " + list +
                   "=FILE, or one for all that have none, IMAGE");
}

}  // namespace

void add_image_options(CLI::App& command, ImageOptions& options) {
  command.add_option("IMAGE", options.others, "A firmware image (ELF for rv32imafc); see docs/writing_firmware.md")
      ->type_name("");
  add_values(command, "--image", "LIST=FILE",
             "The image of these PEs, like 0-3,7=a.elf; IMAGE, if it is given, is for all others. May be repeated", "",
             [&options](const std::string& text) { options.of_pes.push_back(parse_image(text)); });
}

bool names_each_pe(const ImageOptions& options, unsigned pes) {
  std::set<unsigned> named;
  for (const ImageOptions::OfPes& given : options.of_pes) named.insert(given.pes.begin(), given.pes.end());
  return named.size() >= pes;
}

RunImages images_of(const ImageOptions& options, unsigned pes) {
  if (options.others.empty() && options.of_pes.empty()) {
    throw UsageError("IMAGE is missing: name a firmware image, or --image LIST=FILE for each PE");
  }
  Files files;
  std::vector<std::optional<std::uint32_t>> file_of_pe(pes);
  for (const ImageOptions::OfPes& given : options.of_pes) {
    if (given.pes.back() >= pes) {
      throw InputError("--image: there is no PE " + std::to_string(given.pes.back()) + "; the machine has 0 to " +
                       std::to_string(pes - 1));
    }
    const std::uint32_t file = files.number_of(given.file);
    for (const unsigned pe : given.pes) {
      if (file_of_pe[pe]) throw UsageError("--image: PE " + std::to_string(pe) + " has two images: one is allowed");
      file_of_pe[pe] = file;
    }
  }
  for (auto& file : file_of_pe) {
    if (!file && !options.others.empty()) file = files.number_of(options.others);
  }
  check_all_have_one(file_of_pe);
  RunImages images;
  images.files = std::move(files.all());
  if (images.files.size() > 1) {
    for (const auto& file : file_of_pe) images.file_of_pe.push_back(*file);
  }
  return images;
}

ImageSet load_images(const RunImages& images) {
  std::vector<Image> loaded;
  for (const InputFile& file : images.files) loaded.push_back(load_image(file.path));
  return {std::move(loaded), images.file_of_pe};
}

}  // namespace torolux
