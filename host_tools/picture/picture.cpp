// SPDX-License-Identifier: MIT
// A picture and a path enter; by the path's extension a file of one format leaves, or is read.
#include "host_tools/picture/picture.hpp"

#include <string>

#include "emulator/errors.hpp"
#include "emulator/nearest_name.hpp"
#include "host_tools/files/extension.hpp"
#include "host_tools/files/write_file.hpp"
#include "host_tools/picture/formats.hpp"

namespace torolux {
namespace {

constexpr std::size_t kMostFileBytes = std::size_t{1} << 32U;

void check_extension(const std::filesystem::path& file) {
  const std::string extension = small_extension(file);
  if (extension != ".png" && extension != ".exr" && extension != ".pfm")
    throw UsageError(file.string() + ": pictures end in .png, .exr or .pfm" +
                     did_you_mean(extension, {".png", ".exr", ".pfm"}));
}

}  // namespace

void check_picture_size(std::uint64_t width, std::uint64_t height, const std::string& name) {
  const std::string size = std::to_string(width) + " x " + std::to_string(height) + " pixels";
  if (width == 0 || height == 0) throw InputError(name + ": has " + size);
  if (width > kMostPictureEdge || height > kMostPictureEdge || width * height > kMostPicturePixels)
    throw InputError(name + ": " + size + " are too many; at most " + std::to_string(kMostPictureEdge) +
                     " on an edge and " + std::to_string(kMostPicturePixels) + " in all");
}

void write_picture(const Picture& picture, const std::filesystem::path& file, const ToneMapping& mapping) {
  write_layers(picture, {}, file, mapping);
}

void write_layers(const Picture& picture, std::span<const Layer> layers, const std::filesystem::path& file,
                  const ToneMapping& mapping) {
  check_extension(file);
  check_picture_size(picture.width, picture.height, file.string());
  const std::string extension = small_extension(file);
  if (extension == ".pfm") write_file(file, encode_pfm(picture));
  if (extension == ".exr") write_file(file, encode_exr(picture, layers));
  if (extension != ".png") return;
  write_file(file, encode_png(picture, mapping));
  for (const Layer& layer : layers) {
    write_file(layer_file(file, name_of(layer.plane)),
               encode_png(picture.width, picture.height, show_layer(layer, picture.width, picture.height, mapping)));
  }
}

std::filesystem::path layer_file(const std::filesystem::path& file, std::string_view layer) {
  std::filesystem::path name = file.stem();
  name += "_" + std::string(layer);
  name += file.extension();
  return file.parent_path() / name;
}

void check_layers_writable(const std::filesystem::path& file, LayerSet set) {
  check_writable(file);
  if (small_extension(file) != ".png") return;
  for (const LayerName& layer : layers_in(set)) check_file_writable(layer_file(file, layer.name));
}

bool holds_radiance(const std::filesystem::path& file) {
  const std::string extension = small_extension(file);
  return extension == ".exr" || extension == ".pfm";
}

void check_writable(const std::filesystem::path& file) {
  check_extension(file);
  check_file_writable(file);
}

Picture read_picture(const std::filesystem::path& file) {
  const std::string extension = small_extension(file);
  if (extension == ".pfm") return decode_pfm(read_file(file, kMostFileBytes), file.string());
  if (extension == ".exr") return decode_exr(read_file(file, kMostFileBytes), file.string());
  throw InputError(file.string() + ": only .pfm and .exr can be read, as they hold radiance");
}

}  // namespace torolux
