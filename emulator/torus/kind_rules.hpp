// SPDX-License-Identifier: MIT
// Where a record says of which kind it is, as data: for who counts kinds where the program that knows them is not.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "emulator/torus/record_kinds.hpp"

namespace torolux {

/// A record of `record_bytes` is of this kind where the bits `mask` of its byte `at` are those of `value`.
struct KindRule {
  std::uint32_t record_bytes;
  std::uint32_t at;  ///< less than record_bytes
  std::uint8_t mask, value;
  std::uint16_t kind;
};

/// The first rule that holds counts; RecordKinds::kUnknown: none does.
constexpr std::size_t kind_by(std::span<const KindRule> rules, std::span<const std::byte> record) {
  for (const KindRule& rule : rules) {
    if (rule.record_bytes != record.size()) continue;
    if ((std::to_integer<std::uint8_t>(record[rule.at]) & rule.mask) == rule.value) return rule.kind;
  }
  return RecordKinds::kUnknown;
}

/// Kinds that rules tell whole: a RecordKinds may be one, too.
class HasKindRules {
 public:
  virtual ~HasKindRules() = default;
  virtual std::span<const KindRule> kind_rules() const = 0;
};

/// Of those rules.
class RuledKinds final : public RecordKinds {
 public:
  explicit RuledKinds(std::vector<KindRule> rules) : rules_(std::move(rules)) {}
  std::size_t record_kind(std::span<const std::byte> record) const override { return kind_by(rules_, record); }

 private:
  std::vector<KindRule> rules_;
};

}  // namespace torolux
