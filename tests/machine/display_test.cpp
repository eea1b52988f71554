// SPDX-License-Identifier: MIT
// Proves: a run with a display, looked at or not, by a page that reads slowly or goes away, gives the bytes, cycles and
// statistics of a run without; it answers as `torolux inspect` does; it ends when a page or Ctrl-C says so; what stands
// on the command line is checked.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/machine/process.hpp"
#include "tests/support/raw_http.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux::test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing_support::command_request;
using testing_support::get_request;
using testing_support::port_of;
using testing_support::RawHttp;
using testing_support::response_to;
using testing_support::status_of;
using testing_support::TemporaryFolder;

const std::string kScene = std::string(TOROLUX_SOURCE_DIR) + "/scenes/cornell_box";
const std::string kHello = std::string(TOROLUX_FIRMWARE_DIR) + "/hello.elf";

std::vector<std::string> render_words(const TemporaryFolder& folder, const std::string& name) {
  std::vector<std::string> words = {"render", kScene};
  for (const char* word : {"--quality", "draft", "--size", "160x120", "--pes", "3x2", "--max-shots", "40", "--quiet"})
    words.emplace_back(word);
  words.insert(words.end(), {"--output", (folder.path() / (name + ".exr")).string(), "--stats",
                             (folder.path() / (name + ".json")).string()});
  return words;
}

/// The port of its display, once it is told.
int display_port(const ToroluxProcess& process) {
  for (int i = 0; i < 400; ++i) {
    const std::string told = process.errors_so_far();
    const std::size_t at = told.find("http://");
    if (at != std::string::npos && told.find('\n', at) != std::string::npos) return port_of(told.substr(at));
    std::this_thread::sleep_for(25ms);
  }
  ADD_FAILURE() << "no display: " << process.errors_so_far();
  return 0;
}

/// Waits for the last message but `bye`: the results are there.
void wait_until_done(int port) {
  const RawHttp page(port);
  page.send(get_request(port, "/stream"));
  std::string told;
  while (told.find("\"state\":\"done\"") == std::string::npos) {
    const std::string more = page.receive(5s, 1);
    ASSERT_FALSE(more.empty()) << "the stream has ended";
    told = told.substr(told.size() - std::min<std::size_t>(told.size(), 64)) + more;
  }
}

void expect_same(const TemporaryFolder& folder, const std::string& a, const std::string& b) {
  EXPECT_EQ(contents(folder.path() / (a + ".exr")), contents(folder.path() / (b + ".exr")));
  EXPECT_EQ(statistics(folder.path() / (a + ".json")), statistics(folder.path() / (b + ".json")));
}

TEST(Display, ChangesNothingOfARender) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_torolux(render_words(folder, "unseen")).exit_code, 0);
  std::vector<std::string> words = render_words(folder, "seen");
  words.insert(words.end(), {"--display", "0"});
  ToroluxProcess process(words);
  const int port = display_port(process);
  const RawHttp slow(port, 2048);  // asks, and never reads
  slow.send(get_request(port, "/stream"));
  RawHttp gone(port);
  gone.send(get_request(port, "/stream"));
  gone.receive(2s, 1);
  gone.close();
  wait_until_done(port);
  EXPECT_EQ(status_of(response_to(port, command_request(port, R"({"do": "end"})"))), 202);
  const Finished finished = process.wait();
  EXPECT_EQ(finished.exit_code, 0) << finished.errors;
  expect_same(folder, "unseen", "seen");
}

/// What the run answers to a question; empty object: nothing that is JSON.
nlohmann::json answer_to(int port, const std::string& question) {
  const std::string response = response_to(port, command_request(port, R"({"do": "ask", )" + question + "}"));
  EXPECT_EQ(status_of(response), 200) << response;
  const std::size_t begin = response.find("\r\n\r\n");
  return nlohmann::json::parse(begin == std::string::npos ? "{}" : response.substr(begin + 4), nullptr, false);
}

