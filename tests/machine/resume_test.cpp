// SPDX-License-Identifier: MIT
// `torolux render --checkpoint` and `--resume` from outside: killed at moments by chance, interrupted, and given files
// that are not of the run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <random>
#include <thread>

#include "tests/machine/process.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux::test {
namespace {

using testing::HasSubstr;
using Words = std::vector<std::string>;

constexpr unsigned kKills = 20;

/// A scene that takes a second or two, and what more is given.
Words render_words(const Words& more, const std::string& engine = "translated") {
  const bool slow = engine == "qemu";
  Words words = {"render",      std::string(TOROLUX_SOURCE_DIR) + "/scenes/cornell_box",
                 "--quality",   "draft",
                 "--size",      slow ? "16x16" : "64x64",
                 "--max-shots", slow ? "6" : "60",
                 "--pes",       "2x2",
                 "--threads",   "1",
                 "--engine",    engine,
                 "--quiet"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

struct Results {
  std::string picture;
  nlohmann::json figures;

  bool operator==(const Results&) const = default;
};

Words joined(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// With a folder of its own.
class Resume : public testing::Test {
 protected:
  std::filesystem::path here(const std::string& name) const { return folder_.path() / name; }

  Words into(const std::string& name) const {
    return {"--output", here(name + ".exr").string(), "--stats", here(name + ".json").string()};
  }

  Results results(const std::string& name) const {
    return {contents(here(name + ".exr")), statistics(here(name + ".json"))};
  }

  void expect_kills_do_not_show(const std::string& engine, unsigned kills, double most_seconds) const;

 private:
  const testing_support::TemporaryFolder folder_;
};

/// Kills runs until so many have been killed, each going on from what the one before it has left; whoever gets to its
/// end must have the same results.
void Resume::expect_kills_do_not_show(const std::string& engine, unsigned kills, double most_seconds) const {
  const Words same = {"--checkpoint", here("kill.ckpt").string(), "--checkpoint-minutes",
                      engine == "qemu" ? "0.01" : "0.0005"};
  const Finished whole = run_torolux(render_words(into("whole"), engine));
  ASSERT_EQ(whole.exit_code, 0) << whole.errors;
  const Results expected = results("whole");
  std::mt19937 random(16);
  unsigned ends = 0;
  for (unsigned killed = 0; killed < kills || ends == 0;) {
    Words words = joined(into("kill"), same);
    if (std::filesystem::exists(here("kill.ckpt"))) words = joined(words, {"--resume", here("kill.ckpt").string()});
    ToroluxProcess process(render_words(words, engine));
    if (killed < kills) {
      const double seconds = std::uniform_real_distribution(0.05, most_seconds)(random);
      std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
      process.signal(SIGKILL);
    }
    const Finished end = process.wait();
    if (end.exit_code == 128 + SIGKILL) {
      ++killed;
      continue;
    }
    ASSERT_EQ(end.exit_code, 0) << end.errors;
    EXPECT_EQ(results("kill"), expected);
    std::filesystem::remove(here("kill.ckpt"));
    ++ends;
    if (killed < kills) ++killed;  // it was too fast for that one
  }
}

TEST_F(Resume, KillsDoNotShow) {
  expect_kills_do_not_show("translated", kKills, 0.6);
}

TEST_F(Resume, KillsOfQemuDoNotShow) {
  expect_kills_do_not_show("qemu", 3, 2.5);
}

TEST_F(Resume, CtrlCSavesAndSaysHowToGoOn) {
  ASSERT_EQ(run_torolux(render_words(into("whole"))).exit_code, 0);
  const std::string file = here("ctrl_c.ckpt").string();
  Words words = render_words(joined(into("first"), {"--checkpoint", file, "--checkpoint-minutes", "0.0001"}));
  std::erase(words, "--quiet");
  ToroluxProcess process(words);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!std::filesystem::exists(file) && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  process.signal(SIGINT);
  const Finished end = process.wait();
  ASSERT_EQ(end.exit_code, 130) << end.errors;
  EXPECT_THAT(end.errors, HasSubstr("--resume " + file));
  const Words on = {"--resume", file};
  ASSERT_EQ(run_torolux(render_words(joined(into("on"), on))).exit_code, 0);
  EXPECT_EQ(results("on"), results("whole"));
  // One that has come to its end goes on, too: there is little left to do.
  ASSERT_EQ(run_torolux(render_words(joined(into("first"), {"--checkpoint", here("end.ckpt").string()}))).exit_code, 0);
  ASSERT_EQ(run_torolux(render_words(joined(into("on"), {"--resume", here("end.ckpt").string()}))).exit_code, 0);
  EXPECT_EQ(results("on"), results("whole"));
}

void expect_refused(const Words& more, const std::string& why, int exit_code = 2) {
  const Finished end = run_torolux(render_words(joined({"--no-picture"}, more)));
  EXPECT_EQ(end.exit_code, exit_code) << why;
  EXPECT_THAT(end.errors, HasSubstr(why));
}

void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

TEST_F(Resume, RefusesWhatIsNotOfThisRun) {
  const std::string file = here("good.ckpt").string();
  ASSERT_EQ(run_torolux(render_words({"--no-picture", "--checkpoint", file})).exit_code, 0);
  const Words resume = {"--resume", file};
  expect_refused(joined(resume, {"--seed", "2"}), "seed: was 1, is 2");
  expect_refused(joined(resume, {"--size", "64x32"}), "height: was 64, is 32");
  expect_refused(joined(resume, {"--pes", "4x2"}), "pes.0: was 2, is 4");
  expect_refused(joined(resume, {"--set", "torus.link_cycles=2"}), "machine.torus.link_cycles: was 1, is 2");
  expect_refused(joined(resume, {"--eye", "278,273,-700"}), "camera.eye");
  Words other = joined(render_words({"--no-picture"}), resume);
  other[1] = std::string(TOROLUX_SOURCE_DIR) + "/scenes/cornell_spheres";
  EXPECT_THAT(run_torolux(other).errors, HasSubstr("cornell_spheres/scene.toml has changed"));
  expect_refused(joined(resume, {"--trace", here("t.pftrace").string()}), "--trace", 1);
  expect_refused({"--checkpoint-rounds", "3"}, "--checkpoint FILE", 1);

  const std::string good = contents(file);
  const std::string bad = here("bad.ckpt").string();
  const Words damaged = {"--resume", bad};
  write(bad, good.substr(0, good.size() / 2));
  expect_refused(damaged, "damaged or cut short");
  write(bad, good.substr(0, 10));
  expect_refused(damaged, "damaged or cut short");
  for (const std::size_t at : {std::size_t{9}, std::size_t{200}, good.size() / 2, good.size() - 1}) {
    std::string changed = good;
    changed[at] = static_cast<char>(changed[at] ^ 1);
    write(bad, changed);
    expect_refused(damaged, "damaged or cut short");
  }
  std::string newer = good;
  newer[6] = static_cast<char>(newer[6] + 1);
  write(bad, newer);
  expect_refused(damaged, "a checkpoint of version");
  write(bad, "no checkpoint at all, but long enough to be one, if it were one");
  expect_refused(damaged, "is no checkpoint of torolux");
  expect_refused({"--resume", here("nowhere.ckpt").string()}, "cannot be read");
}

}  // namespace
}  // namespace torolux::test
