// SPDX-License-Identifier: MIT
// Proves: mistyped words are told with what was meant, results are not written over each other, and what the options of
// strangers' scenes do from the command line.
#include <gmock/gmock.h>

#include "tests/support/temporary_folder.hpp"
#include "tests/unit/host_tools/cli/run_main.hpp"

namespace torolux {
namespace {

using testing::HasSubstr;
using testing_support::TemporaryFolder;

TEST(Words, MistypedWordsSayWhatWasMeant) {
  struct Case {
    std::vector<std::string> words;
    const char* meant;
  };
  for (const Case& one :
       std::vector<Case>{{{"rendr", "scene"}, "\"rendr\" is no command; did you mean 'render'?"},
                         {{"bench", "engin"}, "\"engin\" is no command of `torolux bench`; did you mean 'engine'?"},
                         {{"scene", "render"}, "The command comes first: torolux render"},
                         {{"--vesion"}, "there is no option '--vesion'; did you mean '--version'?"},
                         {{"render", "scene", "--qualty", "draft"},
                          "there is no option '--qualty' of `torolux render`; did you mean '--quality'?"},
                         {{"render", "scene", "--alocation=block"}, "did you mean '--allocation'?"},
                         {{"render", "scene", "-quality", "draft"}, "did you mean '--quality'?"},
                         {{"render", "--qualty", "draft"}, "did you mean '--quality'?"},
                         {{"render", "scene", "first", "second"}, "'first' is a word too many"},
                         {{"render", "scene", "--quality", "drft"},
                          "--quality: \"drft\" is no quality preset; did you mean 'draft'?"},
                         {{"render", "scene", "--scheme", "sprad"}, "did you mean 'spread'?"},
                         {{"render", "scene", "--engine", "tarnslated"}, "did you mean 'translated'?"},
                         {{"render", "scene", "--allocation", "blok"}, "did you mean 'block'?"},
                         {{"render", "scene", "--layers", "depth,onwer"}, "did you mean 'owner'?"},
                         {{"render", "scene", "--direct", "shadowrays"}, "did you mean 'shadow-rays'?"},
                         {{"network", "--traffic", "unifrom"}, "did you mean 'uniform'?"}}) {
    const Outcome outcome = torolux(one.words);
    EXPECT_EQ(outcome.code, 1) << testing::PrintToString(one.words);
    EXPECT_THAT(outcome.err, HasSubstr(one.meant));
  }
  const Outcome key = torolux({"render", "scene", "--set", "torus.flit_byte=16"});
  EXPECT_EQ(key.code, 2);
  EXPECT_THAT(key.err, HasSubstr("did you mean 'torus.flit_bytes'?"));
  EXPECT_THAT(torolux({"render", std::string(TOROLUX_SOURCE_DIR) + "/scenes/cornel_box"}).err,
              HasSubstr("scenes/cornell_box'?"));
}

TEST(Words, AnOptionOfOneValueThatIsGivenTwiceIsToldWithBoth) {
  const Outcome outcome = torolux({"run", "a.elf", "--pes", "1x1", "--pes=2x2"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("--pes is given twice, with 1x1 and 2x2; it takes one value: leave one out"));
}

TEST(Words, HelpIsACommand) {
  EXPECT_EQ(torolux({"help"}).out, torolux({"--help"}).out);
  EXPECT_EQ(torolux({"help", "render"}).out, torolux({"render", "--help"}).out);
  EXPECT_EQ(torolux({"help"}).code, 0);
  EXPECT_EQ(torolux({"help", "paint"}).code, 1);
}

TEST(Results, ResultsInOneFileAreRefused) {
  const TemporaryFolder folder;
  const std::string scene = write_small_scene(folder.path()).string();
  const auto at = [&](const char* name) { return (folder.path() / name).string(); };
  std::filesystem::create_symlink(at("a.png"), at("link.json"));
  using Words = std::vector<std::string>;
  for (const Words& words :
       {Words{"--output", at("a.png"), "--stats", at("a.png")},
        Words{"--output", at("a.png"), "--stats", at("./a.png")},
        Words{"--output", at("a.png"), "--output", at("a.png")},
        Words{"--output", at("a.png"), "--stats", at("link.json")},
        Words{"--save-radiosity", at("b"), "--save-mesh", at("b"), "--no-picture"},
        Words{"--output", at("a.png"), "--output", at("a_depth.png"), "--layers", "depth"},
        Words{"--no-picture", "--stats", at("room.mtl")}, Words{"--no-picture", "--save-mesh", scene}}) {
    Words all{"render", scene};
    all.insert(all.end(), words.begin(), words.end());
    const Outcome outcome = torolux(all);
    EXPECT_EQ(outcome.code, 2) << testing::PrintToString(words);
    EXPECT_THAT(outcome.err, HasSubstr("would be written over")) << testing::PrintToString(words);
  }
  EXPECT_EQ(folder.files(), 3U) << "the scene and the link";
}

TEST(Results, AMeshIsAPlyAndNoOtherExtensionIsTaken) {
  const TemporaryFolder folder;
  const std::string scene = write_small_scene(folder.path()).string();
  const Outcome report = torolux({"render", scene, "--no-picture", "--report", folder.path() / "a.pdf"});
  EXPECT_EQ(report.code, 1);
  EXPECT_THAT(report.err, HasSubstr("a.pdf: a report is a page of HTML"));
  const Outcome outcome = torolux({"render", scene, "--no-picture", "--save-mesh", folder.path() / "a.obj"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("a.obj: the mesh is written as .ply"), HasSubstr("a.ply")));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "a.obj"));
}

TEST(SceneWords, StrictRefusesWhatIsTold) {
  const TemporaryFolder folder;
  const std::string scene = write_small_scene(folder.path()).string();
  const std::string picture = folder.path() / "a.png";
  const Outcome camera = torolux({"render", scene, "--output", picture, "--strict"});
  EXPECT_EQ(camera.code, 2);
  EXPECT_THAT(camera.err, AllOf(HasSubstr("refused by --strict:"), HasSubstr("names no camera")));
  std::ofstream(folder.path() / "room.obj", std::ios::app) << "vw 1 2\n";
  const std::vector<std::string> seen{"--eye", "0,0,9", "--look-at", "0,0,0", "--strict", "--output", picture};
  std::vector<std::string> words{"render", scene};
  words.insert(words.end(), seen.begin(), seen.end());
  const Outcome statement = torolux(words);
  EXPECT_EQ(statement.code, 2);
  EXPECT_THAT(statement.err, AllOf(HasSubstr("room.obj:12: statement 'vw'"), testing::Not(HasSubstr("camera"))));
}

TEST(SceneWords, MissingMaterialsAreRefusedOrWhite) {
  const TemporaryFolder folder;
  const std::string scene = write_small_scene(folder.path()).string();
  std::filesystem::remove(folder.path() / "room.mtl");
  EXPECT_EQ(torolux({"info", scene}).code, 2);
  const Outcome white = torolux({"info", scene, "--missing-materials", "white"});
  EXPECT_EQ(white.code, 0);
  EXPECT_THAT(white.out, HasSubstr("diffuse, reflectance 0.99 0.99 0.99"));
}

}  // namespace
}  // namespace torolux
