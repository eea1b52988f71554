// SPDX-License-Identifier: MIT
// Checked access to a TOML table (toml++).
#include "host_tools/scene/toml_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "emulator/nearest_name.hpp"
#include "host_tools/scene/statements.hpp"

namespace torolux {
namespace {

std::string shown(double value) {
  std::ostringstream stream;
  stream << value;
  return stream.str();
}

}  // namespace

Place place_of(const toml::node& node, const std::string& file) {
  return {file, node.source().begin.line};
}

toml::table parse_toml(std::string_view text, const std::string& file) {
  // Tables are destroyed one inside the other: a key of thousands of dotted parts would exhaust the stack.
  constexpr std::size_t most_dots = 100;
  std::size_t dots = 0;
  std::size_t line = 1;
  for (const char c : text) {
    if (c == '\n') ++line;
    if (c == '\n' || c == ',' || c == '=') dots = 0;
    if (c == '.' && ++dots > most_dots) refuse({file, line}, "more than 100 dots in one key or value");
    if (c == '\0') refuse({file, line}, "a zero byte: this is not a text file");
  }
  try {
    return toml::parse(text, std::string_view(file));
  } catch (const toml::parse_error& error) {
    refuse({file, error.source().begin.line}, "not valid TOML: " + std::string(error.description()));
  }
}

Place TomlTable::place(std::string_view key) const {
  const toml::node* node = table_.get(key);
  return node == nullptr ? place() : place_of(*node, file_);
}

const toml::node* TomlTable::find(std::string_view key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.emplace_back(key);
  return table_.get(key);
}

std::string TomlTable::mistyped(std::string_view key) const {
  std::vector<std::string> others;
  for (const auto& [name, node] : table_)
    if (std::find(known_.begin(), known_.end(), name.str()) == known_.end()) others.emplace_back(name.str());
  const std::string near = nearest_name(key, others);
  return near.empty() ? "" : "; did you mean it by " + in_quotes(near) + "?";
}

void TomlTable::refuse_kind(std::string_view key, const std::string& expected) const {
  refuse(place(key), title_ + " '" + std::string(key) + "' must be " + expected);
}

double TomlTable::checked(const toml::node& node, std::string_view key, double least, double most) const {
  if (!node.is_number()) refuse_kind(key, "made of numbers");
  const double value = node.value<double>().value_or(0);
  if (!std::isfinite(value) || value < least || value > most)
    refuse(place_of(node, file_), title_ + " '" + std::string(key) + "' is " + shown(value) + "; allowed are " +
                                      shown(least) + " to " + shown(most));
  return value + 0.0;
}

Vec3d TomlTable::vector(const toml::node& node, std::string_view key, double least, double most) const {
  const toml::array* array = node.as_array();
  if (array == nullptr || array->size() != 3) refuse_kind(key, "an array of three numbers");
  Vec3d values{};
  for (std::size_t i = 0; i < 3; ++i) values[i] = checked((*array)[i], key, least, most);
  return values;
}

std::optional<double> TomlTable::number(std::string_view key, double least, double most) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_number()) refuse_kind(key, "a number");
  return checked(*node, key, least, most);
}

std::optional<std::uint64_t> TomlTable::integer(std::string_view key, std::uint64_t least, std::uint64_t most) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_integer()) refuse_kind(key, "a whole number");
  const std::int64_t value = node->value<std::int64_t>().value_or(0);
  if (value < 0 || static_cast<std::uint64_t>(value) < least || static_cast<std::uint64_t>(value) > most)
    refuse(place(key), title_ + " '" + std::string(key) + "' is " + std::to_string(value) + "; allowed are " +
                           std::to_string(least) + " to " + std::to_string(most));
  return static_cast<std::uint64_t>(value);
}

std::optional<std::string> TomlTable::text(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_string()) refuse_kind(key, "a text in quotation marks");
  std::string value = node->value<std::string>().value_or("");
  if (value.find('\0') != std::string::npos) refuse_kind(key, "a text without zero bytes");
  return value;
}

std::optional<bool> TomlTable::flag(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_boolean()) refuse_kind(key, "true or false");
  return node->value<bool>();
}

std::optional<Vec3d> TomlTable::triple(std::string_view key, double least, double most, bool one_for_all) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  if (one_for_all && node->is_number()) {
    const double value = checked(*node, key, least, most);
    return Vec3d{value, value, value};
  }
  return vector(*node, key, least, most);
}

std::optional<std::variant<double, Vec3d>> TomlTable::number_or_triple(std::string_view key, double least,
                                                                       double most) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  if (node->is_number()) return checked(*node, key, least, most);
  if (!node->is_array()) refuse_kind(key, "a number or an array of three numbers");
  return vector(*node, key, least, most);
}

std::optional<std::variant<double, std::string>> TomlTable::number_or_text(std::string_view key, double least,
                                                                           double most) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  if (node->is_number()) return checked(*node, key, least, most);
  if (!node->is_string()) refuse_kind(key, "a number or a text");
  return text(key);
}

std::optional<std::array<double, 2>> TomlTable::pair(std::string_view key, double least, double most) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const toml::array* array = node->as_array();
  if (array == nullptr || array->size() != 2) refuse_kind(key, "an array of two numbers");
  return std::array<double, 2>{checked((*array)[0], key, least, most), checked((*array)[1], key, least, most)};
}

std::optional<std::array<Vec3d, 2>> TomlTable::two_vectors(std::string_view key, double most) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const toml::array* array = node->as_array();
  if (array == nullptr || array->size() != 2) refuse_kind(key, "an array of two arrays of three numbers");
  return std::array<Vec3d, 2>{vector((*array)[0], key, -most, most), vector((*array)[1], key, -most, most)};
}

const toml::table* TomlTable::table(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return nullptr;
  if (!node->is_table()) refuse_kind(key, "a table");
  return node->as_table();
}

std::string TomlTable::header_of(std::string_view key) const {
  const std::size_t begin = title_.find_first_not_of('[');
  const bool nested = begin != 0;  // the title is a header itself: [[mesh]]
  const std::string outer = nested ? title_.substr(begin, title_.find(']') - begin) + "." : "";
  return "[[" + outer + std::string(key) + "]]";
}

std::vector<const toml::table*> TomlTable::tables(std::string_view key) {
  const toml::node* node = find(key);
  std::vector<const toml::table*> result;
  if (node == nullptr) return result;
  const toml::array* array = node->as_array();
  if (array == nullptr) refuse_kind(key, "written as " + header_of(key));
  for (const toml::node& element : *array) {
    if (!element.is_table()) refuse_kind(key, "written as " + header_of(key));
    result.push_back(element.as_table());
  }
  return result;
}

void TomlTable::finish() const {
  for (const auto& [key, node] : table_) {
    const std::string_view name = key.str();
    if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
    const std::string near = nearest_name(name, known_);
    std::string allowed;
    for (const std::string& k : known_) allowed += (allowed.empty() ? "" : ", ") + k;
    refuse({file_, key.source().begin.line},
           title_ + " has no key " + in_quotes(name) +
               (near.empty() ? "; allowed are: " : "; did you mean '" + near + "'? Allowed are: ") + allowed);
  }
}

}  // namespace torolux
