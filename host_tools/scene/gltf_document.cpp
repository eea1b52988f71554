// SPDX-License-Identifier: MIT
// Takes a .glb apart, parses the JSON, and refuses what the rest of it cannot be understood without.
#include "host_tools/scene/gltf_document.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

#include "host_tools/scene/statements.hpp"

namespace torolux {
namespace {

/// Of brackets in brackets: glTF's own need some ten, and what copies a value calls itself for each.
constexpr std::size_t kMostDepth = 100;

constexpr std::array<std::string_view, 20> kUnderstood{"EXT_mesh_gpu_instancing",
                                                       "KHR_lights_punctual",
                                                       "KHR_materials_anisotropy",
                                                       "KHR_materials_clearcoat",
                                                       "KHR_materials_diffuse_transmission",
                                                       "KHR_materials_dispersion",
                                                       "KHR_materials_emissive_strength",
                                                       "KHR_materials_ior",
                                                       "KHR_materials_iridescence",
                                                       "KHR_materials_pbrSpecularGlossiness",
                                                       "KHR_materials_sheen",
                                                       "KHR_materials_specular",
                                                       "KHR_materials_transmission",
                                                       "KHR_materials_unlit",
                                                       "KHR_materials_variants",
                                                       "KHR_materials_volume",
                                                       "KHR_mesh_quantization",
                                                       "KHR_texture_transform",
                                                       "KHR_xmp_json_ld",
                                                       "KHR_animation_pointer"};

/// What takes an extension out of a file.
struct Remedy {
  std::string_view extension, command;
};
constexpr std::array<Remedy, 5> kRemedies{
    Remedy{"KHR_draco_mesh_compression", "gltf-transform copy IN OUT (npm: @gltf-transform/cli) unpacks it"},
    Remedy{"EXT_meshopt_compression", "gltf-transform copy IN OUT (npm: @gltf-transform/cli) unpacks it"},
    Remedy{"KHR_meshopt_compression", "gltf-transform copy IN OUT (npm: @gltf-transform/cli) unpacks it"},
    Remedy{"KHR_texture_basisu", "gltf-transform ktxdecompress IN OUT (npm: @gltf-transform/cli) turns it into PNG"},
    Remedy{"EXT_texture_webp", "gltf-transform png IN OUT (npm: @gltf-transform/cli) turns it into PNG"}};

[[noreturn]] void damaged(const std::string& file, const std::string& why) {
  refuse({file}, "is not a whole .glb: " + why + "; export it again");
}

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t i = 4; i > 0; --i)
    word = word << 8U | static_cast<std::uint8_t>(bytes[at + i - 1]);  // little endian
  return word;
}

/// The text of the JSON; the binary chunk into `binary`.
std::string take_apart(std::string_view bytes, const std::string& file, std::string& binary, Notices& notices) {
  constexpr std::uint32_t json_type = 0x4E4F534A;
  constexpr std::uint32_t binary_type = 0x004E4942;
  if (bytes.size() < 20) damaged(file, "it has " + std::to_string(bytes.size()) + " bytes, its header needs 20");
  if (word_at(bytes, 4) != 2)
    refuse({file}, "is glTF of version " + std::to_string(word_at(bytes, 4)) +
                       "; 2 is read: gltf-pipeline -i IN -o OUT (npm: gltf-pipeline) converts it");
  std::size_t end = word_at(bytes, 8);
  if (end > bytes.size())
    damaged(file, "its header tells of " + std::to_string(end) + " bytes, it has " + std::to_string(bytes.size()));
  if (end < bytes.size()) notices.note("bytes behind the end of the .glb are not read", {file});
  std::string text;
  std::size_t number = 0;
  for (std::size_t at = 12; at + 8 <= end; ++number) {
    const std::uint64_t length = word_at(bytes, at);
    const std::uint32_t type = word_at(bytes, at + 4);
    at += 8;
    if (length > end - at) damaged(file, "chunk " + std::to_string(number) + " reaches beyond the end");
    if ((number == 0) != (type == json_type)) damaged(file, "its first chunk, and no other, must be JSON");
    if (number == 0) text = bytes.substr(at, length);
    if (number == 1 && type == binary_type) binary = bytes.substr(at, length);
    at += length;
  }
  return text;
}

void check_depth(std::string_view text, const std::string& file) {
  std::size_t depth = 0;
  bool in_text = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_text) {
      if (c == '\\') ++i;
      in_text = c != '"';
    } else if (c == '"') {
      in_text = true;
    } else if (c == '[' || c == '{') {
      if (++depth > kMostDepth)
        refuse({file}, "its JSON has more than " + std::to_string(kMostDepth) + " brackets within each other");
    } else if ((c == ']' || c == '}') && depth > 0) {
      --depth;
    }
  }
}

/// A text; early files of version 1 have a number.
std::string version_of(const nlohmann::json& json) {
  const auto asset = json.find("asset");
  if (asset == json.end() || !asset->is_object()) return "";
  const auto version = asset->find("version");
  if (version == asset->end()) return "";
  return version->is_string() ? version->get<std::string>() : version->dump();
}

void check_version(const GltfObject& root, const std::string& version) {
  if (version.starts_with("2.") || version == "2") return;
  if (version.starts_with("1") || root.has("techniques") || root.has("programs"))
    refuse(root.place(),
           "is glTF of version 1; 2 is read: gltf-pipeline -i IN -o OUT (npm: gltf-pipeline) converts it");
  if (version.empty()) refuse(root.place(), "has no 'asset' with a 'version': it is not glTF 2.0");
  refuse(root.place(), "is glTF of version " + in_quotes(version) + "; 2 is read");
}

void check_extensions(const GltfObject& root, Notices& notices) {
  for (const std::string& name : root.texts("extensionsRequired")) {
    const auto remedy = std::ranges::find(kRemedies, name, &Remedy::extension);
    if (remedy != kRemedies.end())
      refuse(root.place(), "requires " + name + ", which is not read; " + std::string(remedy->command));
    if (std::ranges::find(kUnderstood, name) == kUnderstood.end())
      refuse(root.place(), "requires the extension " + in_quotes(name) + ", which is not read; export it without");
  }
  for (const std::string& name : root.texts("extensionsUsed"))
    if (std::ranges::find(kUnderstood, name) == kUnderstood.end() && name.find("_materials_") == std::string::npos)
      notices.note("the extension " + in_quotes(name) + " is not read", root.place());
}

}  // namespace

GltfDocument read_gltf_document(std::string bytes, const std::string& file, Notices& notices) {
  GltfDocument document;
  document.file = file;
  const std::string text =
      bytes.starts_with("glTF") ? take_apart(bytes, file, document.binary, notices) : std::move(bytes);
  check_depth(text, file);
  try {
    document.json = nlohmann::json::parse(text);
  } catch (const nlohmann::json::exception& error) {
    refuse({file}, "its JSON cannot be read: " + std::string(error.what()).substr(0, 200));
  }
  if (!document.json.is_object()) refuse({file}, "its JSON is not an object: it is not glTF");
  check_version(document.root(), version_of(document.json));
  check_extensions(document.root(), notices);
  return document;
}

}  // namespace torolux
