// SPDX-License-Identifier: MIT
// `torolux render` as a user sees it: all files and figures of a small picture, the same bytes every time and
// from saved radiosities, and nothing left behind where it is ended or an engine dies.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "emulator/engines/engine_names.hpp"
#include "tests/machine/process.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux::test {
namespace {

using testing::HasSubstr;
using testing_support::TemporaryFolder;

using Arguments = std::vector<std::string>;

/// A few seconds' render of the Cornell box.
Arguments small_render(const Arguments& more) {
  Arguments arguments = small_render_options();
  arguments.insert(arguments.begin(), {"render", std::string(TOROLUX_SOURCE_DIR) + "/scenes/cornell_box"});
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

TEST(Render, WritesAllThatWasAskedFor) {
  const TemporaryFolder folder;
  const auto file = [&](const char* name) { return (folder.path() / name).string(); };
  const Finished run = run_torolux(small_render(
      {"--output", file("a.png"), "--output", file("a.exr"), "--output", file("a.pfm"), "--stats", file("a.json")}));
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  for (const char* name : {"a.png", "a.exr", "a.pfm"}) EXPECT_THAT(run.output, HasSubstr(file(name) + " (16 x 12)"));
  EXPECT_THAT(contents(file("a.png")), testing::StartsWith("\x89PNG"));
  EXPECT_THAT(contents(file("a.pfm")), testing::StartsWith("PF\n16 12\n-1.0\n"));
  EXPECT_EQ(folder.files(), 4U);

  const nlohmann::json stats = statistics(file("a.json"));
  EXPECT_EQ(stats["shots"], 6);
  EXPECT_EQ(stats["pes"].size(), 4U);
  EXPECT_EQ(stats["credits"]["home"], stats["credits"]["total"]);
  EXPECT_EQ(stats["packets"]["sent"], stats["packets"]["delivered"]);
  EXPECT_LT(stats["energy"]["closing_error"], 1e-12) << "integers: only their conversion to watts rounds";
  EXPECT_GT(stats["energy"]["emitted"][0], 0);
  for (const char* stage : {"load", "radiosity", "ray_tracing"}) EXPECT_GT(stats["virtual_cycles"][stage], 0) << stage;

  const Finished compared = run_torolux({"compare", file("a.exr"), file("a.pfm")});
  EXPECT_EQ(compared.exit_code, 0) << compared.errors;
  EXPECT_THAT(compared.output, testing::ContainsRegex("differing pixels +0\n"));
}

TEST(Render, APathsPicturesAreThoseOfRendersFromThere) {
  const TemporaryFolder folder;
  const auto file = [&](const char* name) { return (folder.path() / name).string(); };
  std::ofstream(file("walk.toml")) << "[[camera]]\neye = [278, 273, -800]\nlook_at = [278, 273, 0]\n"
                                      "[[camera]]\neye = [178, 373, -700]\nlook_at = [278, 273, 0]\n";
  const Finished walk = run_torolux(small_render(
      {"--path", file("walk.toml"), "--output", file("w.exr"), "--output", file("w.png"), "--stats", file("w.json")}));
  ASSERT_EQ(walk.exit_code, 0) << walk.errors;
  const Finished second =
      run_torolux(small_render({"--eye", "178,373,-700", "--look-at", "278,273,0", "--output", file("b.exr"),
                                "--output", file("b.png"), "--stats", file("b.json")}));
  ASSERT_EQ(second.exit_code, 0) << second.errors;
  EXPECT_EQ(contents(file("w.0002.exr")), contents(file("b.exr")));
  EXPECT_EQ(contents(file("w.0002.png")), contents(file("b.png")));
  EXPECT_NE(contents(file("w.0001.exr")), contents(file("b.exr")));
  EXPECT_FALSE(std::filesystem::exists(file("w.exr")));
  const nlohmann::json stats = statistics(file("w.json"));
  EXPECT_EQ(stats["path"].at(1)["sha256"], statistics(file("b.json"))["picture"]["sha256"]);
  EXPECT_EQ(stats["path"].at(0)["sha256"], stats["picture"]["sha256"]);

  EXPECT_EQ(run_torolux({"rerun", file("w.json")}).exit_code, 0);

  const Finished both = run_torolux(small_render({"--path", file("walk.toml"), "--eye", "1,2,3"}));
  EXPECT_EQ(both.exit_code, 1);
  EXPECT_THAT(both.errors, HasSubstr("--path"));
}

// A room of 6 x 3 x 6 m, fronts inwards, or outwards; its lamp, 2 x 2 m; a box in it; another skin around the room.
struct Room {
  const char* name;
  std::string obj;
  const char* eye;
  std::vector<const char*> told;     ///< by `info` and `render`
  const char* told_after = nullptr;  ///< by `render` alone
};

std::string level_square(const char* material, double height, bool up) {
  std::string text = std::string("usemtl ") + material + "\n";
  for (const char* xz : {"-1 -1", "1 -1", "1 1", "-1 1"}) {
    const std::string both = xz;
    const std::size_t blank = both.find(' ');
    text += "v " + both.substr(0, blank) + " " + std::to_string(height) + both.substr(blank) + "\n";
  }
  return text + (up ? "f -1 -2 -3 -4\n" : "f -4 -3 -2 -1\n");
}

const std::string kInwards = "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 4 1 5 8\nf 2 3 7 6\nf 3 4 8 7\n";
const std::string kOutwards = "f 1 2 3 4\nf 8 7 6 5\nf 5 6 2 1\nf 8 5 1 4\nf 6 7 3 2\nf 7 8 4 3\n";
const std::string kSmallBox =
    "usemtl box\nv 1 1 1\nv 2 1 1\nv 2 1 2\nv 1 1 2\nv 1 2 1\nv 2 2 1\nv 2 2 2\nv 1 2 2\n"
    "f -5 -6 -7 -8\nf -4 -3 -2 -1\nf -8 -7 -3 -4\nf -5 -8 -4 -1\nf -7 -6 -2 -3\nf -6 -5 -1 -2\n";
constexpr const char* kInRoom = "[0, 1.6, 2.8]";

const std::vector<Room> kRooms{
    {"sound", kInwards + level_square("lamp", 2.9, false), kInRoom, {}},
    {"doubled", kInwards + kOutwards + level_square("lamp", 2.9, false), kInRoom, {"a surface that stands twice"}},
    {"overlapping", kInwards + level_square("lamp", 3, false), kInRoom, {"'lamp' on 'wall'"}},
    {"inverted", kInwards + level_square("lamp", 2.9, false) + kSmallBox, kInRoom, {"has its fronts inwards"}},
    {"room_inside_out", kOutwards + level_square("lamp", 2.9, false) + kSmallBox, kInRoom, {"has its fronts outwards"}},
    {"lamp_to_wall", kInwards + level_square("lamp", 2.9, true), kInRoom, {"face a surface close before them"}},
    {"lamp_above",
     kInwards + level_square("lamp", 3.1, false),
     kInRoom,
     {"'wall' stands between"},
     "the picture is black"},
    {"lamp_away",
     kInwards + level_square("lamp", 3, true),
     kInRoom,
     {"'lamp' turns its back"},
     "lamps that face away?"},
    {"camera_outside",
     kInwards + level_square("lamp", 2.9, false),
     "[0, 1.6, 8]",
     {"back sides only ('wall' most)"},
     "the picture is black"}};

// What changes a picture greatly is told by both, word by word.
TEST(Render, TellsWhatInfoTells) {
  const TemporaryFolder folder;
  const auto write = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder.path() / name) << text;
    return (folder.path() / name).string();
  };
  write("room.mtl", "newmtl wall\nKd 0.6 0.6 0.6\nnewmtl box\nKd 0.3 0.3 0.6\nnewmtl lamp\nKd 0 0 0\nKe 8 8 8\n");
  for (const Room& room : kRooms) {
    write("room.obj",
          "mtllib room.mtl\nv -3 0 -3\nv 3 0 -3\nv 3 0 3\nv -3 0 3\nv -3 3 -3\nv 3 3 -3\nv 3 3 3\nv -3 3 3\n"
          "usemtl wall\n" +
              room.obj);
    const std::string scene = write("room.toml", std::string("[camera]\neye = ") + room.eye +
                                                     "\nlook_at = [0, 1.2, -3]\n[[mesh]]\nfile = 'room.obj'\n");
    Arguments arguments = small_render_options();
    arguments.insert(arguments.begin(), {"render", scene, "--output", (folder.path() / "room.pfm").string()});
    const Finished render = run_torolux(arguments);
    const Finished info = run_torolux({"info", scene});
    ASSERT_EQ(render.exit_code, 0) << render.errors;
    for (const char* told : room.told) {
      EXPECT_THAT(info.output, HasSubstr(told)) << room.name;
      EXPECT_THAT(render.errors, HasSubstr(told)) << room.name;
    }
    if (room.told.empty()) {
      EXPECT_THAT(render.errors, testing::Not(testing::ContainsRegex("note: [^m]"))) << room.name;
    }
    if (room.told_after != nullptr) {
      EXPECT_THAT(render.errors, HasSubstr(room.told_after)) << room.name;
    }
  }
}

