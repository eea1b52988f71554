// SPDX-License-Identifier: MIT
// One object of a glTF file's JSON enters; its values leave, each checked for its kind and range.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host_tools/scene/notices.hpp"
#include "host_tools/scene/scene.hpp"

namespace torolux {

/// Refers to JSON that must outlive it. Its members throw InputError "FILE: node 3 'Lamp': what is wrong" for a value
/// of another kind or out of its range; what is absent is absent.
class GltfObject {
 public:
  /// words: how messages name it, such as "node 3 'Lamp'"; none for the file as a whole.
  GltfObject(const nlohmann::json& json, std::string file, std::string words);

  /// Without a line: glTF is written by programs, and its parts have numbers.
  Place place() const;
  /// For messages on what it says: "node 3 'Lamp'".
  const std::string& words() const { return words_; }

  bool has(std::string_view key) const { return value(key) != nullptr; }
  /// low <= value <= high, else refused.
  std::optional<double> number(std::string_view key, double low, double high) const;
  std::optional<std::string> text(std::string_view key) const;
  bool flag(std::string_view key) const;  ///< absent: false
  /// An integer from 0 to most.
  std::optional<std::size_t> integer(std::string_view key, std::size_t most) const;
  /// A number into a list of `size`; things: what the list has, such as "meshes".
  std::optional<std::size_t> index(std::string_view key, std::size_t size, std::string_view things) const;
  std::vector<std::size_t> indices(std::string_view key, std::size_t size, std::string_view things) const;
  /// Exactly `count` numbers of at most 1e15 in magnitude.
  std::optional<std::vector<double>> numbers(std::string_view key, std::size_t count) const;
  /// Three numbers, none negative.
  std::optional<Vec3d> colour(std::string_view key) const;
  std::vector<std::string> texts(std::string_view key) const;

  std::optional<GltfObject> object(std::string_view key) const;
  std::optional<GltfObject> extension(std::string_view name) const;
  std::vector<std::string> extension_names() const;
  /// How many elements the list has; 0: it is absent.
  std::size_t count(std::string_view key) const;
  /// One of the list's elements, which must be an object. noun: for messages.
  GltfObject element(std::string_view key, std::size_t number, std::string_view noun) const;
  /// Keys and integers of an object such as "attributes".
  std::vector<std::string> keys() const;

 private:
  const nlohmann::json* value(std::string_view key) const;
  const nlohmann::json* list(std::string_view key) const;
  [[noreturn]] void refuse_value(std::string_view key, const std::string& expected) const;

  const nlohmann::json* json_;
  std::string file_, words_;
};

}  // namespace torolux
