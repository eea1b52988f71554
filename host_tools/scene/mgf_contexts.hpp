// SPDX-License-Identifier: MIT
// MGF's named contexts: c, m or v in, the one that is current out.
#pragma once

#include <algorithm>
#include <string>
#include <unordered_map>
#include <vector>

#include "emulator/nearest_name.hpp"
#include "host_tools/scene/mgf_statements.hpp"
#include "host_tools/scene/statements.hpp"

namespace torolux {

/// Values by name, one of them (or the unnamed one) current.
template <class Value>
class MgfContexts {
 public:
  /// kind: as in "vertex", for messages.
  explicit MgfContexts(std::string kind) : kind_(std::move(kind)) {}
  MgfContexts(const MgfContexts&) = delete;
  MgfContexts& operator=(const MgfContexts&) = delete;

  /// "c" (unnamed, from its default), "c NAME", "c NAME =" (new, from the default), "c NAME = OTHER" (a copy). true:
  /// the current value was set anew. Throws InputError: the name, or the other, is not defined.
  bool select(const MgfStatement& statement) {
    statement.expect(0, 3, "'KEY', 'KEY NAME', 'KEY NAME =' or 'KEY NAME = OTHER'");
    if (statement.count() == 0) {
      unnamed_ = Value();
      current_ = &unnamed_;
      name_ = nullptr;
      return true;
    }
    if (statement.count() > 1 && statement.word(1) != "=")
      statement.refuse_with("the name is followed by " + in_quotes(statement.word(1)) + "; only '=' may stand there");
    Value fresh;
    if (statement.count() == 3) fresh = found(statement, statement.word(2));
    if (statement.count() == 1) found(statement, statement.word(0));
    const auto [entry, is_new] = values_.try_emplace(std::string(statement.word(0)));
    current_ = &entry->second;
    name_ = &entry->first;
    if (statement.count() == 1) return false;
    entry->second = std::move(fresh);
    return true;
  }

  Value& current() { return *current_; }
  /// "" of the unnamed one.
  std::string name() const { return name_ == nullptr ? "" : *name_; }

  /// Throws InputError with the nearest name: not defined.
  Value& found(const MgfStatement& statement, std::string_view name) {
    const auto entry = values_.find(std::string(name));
    if (entry != values_.end()) return entry->second;
    std::vector<std::string> known;
    if (values_.size() <= kMostToCompare)
      for (const auto& [other, value] : values_) known.push_back(other);
    std::ranges::sort(known);
    statement.refuse_with("there is no " + kind_ + " " + in_quotes(name) + " yet" +
                          did_you_mean(std::string(name), known));
  }
  /// Defines it, where it is not defined yet, and says whether it did.
  bool define(std::string_view name) { return values_.try_emplace(std::string(name)).second; }

 private:
  /// Among more names none is looked for that is near.
  static constexpr std::size_t kMostToCompare = 10'000;

  std::string kind_;
  std::unordered_map<std::string, Value> values_;
  Value unnamed_;
  Value* current_ = &unnamed_;
  const std::string* name_ = nullptr;
};

}  // namespace torolux
