// SPDX-License-Identifier: MIT
// The bytes of a .gltf or .glb file in; its JSON, checked as a whole, and the bytes that it brings along, out.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "host_tools/scene/gltf_object.hpp"
#include "host_tools/scene/notices.hpp"

namespace torolux {

// NOLINTNEXTLINE(bugprone-exception-escape): moving JSON throws nothing, its assertions could
struct GltfDocument {
  std::string file;
  nlohmann::json json;  ///< an object
  std::string binary;   ///< of a .glb: its BIN chunk

  GltfObject root() const { return {json, file, ""}; }
};

/// Which of the two kinds it is, its first bytes decide. Throws InputError: not JSON, nested too deeply, damaged
/// chunks, not glTF 2, a required extension that is not read (with what takes it out, where something does).
GltfDocument read_gltf_document(std::string bytes, const std::string& file, Notices& notices);

}  // namespace torolux
