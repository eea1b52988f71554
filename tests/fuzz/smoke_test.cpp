// SPDX-License-Identifier: MIT
// The fuzzers' corpus, cut and changed at random (a fixed seed) into ten thousand files of each kind: none crashes,
// each refusal says where. Runs without libFuzzer, in every build.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

#include "tests/fuzz/load_text.hpp"

namespace torolux {
namespace {

std::vector<std::string> corpus(const std::string& name) {
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

void smoke(SceneText kind, const std::string& name, int count) {
  const std::vector<std::string> texts = corpus(name);
  ASSERT_FALSE(texts.empty());
  Mutator mutator(texts);
  int loaded = 0;
  for (int i = 0; i < count; ++i) loaded += load_text(kind, mutator.next(), i % 2 == 1) ? 1 : 0;
  // Some must live and some must be refused, or the test would prove nothing. TOML is strict: few survive.
  EXPECT_GT(loaded, count / 200);
  EXPECT_LT(loaded, count - count / 100);
}

TEST(FuzzSmoke, Obj) {
  smoke(SceneText::obj, "obj", 10'000);
}
TEST(FuzzSmoke, Mtl) {
  smoke(SceneText::mtl, "mtl", 10'000);
}
TEST(FuzzSmoke, SceneToml) {
  smoke(SceneText::scene_toml, "scene_toml", 10'000);
}

}  // namespace
}  // namespace torolux
