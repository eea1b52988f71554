// SPDX-License-Identifier: MIT
// Proves: what PEs write comes out as whole lines; files are served by the names that were given, each PE at its own
// place; outputs are there only in the end.
#include <gmock/gmock.h>

#include <cstring>
#include <fstream>
#include <sstream>

#include "emulator/errors.hpp"
#include "emulator/printable.hpp"
#include "host_tools/run/lines.hpp"
#include "host_tools/run/served_files.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux {
namespace {

using protocol::FileAccess;
using protocol::FileError;
using protocol::FileOrigin;
using testing::ElementsAre;
using testing_support::bytes_of;
using testing_support::TemporaryFolder;

std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string contents_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

constexpr std::uint32_t bits(std::initializer_list<FileAccess> access) {
  std::uint32_t all = 0;
  for (const FileAccess bit : access) all |= static_cast<std::uint32_t>(bit);
  return all;
}
constexpr std::uint32_t kRead = bits({FileAccess::read});
constexpr std::uint32_t kWrite = bits({FileAccess::write, FileAccess::empty});
constexpr std::uint32_t kAppend = bits({FileAccess::write, FileAccess::append});

// ---- Lines ----

struct Heard {
  std::vector<std::string> lines;
  Lines all{[this](const PeText& text) {
    lines.push_back(std::to_string(text.pe) + (text.stream == PeStream::errors ? "! " : ": ") + text.text +
                    (text.ended ? "" : "|") + " @" + std::to_string(text.time));
  }};
};

TEST(Lines, LeaveWholeWhateverThePieces) {
  Heard heard;
  heard.all.add(3, PeStream::output, 10, bytes_of("one, "));
  heard.all.add(1, PeStream::output, 11, bytes_of("other\n\nnext"));
  heard.all.add(3, PeStream::errors, 12, bytes_of("error\n"));
  heard.all.add(3, PeStream::output, 13, bytes_of("two\n"));
  EXPECT_THAT(heard.lines, ElementsAre("1: other @11", "1:  @11", "3! error @12", "3: one, two @13"));
  heard.all.add(0, PeStream::errors, 14, bytes_of("left"));
  heard.lines.clear();
  heard.all.finish(20);
  EXPECT_THAT(heard.lines, ElementsAre("0! left| @20", "1: next| @20"));
}

TEST(Lines, AreCutWhereTheyHaveNoEnd) {
  Heard heard;
  heard.all.add(0, PeStream::output, 1, bytes_of(std::string(Lines::kLongest + 3, 'x')));
  ASSERT_EQ(heard.lines.size(), 1U);
  EXPECT_EQ(heard.lines[0].size(), Lines::kLongest + std::strlen("0: | @1"));
}

TEST(Lines, ControlCharactersAreNotShown) {
  EXPECT_EQ(printable("a\tb\x1b[1m\x7f"), "a\tb?[1m?");
}

// ---- Files ----

TEST(ServedFiles, InputsAreReadByEachPeFromItsOwnPlace) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "in") << "0123456789";
  ServedFiles files(read_inputs({{"data", folder.path() / "in"}}), {});
  const auto first = files.open(0, kRead, "data");
  const auto second = files.open(1, kRead, "data");
  ASSERT_EQ(first.error, FileError::none);
  EXPECT_EQ(text_of(files.read(0, {first.file, 4})), "0123");
  EXPECT_EQ(text_of(files.read(1, {second.file, 2})), "01");
  EXPECT_EQ(text_of(files.read(0, {first.file, 100})), "456789");
  EXPECT_EQ(text_of(files.read(0, {first.file, 100})), "");
  EXPECT_EQ(files.seek(0, {first.file, FileOrigin::end, -3}).position, 7U);
  EXPECT_EQ(text_of(files.read(0, {first.file, 100})), "789");
  EXPECT_EQ(files.seek(0, {first.file, FileOrigin::begin, -1}).error, FileError::bad_position);
  EXPECT_EQ(files.seek(0, {first.file, FileOrigin::position, std::int64_t{1} << 62U}).error, FileError::bad_position);
}

