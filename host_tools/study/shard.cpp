// SPDX-License-Identifier: MIT
// "2/5" becomes a part; a run belongs to it by the place of its key among all keys, sorted, so that every process finds
// the same.
#include "host_tools/study/shard.hpp"

#include <algorithm>

#include "emulator/errors.hpp"
#include "host_tools/cli/parse_values.hpp"

namespace torolux::study {

Shard parse_shard(const std::string& text) {
  constexpr std::uint64_t kMostParts = 1'000'000;
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) throw UsageError("--shard: \"" + text + "\" is not a part like 2/5");
  try {
    const std::uint64_t parts = parse_count(text.substr(slash + 1), 1, kMostParts);
    return {parse_count(text.substr(0, slash), 1, parts), parts};
  } catch (const InputError& error) {
    throw InputError(std::string("--shard: ") + error.what());
  }
}

void keep_shard(std::vector<Work>& work, const std::vector<Work>& all, const Shard& shard) {
  std::vector<std::string> keys;
  keys.reserve(all.size());
  for (const Work& one : all) keys.push_back(one.run.key);
  std::ranges::sort(keys);
  std::erase_if(work, [&](const Work& one) {
    const auto at = static_cast<std::size_t>(std::ranges::lower_bound(keys, one.run.key) - keys.begin());
    return at % shard.parts != shard.part - 1;
  });
}

}  // namespace torolux::study
