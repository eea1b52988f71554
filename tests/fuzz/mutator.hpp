// SPDX-License-Identifier: MIT
// A fuzzer's corpus enters; texts cut and changed by a fixed seed leave, the same in every build.
#pragma once

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace torolux {

/// The texts in tests/fuzz/corpus/NAME, by the names of their files.
inline std::vector<std::string> corpus(const std::string& name) {
  const std::filesystem::path folder = std::filesystem::path(TOROLUX_SOURCE_DIR) / "tests/fuzz/corpus" / name;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<std::string> texts;
  for (const auto& path : files) {
    std::ifstream stream(path, std::ios::binary);
    texts.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  return texts;
}

class Mutator {
 public:
  explicit Mutator(std::vector<std::string> texts) : texts_(std::move(texts)), random_(20) {}

  std::string next() {
    std::string text = pick(texts_);
    for (std::size_t changes = 1 + below(2) * below(4); changes > 0; --changes) change(text);
    return text;
  }

 private:
  // Not std::uniform_int_distribution: its numbers differ between libraries.
  std::size_t below(std::size_t n) { return n == 0 ? 0 : random_() % n; }
  const std::string& pick(const std::vector<std::string>& from) { return from[below(from.size())]; }

  void change(std::string& text) {
    static const std::vector<std::string> odd{"nan", "inf", "-1",   "0",  "1e999", "99999999999", "\"",
                                              "[",   "]",   "\\\n", "\n", "f ",    "#",           "=",
                                              ".",   "{",   "\xff", "//", " ",     "-",           "1e-310"};
    const std::size_t at = below(text.size());
    switch (below(6)) {
      case 0:
        text.resize(at);
        break;
      case 1:
        if (!text.empty()) text[at] = static_cast<char>(below(256));
        break;
      case 2:
        text.insert(at, pick(odd));
        break;
      case 3:
        text.erase(at, below(12));
        break;
      case 4:
        text.insert(at, text.substr(below(text.size()), below(60)));
        break;
      default:
        text.replace(at, std::min(below(8), text.size() - at), pick(odd));
        break;
    }
  }

  std::vector<std::string> texts_;
  std::mt19937 random_;
};

}  // namespace torolux
