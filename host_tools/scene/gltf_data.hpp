// SPDX-License-Identifier: MIT
// A glTF document and its neighbouring files in; the bytes of buffers and images, and the numbers of accessors, out.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host_tools/scene/files.hpp"
#include "host_tools/scene/gltf_document.hpp"

namespace torolux {

/// Elements that an accessor may have: three for each triangle of the largest scene.
inline constexpr std::size_t kMostElements = 12'000'000;

/// Of an accessor: `components` numbers for each of `count` elements. Floats may be NaN or infinite.
struct GltfNumbers {
  std::size_t components = 0, count = 0;
  std::vector<double> values;

  double at(std::size_t element, std::size_t component) const { return values[element * components + component]; }
};

/// An image as the file has it: embedded, or by the name of a file, which may not be there.
struct GltfImage {
  std::string name;                          ///< of the file, or of the embedded image for messages
  std::shared_ptr<const std::string> bytes;  ///< of an embedded one
};

class GltfData {
 public:
  /// document must outlive it.
  GltfData(const GltfDocument& document, SceneFiles& files, Notices& notices);

  /// Throws InputError: a part that is not there, or reaches beyond its buffer; another number of components than one
  /// of `components`; too many elements.
  GltfNumbers numbers(std::size_t accessor, std::span<const std::size_t> components);
  /// Of an accessor of whole numbers; each must be below `below`. things: what they count.
  std::vector<std::uint32_t> integers(std::size_t accessor, std::size_t below, std::string_view things);
  GltfImage image(std::size_t number);
  /// Where files that it names lie.
  const std::filesystem::path& folder() const { return folder_; }

 private:
  const std::string& buffer(std::size_t number);
  std::string bytes_of(const GltfObject& buffer, std::size_t number);
  void check_length(const GltfObject& buffer, std::size_t bytes);
  std::string_view view(std::size_t number, std::size_t& stride);
  void read_dense(const GltfObject& accessor, GltfNumbers& numbers);
  void read_sparse(const GltfObject& accessor, GltfNumbers& numbers);
  void read_values(const GltfObject& holder, std::string_view bytes, std::size_t stride, std::size_t type,
                   GltfNumbers& numbers) const;

  const GltfDocument& document_;
  GltfObject root_;
  SceneFiles& files_;
  Notices& notices_;
  std::filesystem::path folder_;
  std::vector<std::optional<std::string>> buffers_;  // read when they are first needed
  std::vector<GltfImage> images_;
};

/// The bytes of a data URI; absent: it is none. Throws InputError: not base64.
std::optional<std::string> bytes_of_data_uri(std::string_view uri, const Place& place);
/// A file's name without percent signs.
std::string name_of_uri(std::string_view uri);

}  // namespace torolux
