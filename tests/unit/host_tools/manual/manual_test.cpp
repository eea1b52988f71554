// SPDX-License-Identifier: MIT
// Proves: man page and completions tell of every command and option that --help tells of, shells can read them, and
// bash offers what fits.
#include <gmock/gmock.h>

#include <cstdio>
#include <fstream>
#include <memory>
#include <regex>
#include <set>
#include <sstream>

#include "tests/support/temporary_folder.hpp"
#include "tests/unit/host_tools/cli/run_main.hpp"

namespace torolux {
namespace {

using testing::HasSubstr;
using testing_support::TemporaryFolder;

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// What a shell command prints.
std::string printed(const std::string& command) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(::popen(command.c_str(), "r"), ::pclose);
  std::string text;
  for (int c = std::fgetc(pipe.get()); c != EOF; c = std::fgetc(pipe.get())) text += static_cast<char>(c);
  return text;
}

std::set<std::string> options_in(const std::string& help) {
  std::set<std::string> options;
  const std::regex option("\\n  (?:-[a-z],)?(--[a-z-]+)");
  for (auto match = std::sregex_iterator(help.begin(), help.end(), option); match != std::sregex_iterator(); ++match)
    options.insert((*match)[1]);
  return options;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

class Manual : public testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(torolux({"manual", folder_.path().string()}).code, 0); }

  /// What bash offers for the last of these words.
  std::string offered(const std::string& words) const {
    return printed("bash -c 'source " + (folder_.path() / "torolux.bash").string() + "; COMP_WORDS=(" + words +
                   "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _torolux; echo \" ${COMPREPLY[*]} \"'");
  }

  TemporaryFolder folder_;
};

TEST_F(Manual, TellsOfEveryOptionThatHelpTellsOf) {
  const std::string page = replaced(text_of(folder_.path() / "torolux.1"), "\\-", "-");
  const std::string zsh = text_of(folder_.path() / "_torolux"), fish = text_of(folder_.path() / "torolux.fish");
  for (const std::string command :
       {"render", "info", "compare", "tonemap", "run", "network", "lockstep", "bench engine", "rerun", "study"}) {
    std::istringstream words(command);
    std::vector<std::string> arguments{std::istream_iterator<std::string>(words), {}};
    arguments.emplace_back("--help");
    const auto options = options_in(torolux(arguments).out);
    EXPECT_GE(options.size(), 2U) << command;
    const std::size_t begin = page.find(".SS \\fBtorolux " + command);
    ASSERT_NE(begin, std::string::npos) << command;
    const std::string section = page.substr(begin, page.find(".S", begin + 3) - begin);
    const std::string from_bash = offered("torolux " + command + " --");
    for (const std::string& option : options) {
      EXPECT_THAT(section, HasSubstr("\\fB" + option + "\\fR")) << command;
      EXPECT_THAT(from_bash, HasSubstr(" " + option + " ")) << command;
      EXPECT_THAT(zsh, HasSubstr("*" + option + "[")) << command;
      EXPECT_THAT(fish, HasSubstr(" -l " + option.substr(2) + " ")) << command;
    }
  }
}

TEST_F(Manual, BashOffersWhatFits) {
  EXPECT_EQ(offered("torolux re"), " render rerun \n");
  EXPECT_EQ(offered("torolux bench e"), " engine emulator \n");
  EXPECT_EQ(offered("torolux render --quality \"\""), " draft normal fine \n");
  EXPECT_EQ(offered("torolux render --missing-materials w"), " white \n");
  EXPECT_EQ(offered("torolux render cornell"), " cornell_box cornell_spheres \n");
  EXPECT_EQ(offered("torolux render --size 1"), "  \n") << "no file is a size";
}

TEST(ManualOptions, AreNotToldOfInHelp) {
  EXPECT_THAT(torolux({"--help"}).out, testing::Not(HasSubstr("manual")));
  const Outcome nowhere = torolux({"manual", "/nowhere/at/all"});
  EXPECT_EQ(nowhere.code, 2);
  EXPECT_THAT(nowhere.err, HasSubstr("/nowhere/at/all"));
}

}  // namespace
}  // namespace torolux
