// SPDX-License-Identifier: MIT
// Looks values up in JSON and refuses what is of another kind.
#include "host_tools/scene/gltf_object.hpp"

#include <cmath>
#include <cstdint>
#include <utility>

#include "host_tools/scene/imported_mesh.hpp"
#include "host_tools/scene/statements.hpp"

namespace torolux {

using Json = nlohmann::json;

GltfObject::GltfObject(const Json& json, std::string file, std::string words)
    : json_(&json), file_(std::move(file)), words_(std::move(words)) {
  if (!json.is_object()) refuse(place(), "is not a JSON object");
}

Place GltfObject::place() const {
  return {words_.empty() ? file_ : file_ + ": " + words_, 0};
}

const Json* GltfObject::value(std::string_view key) const {
  const auto found = json_->find(key);
  return found == json_->end() ? nullptr : &*found;
}

void GltfObject::refuse_value(std::string_view key, const std::string& expected) const {
  refuse(place(), "'" + std::string(key) + "' is not " + expected);
}

std::optional<double> GltfObject::number(std::string_view key, double low, double high) const {
  const Json* found = value(key);
  if (found == nullptr) return std::nullopt;
  if (!found->is_number()) refuse_value(key, "a number");
  const double number = found->get<double>();
  if (!(number >= low && number <= high))
    refuse(place(), "'" + std::string(key) + "' is " + found->dump() + "; allowed is " + Json(low).dump() + " to " +
                        Json(high).dump());
  return number;
}

std::optional<std::string> GltfObject::text(std::string_view key) const {
  const Json* found = value(key);
  if (found == nullptr) return std::nullopt;
  if (!found->is_string()) refuse_value(key, "a text");
  return found->get<std::string>();
}

bool GltfObject::flag(std::string_view key) const {
  const Json* found = value(key);
  if (found == nullptr) return false;
  if (!found->is_boolean()) refuse_value(key, "true or false");
  return found->get<bool>();
}

namespace {

/// Whole and not negative; programs write 3.0 for 3.
std::optional<std::uint64_t> whole(const Json& json) {
  if (json.is_number_unsigned()) return json.get<std::uint64_t>();
  if (!json.is_number_float()) return std::nullopt;
  const double number = json.get<double>();
  constexpr double exact = 9007199254740992.0;  // 2^53
  if (!(number >= 0 && number <= exact) || number != std::floor(number)) return std::nullopt;
  return static_cast<std::uint64_t>(number);
}

}  // namespace

std::optional<std::size_t> GltfObject::integer(std::string_view key, std::size_t most) const {
  const Json* found = value(key);
  if (found == nullptr) return std::nullopt;
  const auto number = whole(*found);
  if (!number) refuse_value(key, "a whole number of zero or more");
  if (*number > most)
    refuse(place(), "'" + std::string(key) + "' is " + std::to_string(*number) + "; at most " + std::to_string(most) +
                        " is read");
  return *number;
}

std::optional<std::size_t> GltfObject::index(std::string_view key, std::size_t size, std::string_view things) const {
  const Json* found = value(key);
  if (found == nullptr) return std::nullopt;
  const auto number = whole(*found);
  if (!number) refuse_value(key, "a whole number of zero or more");
  if (*number >= size)
    refuse(place(), "'" + std::string(key) + "' is " + std::to_string(*number) + "; the file has " +
                        std::to_string(size) + " " + std::string(things) + ", counted from 0");
  return *number;
}

const Json* GltfObject::list(std::string_view key) const {
  const Json* found = value(key);
  if (found != nullptr && !found->is_array()) refuse_value(key, "a list");
  return found;
}

std::vector<std::size_t> GltfObject::indices(std::string_view key, std::size_t size, std::string_view things) const {
  std::vector<std::size_t> result;
  const Json* found = list(key);
  if (found == nullptr) return result;
  for (const Json& one : *found) {
    const auto number = whole(one);
    if (!number || *number >= size)
      refuse(place(), "'" + std::string(key) + "' names " + one.dump().substr(0, 60) + "; the file has " +
                          std::to_string(size) + " " + std::string(things) + ", counted from 0");
    result.push_back(*number);
  }
  return result;
}

std::optional<std::vector<double>> GltfObject::numbers(std::string_view key, std::size_t count) const {
  const Json* found = list(key);
  if (found == nullptr) return std::nullopt;
  if (found->size() != count) refuse_value(key, std::to_string(count) + " numbers");
  std::vector<double> result;
  for (const Json& one : *found) {
    if (!one.is_number() || !(std::abs(one.get<double>()) <= kMostCoordinate))
      refuse_value(key, std::to_string(count) + " numbers of at most 1e15 in magnitude");
    result.push_back(one.get<double>());
  }
  return result;
}

std::optional<Vec3d> GltfObject::colour(std::string_view key) const {
  const auto read = numbers(key, 3);
  if (!read) return std::nullopt;
  for (const double one : *read)
    if (one < 0) refuse_value(key, "three numbers of zero or more");
  return Vec3d{(*read)[0], (*read)[1], (*read)[2]};
}

std::vector<std::string> GltfObject::texts(std::string_view key) const {
  std::vector<std::string> result;
  const Json* found = list(key);
  if (found == nullptr) return result;
  for (const Json& one : *found) {
    if (!one.is_string()) refuse_value(key, "a list of texts");
    result.push_back(one.get<std::string>());
  }
  return result;
}

std::optional<GltfObject> GltfObject::object(std::string_view key) const {
  const Json* found = value(key);
  if (found == nullptr) return std::nullopt;
  if (!found->is_object()) refuse_value(key, "a JSON object");
  return GltfObject(*found, file_, words_);
}

std::optional<GltfObject> GltfObject::extension(std::string_view name) const {
  const auto all = object("extensions");
  return all ? all->object(name) : std::nullopt;
}

std::vector<std::string> GltfObject::extension_names() const {
  const auto all = object("extensions");
  return all ? all->keys() : std::vector<std::string>{};
}

std::size_t GltfObject::count(std::string_view key) const {
  const Json* found = list(key);
  return found == nullptr ? 0 : found->size();
}

GltfObject GltfObject::element(std::string_view key, std::size_t number, std::string_view noun) const {
  const Json& one = list(key)->at(number);
  std::string words = words_.empty() ? "" : words_ + ", ";
  words += std::string(noun) + " " + std::to_string(number);
  if (one.is_object())
    if (const auto name = one.find("name"); name != one.end() && name->is_string() && !name->empty())
      words += " " + in_quotes(name->get<std::string>());
  return {one, file_, words};
}

std::vector<std::string> GltfObject::keys() const {
  std::vector<std::string> result;
  for (const auto& [key, one] : json_->items()) result.push_back(key);
  return result;
}

}  // namespace torolux
