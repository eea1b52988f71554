// SPDX-License-Identifier: MIT
// Follows accessors over views to buffers, and checks each step against what is there.
#include "host_tools/scene/gltf_data.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "host_tools/scene/find_file.hpp"
#include "host_tools/scene/statements.hpp"

namespace torolux {
namespace {

constexpr std::size_t kMostBytes = std::numeric_limits<std::uint32_t>::max();

enum ComponentType : std::uint16_t { kByte = 5120, kUnsignedByte, kShort, kUnsignedShort, kUnsignedInt = 5125, kFloat };

std::size_t size_of(std::size_t type) {
  switch (type) {
    case kByte:
    case kUnsignedByte:
      return 1;
    case kShort:
    case kUnsignedShort:
      return 2;
    case kUnsignedInt:
    case kFloat:
      return 4;
    default:
      return 0;
  }
}

template <class Value>
double as(const char* from) {
  static_assert(std::endian::native == std::endian::little, "glTF's bytes are taken as they are");
  Value value{};
  std::memcpy(&value, from, sizeof value);
  return static_cast<double>(value);
}

/// normalized: whole numbers stand for 0..1, or with a sign for -1..1 (glTF 2.0, 3.11).
double component(const char* from, std::size_t type, bool normalized) {
  switch (type) {
    case kByte:
      return normalized ? std::max(as<std::int8_t>(from) / 127, -1.0) : as<std::int8_t>(from);
    case kUnsignedByte:
      return as<std::uint8_t>(from) / (normalized ? 255 : 1);
    case kShort:
      return normalized ? std::max(as<std::int16_t>(from) / 32767, -1.0) : as<std::int16_t>(from);
    case kUnsignedShort:
      return as<std::uint16_t>(from) / (normalized ? 65535 : 1);
    case kUnsignedInt:
      return as<std::uint32_t>(from);
    default:
      return as<float>(from);
  }
}

std::size_t components_of(const GltfObject& accessor) {
  const std::string type = accessor.text("type").value_or("");
  if (type == "SCALAR") return 1;
  if (type == "VEC2") return 2;
  if (type == "VEC3") return 3;
  if (type == "VEC4") return 4;
  refuse(accessor.place(), "'type' is " + in_quotes(type) + "; expected SCALAR, VEC2, VEC3 or VEC4");
}

std::size_t component_type_of(const GltfObject& accessor) {
  const std::size_t type = accessor.integer("componentType", kMostBytes).value_or(0);
  if (size_of(type) == 0)
    refuse(accessor.place(),
           "'componentType' is " + std::to_string(type) + "; those of glTF are 5120 to 5123, 5125 and 5126");
  return type;
}

std::string_view from_offset(std::string_view bytes, const GltfObject& holder) {
  const std::size_t offset = holder.integer("byteOffset", kMostBytes).value_or(0);
  if (offset > bytes.size())
    refuse(holder.place(),
           "'byteOffset' is " + std::to_string(offset) + "; there are " + std::to_string(bytes.size()) + " bytes");
  return bytes.substr(offset);
}

}  // namespace

GltfData::GltfData(const GltfDocument& document, SceneFiles& files, Notices& notices)
    : document_(document),
      root_(document_.root()),
      files_(files),
      notices_(notices),
      folder_(std::filesystem::path(document.file).parent_path()),
      buffers_(root_.count("buffers")),
      images_(root_.count("images")) {}

/// Where its length is not what it says, all bytes that are there are used.
void GltfData::check_length(const GltfObject& buffer, std::size_t bytes) {
  const auto length = buffer.integer("byteLength", kMostBytes);
  if (!length)
    notices_.note("a buffer has no 'byteLength', which glTF wants: all its bytes are used", buffer.place());
  else if (*length > bytes)
    notices_.note("a buffer has fewer bytes than its 'byteLength'; what reaches beyond them is refused", buffer.place(),
                  std::to_string(bytes) + " of " + std::to_string(*length));
}

const std::string& GltfData::buffer(std::size_t number) {
  std::optional<std::string>& held = buffers_[number];
  if (held) return *held;
  const GltfObject buffer = root_.element("buffers", number, "buffer");
  held = bytes_of(buffer, number);
  check_length(buffer, held->size());
  return *held;
}

std::string GltfData::bytes_of(const GltfObject& buffer, std::size_t number) {
  const auto uri = buffer.text("uri");
  if (!uri) {
    if (number != 0 || document_.binary.empty())
      refuse(buffer.place(), "has no bytes: neither a 'uri', nor is it the first of a .glb with a BIN chunk");
    return document_.binary;
  }
  if (auto bytes = bytes_of_data_uri(*uri, buffer.place())) return std::move(*bytes);
  if (uri->empty()) refuse(buffer.place(), "its 'uri' is empty");
  if (uri->find("://") != std::string::npos)
    refuse(buffer.place(),
           "lies at " + in_quotes(*uri) + ": nothing is fetched from a network; put it beside the .gltf");
  const std::string name = name_of_uri(*uri);
  const auto found = find_file(name, std::array{folder_}, files_, buffer.place());
  if (!found)
    refuse(buffer.place(), "there is no file '" + (folder_ / name).lexically_normal().string() +
                               "'; put it there (names are relative to the .gltf), or export a .glb");
  if (!found->as_written)
    notices_.note("a buffer is found under another name", buffer.place(),
                  in_quotes(name) + " is " + in_quotes(found->path.string()));
  return files_.read(found->path, buffer.place(), kMostMeshBytes);
}

/// stride: 0 where it has none.
std::string_view GltfData::view(std::size_t number, std::size_t& stride) {
  const GltfObject view = root_.element("bufferViews", number, "bufferView");
  const auto of = view.index("buffer", buffers_.size(), "buffers");
  const auto length = view.integer("byteLength", kMostBytes);
  if (!of || !length) refuse(view.place(), "has no 'buffer' or no 'byteLength'");
  stride = view.integer("byteStride", kMostBytes).value_or(0);
  constexpr std::size_t least = 4;
  constexpr std::size_t most = 252;
  if (view.has("byteStride") && (stride < least || stride > most || stride % least != 0))
    notices_.note("a 'byteStride' that glTF does not allow (multiples of 4 from 4 to 252) is taken as it is",
                  view.place(), std::to_string(stride));
  const std::string_view bytes = from_offset(buffer(*of), view);
  if (*length > bytes.size())
    refuse(view.place(), "reaches beyond its buffer, which has " + std::to_string(buffer(*of).size()) + " bytes");
  return bytes.substr(0, *length);
}

void GltfData::read_values(const GltfObject& holder, std::string_view bytes, std::size_t stride, std::size_t type,
                           GltfNumbers& numbers) const {
  const std::size_t element = size_of(type) * numbers.components;
  if (stride == 0) stride = element;
  if (stride < element)
    refuse(holder.place(), "its elements have " + std::to_string(element) +
                               " bytes each, and the 'byteStride' of its bufferView is " + std::to_string(stride) +
                               ": they would lie within each other; make it " + std::to_string((element + 3) / 4 * 4) +
                               " or more");
  bytes = from_offset(bytes, holder);
  if (numbers.count > 0 && (bytes.size() < element || (bytes.size() - element) / stride < numbers.count - 1))
    refuse(holder.place(), "its " + std::to_string(numbers.count) + " elements reach beyond its bufferView");
  const bool normalized = holder.flag("normalized") && type != kFloat;
  for (std::size_t i = 0; i < numbers.count; ++i)
    for (std::size_t c = 0; c < numbers.components; ++c)
      numbers.values[i * numbers.components + c] =
          component(bytes.data() + i * stride + c * size_of(type), type, normalized);
}

void GltfData::read_dense(const GltfObject& accessor, GltfNumbers& numbers) {
  const std::size_t type = component_type_of(accessor);
  numbers.values.assign(numbers.count * numbers.components, 0);
  const auto from = accessor.index("bufferView", root_.count("bufferViews"), "bufferViews");
  if (!from) return;  // zeros, by the format; a sparse part may follow
  std::size_t stride = 0;
  const std::string_view bytes = view(*from, stride);
  read_values(accessor, bytes, stride, type, numbers);
}

void GltfData::read_sparse(const GltfObject& accessor, GltfNumbers& numbers) {
  const auto sparse = accessor.object("sparse");
  if (!sparse) return;
  const std::size_t views = root_.count("bufferViews");
  const auto indices = sparse->object("indices");
  const auto values = sparse->object("values");
  const auto index_view = indices ? indices->index("bufferView", views, "bufferViews") : std::nullopt;
  const auto value_view = values ? values->index("bufferView", views, "bufferViews") : std::nullopt;
  if (!index_view || !value_view) refuse(accessor.place(), "its 'sparse' part has no indices or no values");
  GltfNumbers where{1, sparse->integer("count", numbers.count).value_or(0), {}};
  GltfNumbers what{numbers.components, where.count, {}};
  where.values.resize(where.count);
  what.values.resize(what.count * what.components);
  std::size_t stride = 0;
  const std::size_t index_type = component_type_of(*indices);
  if (index_type == kFloat) refuse(accessor.place(), "the indices of its 'sparse' part are not whole numbers");
  const std::string_view index_bytes = view(*index_view, stride);
  read_values(*indices, index_bytes, 0, index_type, where);
  const std::string_view value_bytes = view(*value_view, stride);
  read_values(*values, value_bytes, 0, component_type_of(accessor), what);
  const bool normalized = accessor.flag("normalized");
  if (normalized && component_type_of(accessor) != kFloat)
    refuse(accessor.place(), "is both sparse and normalized, which is not read; export it as floats");
  for (std::size_t i = 0; i < where.count; ++i) {
    if (!(where.values[i] >= 0 && where.values[i] < static_cast<double>(numbers.count)))
      refuse(accessor.place(),
             "an index of its 'sparse' part is beyond its " + std::to_string(numbers.count) + " elements");
    const auto at = static_cast<std::size_t>(where.values[i]);
    for (std::size_t c = 0; c < numbers.components; ++c) numbers.values[at * numbers.components + c] = what.at(i, c);
  }
}

GltfNumbers GltfData::numbers(std::size_t number, std::span<const std::size_t> components) {
  const GltfObject accessor = root_.element("accessors", number, "accessor");
  GltfNumbers numbers;
  numbers.components = components_of(accessor);
  if (std::ranges::find(components, numbers.components) == components.end())
    refuse(accessor.place(),
           "has " + std::to_string(numbers.components) + " numbers for each element, which what uses it cannot have");
  const auto count = accessor.integer("count", kMostElements);
  if (!count) refuse(accessor.place(), "has no 'count'");
  numbers.count = *count;
  if (!accessor.has("bufferView") && !accessor.has("sparse"))
    refuse(accessor.place(), "has no bytes: neither a 'bufferView' nor a 'sparse' part");
  read_dense(accessor, numbers);
  read_sparse(accessor, numbers);
  return numbers;
}

std::vector<std::uint32_t> GltfData::integers(std::size_t number, std::size_t below, std::string_view things) {
  const GltfNumbers read = numbers(number, std::array<std::size_t, 1>{1});
  std::vector<std::uint32_t> result;
  result.reserve(read.count);
  for (std::size_t i = 0; i < read.count; ++i) {
    const double value = read.values[i];
    if (!(value >= 0 && value < static_cast<double>(below)) || value != std::floor(value))
      refuse(root_.element("accessors", number, "accessor").place(),
             "element " + std::to_string(i) + " is not one of the " + std::to_string(below) + " " +
                 std::string(things) + ", counted from 0");
    result.push_back(static_cast<std::uint32_t>(value));
  }
  return result;
}

GltfImage GltfData::image(std::size_t number) {
  GltfImage& held = images_[number];
  if (!held.name.empty()) return held;
  const GltfObject image = root_.element("images", number, "image");
  held.name = image.place().file;
  if (const auto uri = image.text("uri")) {
    if (auto bytes = bytes_of_data_uri(*uri, image.place()))
      held.bytes = std::make_shared<const std::string>(std::move(*bytes));
    else
      held.name = name_of_uri(*uri);
  } else if (const auto from = image.index("bufferView", root_.count("bufferViews"), "bufferViews")) {
    std::size_t stride = 0;
    held.bytes = std::make_shared<const std::string>(view(*from, stride));
  } else {
    refuse(image.place(), "has neither a 'uri' nor a 'bufferView'");
  }
  if (held.name.empty()) refuse(image.place(), "its 'uri' is empty");
  return held;
}

}  // namespace torolux