TEST(Render, IsTheSameEveryTime) {
  const TemporaryFolder folder;
  const auto run = [&](const std::string& name, const Arguments& more) {
    Arguments arguments = {"--quiet", "--output", folder.path() / (name + ".png"), "--stats",
                           folder.path() / (name + ".json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Finished finished = run_torolux(small_render(arguments));
    EXPECT_EQ(finished.exit_code, 0) << finished.errors;
    EXPECT_EQ(finished.output + finished.errors, "") << "--quiet";
  };
  run("first", {});
  const std::vector<Arguments> others = {{"--threads", "1"}, {"--threads", "3"}, {"--engine", "qemu"}};
  for (const Arguments& other : others) {
    run("other", other);
    EXPECT_EQ(contents(folder.path() / "first.png"), contents(folder.path() / "other.png")) << other[1];
    EXPECT_EQ(statistics(folder.path() / "first.json"), statistics(folder.path() / "other.json")) << other[1];
  }
}

TEST(Render, SavedRadiositiesGiveTheSameViewWithoutShots) {
  const TemporaryFolder folder;
  const auto file = [&](const char* name) { return (folder.path() / name).string(); };
  const Arguments camera = {"--eye", "100,300,-500", "--look-at", "278,273,300"};
  const auto with_camera = [&](Arguments more) {
    more.insert(more.end(), camera.begin(), camera.end());
    return small_render(more);
  };
  ASSERT_EQ(run_torolux(small_render({"--output", file("other.pfm"), "--save-radiosity", file("a.rad")})).exit_code, 0);
  ASSERT_EQ(run_torolux(with_camera({"--output", file("whole.pfm")})).exit_code, 0);
  const Finished view = run_torolux(
      with_camera({"--output", file("view.pfm"), "--radiosity", file("a.rad"), "--stats", file("view.json")}));
  ASSERT_EQ(view.exit_code, 0) << view.errors;
  EXPECT_EQ(contents(file("view.pfm")), contents(file("whole.pfm")));
  EXPECT_NE(contents(file("view.pfm")), contents(file("other.pfm")));
  EXPECT_EQ(statistics(file("view.json"))["shots"], 0);

  std::filesystem::resize_file(file("a.rad"), std::filesystem::file_size(file("a.rad")) / 2);
  const Finished damaged = run_torolux(with_camera({"--output", file("none.pfm"), "--radiosity", file("a.rad")}));
  EXPECT_EQ(damaged.exit_code, 2);
  EXPECT_THAT(damaged.errors, HasSubstr("a.rad"));
  EXPECT_FALSE(std::filesystem::exists(file("none.pfm")));
}

// A refined file, too: what its splits were chosen for is refused, and the options that mend it do; what they do not
// depend on gives the picture of a full run.
TEST(Render, RefinedRadiositiesServeTheirOwnSettingsAlone) {
  const TemporaryFolder folder;
  const auto file = [&](const char* name) { return (folder.path() / name).string(); };
  const auto refined = [&](Arguments more) {
    more.insert(more.begin(), {"--refine", "0.5", "--direct", "shadow-rays", "--quiet"});
    return run_torolux(small_render(more));
  };
  ASSERT_EQ(refined({"--output", file("a.pfm"), "--save-radiosity", file("a.rad")}).exit_code, 0);
  for (const Arguments& other : {Arguments{"--direct", "radiosity"}, {"--refine", "0.25"}, {"--seed", "2"}}) {
    Arguments more{"--output", file("b.pfm"), "--radiosity", file("a.rad")};
    const std::vector<std::string> given{"--refine", "0.5", "--direct", "shadow-rays", "--quiet"};
    for (std::size_t i = 0; i + 1 < given.size(); i += 2)
      if (given[i] != other[0]) more.insert(more.end(), {given[i], given[i + 1]});
    more.insert(more.end(), other.begin(), other.end());
    const Finished run = run_torolux(small_render(more));
    EXPECT_EQ(run.exit_code, 2) << other[0];
    EXPECT_THAT(run.errors, HasSubstr("give " + other[0] + " ")) << other[0];
  }
  const Arguments view{"--filter",  "tent",        "--eye",        "100,300,-500",
                       "--look-at", "278,273,300", "--allocation", "skewed"};
  const auto with_view = [&](Arguments more) {
    more.insert(more.end(), view.begin(), view.end());
    return refined(more);
  };
  ASSERT_EQ(with_view({"--output", file("whole.pfm")}).exit_code, 0);
  ASSERT_EQ(with_view({"--output", file("view.pfm"), "--radiosity", file("a.rad")}).exit_code, 0);
  EXPECT_EQ(contents(file("view.pfm")), contents(file("whole.pfm")));
}

/// A render that goes on for minutes.
class LongRender : public testing::Test {
 protected:
  explicit LongRender(const char* engine = kDefaultEngine)
      : run_(small_render({"--hemicube", "256", "--shot-points", "16", "--max-shots", "0", "--output",
                           folder_.path() / "a.png", "--stats", folder_.path() / "a.json", "--save-radiosity",
                           folder_.path() / "a.rad", "--engine", engine})) {}

  void interrupt() {
    run_.signal(SIGINT);
    const Finished end = run_.wait();
    EXPECT_EQ(end.exit_code, 130);
    EXPECT_EQ(end.errors.substr(end.errors.find("torolux: interrupted")), "torolux: interrupted\n");
    EXPECT_EQ(folder_.files(), 0U);
  }

  TemporaryFolder folder_;
  ToroluxProcess run_;
};

class LongRenderOnQemu : public LongRender {
 protected:
  LongRenderOnQemu() : LongRender("qemu"), qemus_(run_.children(4)) {}
  void SetUp() override { ASSERT_EQ(qemus_.size(), 4U); }

  std::vector<pid_t> qemus_;
};

TEST_F(LongRender, CtrlCLeavesNothingBehind) {
  std::this_thread::sleep_for(std::chrono::seconds(1));
  interrupt();
}

TEST_F(LongRenderOnQemu, CtrlCLeavesNothingBehind) {
  interrupt();
  EXPECT_TRUE(all_gone(qemus_));
}

TEST_F(LongRenderOnQemu, AKilledQemuIsNamedAndLeavesNoFiles) {
  ASSERT_EQ(::kill(qemus_[2], SIGKILL), 0);
  const Finished end = run_.wait();
  EXPECT_EQ(end.exit_code, 3);
  EXPECT_THAT(end.errors, HasSubstr("PE 2"));
  EXPECT_TRUE(all_gone(qemus_));
  EXPECT_EQ(folder_.files(), 0U);
}

}  // namespace
}  // namespace torolux::test
