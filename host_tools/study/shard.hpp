// SPDX-License-Identifier: MIT
// A study's runs and the name of a part enter; the part's runs leave, for job arrays.
#pragma once

#include <string>
#include <vector>

#include "host_tools/study/runner.hpp"

namespace torolux::study {

struct Shard {
  std::size_t part = 1, parts = 1;  ///< 1..parts
};

/// "2/5". Throws UsageError, InputError.
Shard parse_shard(const std::string& text);

/// Keeps of `work` what is in the part: of the keys of `all`, sorted, every parts-th.
void keep_shard(std::vector<Work>& work, const std::vector<Work>& all, const Shard& shard);

}  // namespace torolux::study