TEST(ServedFiles, InputsAreToldByWhatTheyHold) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "in") << "x";
  const auto digests = digests_of(read_inputs({{"data", folder.path() / "in"}}));
  ASSERT_EQ(digests.size(), 1U);
  EXPECT_EQ(digests[0], (InputFile{"input data", (folder.path() / "in").string(), sha256("x")}));
  EXPECT_THROW(read_inputs({{"data", folder.path() / "none"}}), InputError);
}

TEST(ServedFiles, NamesThatNobodyGaveAndWrongDirectionsAreRefused) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "in") << "x";
  ServedFiles files(read_inputs({{"in", folder.path() / "in"}}), {{"out", folder.path() / "out"}});
  EXPECT_EQ(files.open(0, kRead, "other").error, FileError::no_such_file);
  EXPECT_EQ(files.open(0, kWrite, "in").error, FileError::not_allowed);
  EXPECT_EQ(files.open(0, kRead, "out").error, FileError::not_allowed);
  EXPECT_EQ(files.open(0, kRead | kWrite, "out").error, FileError::not_allowed);
  EXPECT_EQ(files.open(0, 0, "out").error, FileError::not_allowed);
  for (std::uint32_t i = 0; i < protocol::kMostOpenFiles; ++i) EXPECT_EQ(files.open(0, kRead, "in").file, i);
  EXPECT_EQ(files.open(0, kRead, "in").error, FileError::too_many);
  files.close(0, 5);
  EXPECT_EQ(files.open(0, kRead, "in").file, 5U);
  EXPECT_THROW(files.read(1, {0, 1}), MachineFailure) << "another PE's";
  EXPECT_THROW(files.read(0, {protocol::kMostOpenFiles, 1}), MachineFailure);
  EXPECT_THROW(files.write(0, 0, bytes_of("x")), MachineFailure);
  EXPECT_THROW(files.append_to_host_file(0, bytes_of("x")), MachineFailure);
}

TEST(ServedFiles, OutputsAreWrittenByManyAndThereInTheEnd) {
  const TemporaryFolder folder;
  ServedFiles files({}, {{"out", folder.path() / "out"}, {"host", folder.path() / "host"}});
  const auto zero = files.open(0, kWrite, "out");
  const auto one = files.open(1, kWrite, "out");
  files.write(0, zero.file, bytes_of("aaaa"));
  EXPECT_EQ(files.seek(1, {one.file, FileOrigin::begin, 6}).position, 6U);
  files.write(1, one.file, bytes_of("bb"));
  files.write(0, zero.file, bytes_of("a"));
  const auto last = files.open(2, kAppend, "out");
  files.write(2, last.file, bytes_of("end"));
  files.append_to_host_file(1, bytes_of("raw"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "out"));
  EXPECT_THAT(files.finish(), ElementsAre());
  EXPECT_EQ(contents_of(folder.path() / "out"), std::string("aaaaa\0bbend", 11));
  EXPECT_EQ(contents_of(folder.path() / "host"), "raw");
}

TEST(ServedFiles, OneWriterEmptiesWhatItWroteAndManyDoNot) {
  const TemporaryFolder folder;
  ServedFiles files({}, {{"out", folder.path() / "out"}});
  const auto write = [&](PeNumber pe, const std::string& text) {
    const auto file = files.open(pe, kWrite, "out");
    files.write(pe, file.file, bytes_of(text));
    files.close(pe, file.file);
  };
  write(0, "long and longer");
  write(0, "short one");
  write(1, "S");
  EXPECT_THAT(files.finish(), ElementsAre());
  EXPECT_EQ(contents_of(folder.path() / "out"), "Short one");
}

TEST(ServedFiles, OutputsThatNobodyOpenedStayAsTheyWere) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "unused") << "of an earlier run";
  ServedFiles files({}, {{"unused", folder.path() / "unused"}, {"empty", folder.path() / "empty"}});
  files.open(0, kWrite, "empty");
  EXPECT_THAT(files.finish(), ElementsAre("unused"));
  EXPECT_EQ(contents_of(folder.path() / "unused"), "of an earlier run");
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "empty"));
}

TEST(ServedFiles, AreLeftNowhereWithoutAnEnd) {
  const TemporaryFolder folder;
  {
    ServedFiles files({}, {{"out", folder.path() / "out"}});
    files.write(0, files.open(0, kWrite, "out").file, bytes_of("x"));
  }
  EXPECT_EQ(folder.files(), 0U);
}

}  // namespace
}  // namespace torolux
