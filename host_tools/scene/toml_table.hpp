// SPDX-License-Identifier: MIT
// One table of a TOML file, read key by key with checks; what was not asked for is refused at the end.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "emulator/toml.hpp"
#include "host_tools/scene/files.hpp"
#include "host_tools/scene/scene.hpp"

namespace torolux {

/// Throws InputError with file and line where the text is not TOML. Guards the parser against nesting that would
/// exhaust the stack.
toml::table parse_toml(std::string_view text, const std::string& file);

Place place_of(const toml::node& node, const std::string& file);

/// All getters throw InputError with file and line for a value of the wrong kind or out of its range.
class TomlTable {
 public:
  /// title: as in "[camera]", for messages.
  TomlTable(const toml::table& table, std::string file, std::string title)
      : table_(table), file_(std::move(file)), title_(std::move(title)) {}

  const std::string& title() const { return title_; }
  Place place() const { return place_of(table_, file_); }
  Place place(std::string_view key) const;

  std::optional<double> number(std::string_view key, double least, double most);
  std::optional<std::uint64_t> integer(std::string_view key, std::uint64_t least, std::uint64_t most);
  std::optional<std::string> text(std::string_view key);
  std::optional<bool> flag(std::string_view key);
  /// An array of three numbers; where `one_for_all`, a single number stands for three.
  std::optional<Vec3d> triple(std::string_view key, double least, double most, bool one_for_all);
  std::optional<std::variant<double, Vec3d>> number_or_triple(std::string_view key, double least, double most);
  std::optional<std::variant<double, std::string>> number_or_text(std::string_view key, double least, double most);
  std::optional<std::array<double, 2>> pair(std::string_view key, double least, double most);
  std::optional<std::array<Vec3d, 2>> two_vectors(std::string_view key, double most);
  const toml::table* table(std::string_view key);
  std::vector<const toml::table*> tables(std::string_view key);

  /// Says that the key may be there; the caller reads it from the table itself.
  void known(std::string_view key) { find(key); }

  /// Refuses with what is missing.
  template <typename T>
  T required(std::optional<T> value, std::string_view key) const {
    if (!value) refuse(place(), title_ + " lacks '" + std::string(key) + "'" + mistyped(key));
    return *value;
  }
  /// Refuses keys that nobody asked for.
  void finish() const;

 private:
  const toml::node* find(std::string_view key);
  /// "; did you mean it by 'KEY'?" where the table has a key that is nearly this one; else "".
  std::string mistyped(std::string_view key) const;
  /// As an array of tables within this one is written.
  std::string header_of(std::string_view key) const;
  [[noreturn]] void refuse_kind(std::string_view key, const std::string& expected) const;
  double checked(const toml::node& node, std::string_view key, double least, double most) const;
  Vec3d vector(const toml::node& node, std::string_view key, double least, double most) const;

  const toml::table& table_;
  std::string file_;
  std::string title_;
  std::vector<std::string> known_;
};

}  // namespace torolux
