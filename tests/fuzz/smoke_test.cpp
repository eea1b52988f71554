// SPDX-License-Identifier: MIT
// The fuzzers' corpus, cut and changed at random (a fixed seed) into ten thousand files of each kind (two thousand of
// MGF, whose curves are many triangles): none crashes, each refusal says where. Runs without libFuzzer, in every build.
#include <gtest/gtest.h>

#include "tests/fuzz/load_text.hpp"
#include "tests/fuzz/mutator.hpp"

namespace torolux {
namespace {

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
TEST(FuzzSmoke, Mgf) {
  smoke(SceneText::mgf, "mgf", 2'000);
}
TEST(FuzzSmoke, Ies) {
  smoke(SceneText::ies, "ies", 10'000);
}
TEST(FuzzSmoke, SceneToml) {
  smoke(SceneText::scene_toml, "scene_toml", 10'000);
}
TEST(FuzzSmoke, Gltf) {
  smoke(SceneText::gltf, "gltf", 10'000);
}
TEST(FuzzSmoke, Texture) {
  smoke(SceneText::texture, "texture", 10'000);
}

}  // namespace
}  // namespace torolux