/// The answers of a display are those of `torolux inspect`, whatever has been looked at in between.
TEST(Display, AnswersQuestions) {
  const TemporaryFolder folder;
  std::vector<std::string> words = render_words(folder, "asked");
  words.insert(words.end(), {"--samples", "2", "--replicate", "0", "--display", "0"});
  ToroluxProcess process(words);
  const int port = display_port(process);
  EXPECT_THAT(answer_to(port, R"("pe": 1)").value("error", ""), HasSubstr("once a picture is rendered"));
  wait_until_done(port);
  const auto json = folder.path() / "answers.json";
  const Finished inspected =
      run_torolux({"inspect",     kScene,      "--quality", "draft", "--size",      "160x120", "--pes",      "3x2",
                   "--max-shots", "40",        "--samples", "2",     "--replicate", "0",       "--quiet",    "--pixel",
                   "50,90:1",     "--element", "50,90",     "--pe",  "4",           "--json",  json.string()});
  ASSERT_EQ(inspected.exit_code, 0) << inspected.errors;
  const auto expected = nlohmann::json::parse(contents(json));

  nlohmann::json pixel = answer_to(port, R"("pixel": [50, 90, 1])")["pixel"];
  EXPECT_EQ(pixel["radiance"], expected["pixel"]["radiance"]);
  EXPECT_EQ(pixel["element"], expected["pixel"]["element"]);
  const nlohmann::json& story = pixel["story"];  // which PE makes the ray depends on when: the way differs
  ASSERT_GT(story.size(), 3U);
  EXPECT_THAT(story.front()["what"].get<std::string>(), HasSubstr("gets the tile of"));
  EXPECT_THAT(story.back()["what"].get<std::string>(), HasSubstr("the pixel has got"));
  EXPECT_TRUE(std::ranges::any_of(story, [](const auto& event) { return event.contains("routers"); }));

  nlohmann::json element = answer_to(port, R"("element": [50, 90])")["element"];
  std::uint64_t seen = 0;
  for (const auto& run : element["seen"]) seen += run[1].get<std::uint64_t>();
  EXPECT_GT(seen, 0U);
  EXPECT_EQ(seen, element["pixels"]);
  element.erase("seen");
  EXPECT_EQ(element, expected["element"]);

  nlohmann::json pe = answer_to(port, R"("pe": 4)")["pe"];
  EXPECT_EQ(pe["seen_as"], "subspaces");
  EXPECT_GT(pe["pixels"], 0);
  EXPECT_FALSE(pe["seen"].empty());
  for (const char* key : {"stages", "figures", "pixels", "box"}) EXPECT_EQ(pe[key], expected["pe"][key]) << key;

  for (const char* wrong : {R"("pe": 6)", R"("pe": -1)", R"("pe": 4294967300)", R"("element": 4294967290)",
                            R"("element": [160, 0])", R"("pixel": [0, 0, 2])", R"("pixel": 3)", R"("none": 1)"})
    EXPECT_NE(answer_to(port, wrong).value("error", ""), "") << wrong;
  process.signal(SIGINT);
  EXPECT_EQ(process.wait().exit_code, 0);
}

TEST(Display, StaysUntilCtrlC) {
  ToroluxProcess process({"run", kHello, "--display", "0"});
  const int port = display_port(process);
  wait_until_done(port);
  std::this_thread::sleep_for(200ms);
  EXPECT_EQ(status_of(response_to(port, get_request(port, "/"))), 200);
  process.signal(SIGINT);
  const Finished finished = process.wait();
  EXPECT_EQ(finished.exit_code, 0);
  EXPECT_THAT(finished.output, HasSubstr("Hello from PE 15 of 16"));
}

TEST(Display, EndsARunThatGoesOn) {
  const TemporaryFolder folder;
  std::vector<std::string> words = {"render", kScene,     "--quality",
                                    "fine",   "--quiet",  "--display",
                                    "0",      "--output", (folder.path() / "x.exr").string()};
  ToroluxProcess process(words);
  const int port = display_port(process);
  EXPECT_EQ(status_of(response_to(port, command_request(port, R"({"do": "end"})"))), 202);
  EXPECT_EQ(process.wait().exit_code, 130);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "x.exr"));
}

TEST(Display, OpensABrowser) {
  const TemporaryFolder folder;
  const auto opened = folder.path() / "opened";
  {
    std::ofstream script(folder.path() / "xdg-open");
    script << "#!/bin/sh\necho \"$1\" > " << opened << ".part\nmv " << opened << ".part " << opened << "\n";
  }
  std::filesystem::permissions(folder.path() / "xdg-open", std::filesystem::perms::owner_all);
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", (folder.path().string() + ":" + path).c_str(), 1);
  ToroluxProcess process({"run", kHello, "--display", "0", "--open"});
  ::setenv("PATH", path.c_str(), 1);
  const int port = display_port(process);
  for (int i = 0; i < 200 && !std::filesystem::exists(opened); ++i) std::this_thread::sleep_for(25ms);
  EXPECT_EQ(contents(opened), "http://127.0.0.1:" + std::to_string(port) + "/\n");
  process.signal(SIGINT);
  process.wait();
}

TEST(Display, ChecksItsOptions) {
  const auto refused = [](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"run", kHello};
    words.insert(words.end(), more.begin(), more.end());
    const Finished finished = run_torolux(words);
    EXPECT_NE(finished.exit_code, 0);
    return finished.errors;
  };
  EXPECT_THAT(refused({"--open"}), HasSubstr("--display asks for that"));
  EXPECT_THAT(refused({"--display-address", "0.0.0.0"}), HasSubstr("--display asks for that"));
  EXPECT_THAT(refused({"--display", "70000"}), HasSubstr("65535"));
  EXPECT_THAT(refused({"--display", "scenes"}), HasSubstr("\"scenes\" is not a port"));
  ToroluxProcess first({"run", kHello, "--display", "0"});
  const int port = display_port(first);
  EXPECT_THAT(refused({"--display", std::to_string(port)}), HasSubstr("--display 0 takes any that is free"));
  wait_until_done(port);  // Ctrl-C before the run's end is another exit code
  first.signal(SIGINT);
  EXPECT_EQ(first.wait().exit_code, 0);
}

}  // namespace
}  // namespace torolux::test
