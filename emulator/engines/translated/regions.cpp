// SPDX-License-Identifier: MIT
// Puts functions that call each other into one region, as long as it does not become too large for the compiler.
#include "emulator/engines/translated/regions.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

namespace torolux::translated {
namespace {

/// Instructions of a region. The compiler's time grows faster than this: the PE program takes it three times as long
/// at 2500, and runs no faster.
constexpr std::uint32_t kMostInstructions = 500;

/// Functions, joined to groups (disjoint sets).
class Groups {
 public:
  explicit Groups(std::vector<std::uint32_t> sizes) : size_(std::move(sizes)), parent_(size_.size()) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t of(std::size_t function) {
    while (parent_[function] != function) function = parent_[function] = parent_[parent_[function]];
    return function;
  }
  void join(std::size_t a, std::size_t b) {
    a = of(a);
    b = of(b);
    if (a == b || size_[a] + size_[b] > kMostInstructions) return;
    parent_[std::max(a, b)] = std::min(a, b);
    size_[std::min(a, b)] += size_[std::max(a, b)];
  }
  std::uint32_t size(std::size_t group) const { return size_[group]; }

 private:
  std::vector<std::uint32_t> size_;
  std::vector<std::size_t> parent_;
};

class FunctionsOf {
 public:
  explicit FunctionsOf(const std::vector<std::uint32_t>& begins) : begins_(begins) {}
  /// What lies before the first function belongs to it.
  std::size_t operator()(std::uint32_t address) const {
    const auto behind = std::upper_bound(begins_.begin(), begins_.end(), address);
    return behind == begins_.begin() ? 0 : static_cast<std::size_t>(behind - begins_.begin()) - 1;
  }

 private:
  const std::vector<std::uint32_t>& begins_;
};

/// How many loops an address lies in, by the jumps backwards over it inside its function.
class Loops {
 public:
  Loops(const Blocks& blocks, const FunctionsOf& function_of) {
    for (const auto& [address, block] : blocks.all()) {
      const bool jumps = block.ending == Ending::branch || block.ending == Ending::jump;
      if (!jumps || block.target > block.last || function_of(block.target) != function_of(address)) continue;
      std::uint32_t& end = end_of_loop_[block.target];
      end = std::max(end, block.last);
    }
  }
  unsigned depth(std::uint32_t address) const {
    constexpr std::uint32_t kLongest = 8192;  // bytes of a loop: those that begin earlier are not looked at
    unsigned depth = 0;
    const auto behind = end_of_loop_.upper_bound(address);
    for (auto loop = end_of_loop_.lower_bound(address - std::min(address, kLongest)); loop != behind; ++loop) {
      if (loop->second >= address) ++depth;
    }
    return depth;
  }

 private:
  std::map<std::uint32_t, std::uint32_t> end_of_loop_;  // by its beginning
};

struct Edge {
  std::uint64_t weight;  ///< jumps and calls between the two, those in loops counted as if run more often
  std::size_t a, b;      ///< functions, a < b
};

/// Strongest first; ties by address, so that the same image always gives the same regions.
std::vector<Edge> edges_of(const Blocks& blocks, const FunctionsOf& function_of) {
  constexpr unsigned kDeepest = 4;
  constexpr unsigned kBitsPerLoop = 3;  // a loop is taken to run eight times
  const Loops loops(blocks, function_of);
  std::map<std::pair<std::size_t, std::size_t>, std::uint64_t> weights;
  const auto add = [&](std::uint32_t from, std::uint32_t to) {
    const std::size_t a = function_of(from);
    const std::size_t b = function_of(to);
    if (a != b)
      weights[std::minmax(a, b)] += std::uint64_t{1} << (kBitsPerLoop * std::min(kDeepest, loops.depth(from)));
  };
  for (const auto& [address, block] : blocks.all()) {
    if (block.ending == Ending::branch || block.ending == Ending::jump) add(block.last, block.target);
    if (block.ending != Ending::jump && block.ending != Ending::indirect) add(block.last, block.end);
  }
  std::vector<Edge> edges;
  for (const auto& [pair, weight] : weights) edges.push_back({weight, pair.first, pair.second});
  std::stable_sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.weight > b.weight; });
  return edges;
}

void make_entries(Blocks& blocks, const std::map<std::uint32_t, std::size_t>& region_of) {
  std::vector<std::uint32_t> entries;
  for (const auto& [address, block] : blocks.all()) {
    for (const std::uint32_t to : {block.target, block.end}) {
      const auto found = region_of.find(to);
      if (found != region_of.end() && found->second != region_of.at(address)) entries.push_back(to);
    }
  }
  for (const std::uint32_t entry : entries) blocks.make_entry(entry);
}

}  // namespace

std::vector<Region> make_regions(Blocks& blocks) {
  const FunctionsOf function_of(blocks.functions());
  std::vector<std::uint32_t> sizes(blocks.functions().size(), 0);
  for (const auto& [address, block] : blocks.all()) sizes[function_of(address)] += block.cost.instructions + 1;
  Groups groups(sizes);
  for (const Edge& edge : edges_of(blocks, function_of)) groups.join(edge.a, edge.b);
  // What calls nothing and is not called, or did not fit: with its neighbours.
  for (std::size_t i = 1; i < sizes.size(); ++i) groups.join(i - 1, i);

  std::map<std::size_t, Region> by_group;
  for (const auto& [address, block] : blocks.all()) by_group[groups.of(function_of(address))].push_back(address);
  std::vector<Region> regions;
  std::map<std::uint32_t, std::size_t> region_of;
  for (auto& [group, region] : by_group) {
    for (const std::uint32_t address : region) region_of[address] = regions.size();
    regions.push_back(std::move(region));
  }
  make_entries(blocks, region_of);
  return regions;
}

}  // namespace torolux::translated
