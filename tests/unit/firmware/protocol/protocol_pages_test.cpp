// SPDX-License-Identifier: MIT
// Proves that docs/packets.md tells the truth: its tables of records against sizeof and offsetof, its tables of
// messages against the enumerators, its sizes against the constants. And docs/errors.md against the fault codes.
#include <gtest/gtest.h>

#include <cstddef>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "emulator/niu/channel.hpp"
#include "emulator/torus/block.hpp"
#include "firmware/protocol/messages.hpp"
#include "firmware/protocol/niu_window.hpp"
#include "firmware/protocol/records.hpp"

namespace torolux::test {
namespace {

using protocol::PointRecord;
using protocol::RadiosityRecord;
using protocol::RayRecord;

struct Place {
  std::size_t offset;
  std::size_t bytes;
  bool operator==(const Place&) const = default;
};
std::ostream& operator<<(std::ostream& out, const Place& place) {
  return out << place.bytes << " bytes at " << place.offset;
}
using Fields = std::map<std::string, Place>;

#define TOROLUX_FIELD(record, field)                 \
  {                                                  \
#field, {                                        \
      offsetof(record, field), sizeof(record::field) \
    }                                                \
  }

struct Record {
  std::string name;
  std::size_t bytes;
  Fields fields;
};

std::vector<Record> records() {
  return {
      {"RadiosityRecord",
       sizeof(RadiosityRecord),
       {TOROLUX_FIELD(RadiosityRecord, origin), TOROLUX_FIELD(RadiosityRecord, direction),
        TOROLUX_FIELD(RadiosityRecord, flux), TOROLUX_FIELD(RadiosityRecord, place),
        TOROLUX_FIELD(RadiosityRecord, polygon), TOROLUX_FIELD(RadiosityRecord, key),
        TOROLUX_FIELD(RadiosityRecord, kind), TOROLUX_FIELD(RadiosityRecord, bounce),
        TOROLUX_FIELD(RadiosityRecord, flags), TOROLUX_FIELD(RadiosityRecord, visited)}},
      {"PointRecord",
       sizeof(PointRecord),
       {TOROLUX_FIELD(PointRecord, origin), TOROLUX_FIELD(PointRecord, normal), TOROLUX_FIELD(PointRecord, flux),
        TOROLUX_FIELD(PointRecord, place), TOROLUX_FIELD(PointRecord, polygon), TOROLUX_FIELD(PointRecord, key),
        TOROLUX_FIELD(PointRecord, kind), TOROLUX_FIELD(PointRecord, number_low), TOROLUX_FIELD(PointRecord, flags),
        TOROLUX_FIELD(PointRecord, number_high)}},
      {"RayRecord",
       sizeof(RayRecord),
       {TOROLUX_FIELD(RayRecord, origin), TOROLUX_FIELD(RayRecord, direction), TOROLUX_FIELD(RayRecord, weight),
        TOROLUX_FIELD(RayRecord, place), TOROLUX_FIELD(RayRecord, polygon), TOROLUX_FIELD(RayRecord, key),
        TOROLUX_FIELD(RayRecord, pixel), TOROLUX_FIELD(RayRecord, target), TOROLUX_FIELD(RayRecord, kind),
        TOROLUX_FIELD(RayRecord, bounce), TOROLUX_FIELD(RayRecord, flags), TOROLUX_FIELD(RayRecord, waiting),
        TOROLUX_FIELD(RayRecord, branches), TOROLUX_FIELD(RayRecord, sample), TOROLUX_FIELD(RayRecord, visited)}},
  };
}
#undef TOROLUX_FIELD

std::string text_of(const std::string& file) {
  std::ifstream stream(std::string(TOROLUX_SOURCE_DIR) + "/" + file);
  EXPECT_TRUE(stream.is_open()) << file;
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

const std::string& page() {
  static const std::string text = text_of("docs/packets.md");
  return text;
}

void expect_says(const std::string& text) {
  EXPECT_NE(page().find(text), std::string::npos) << "docs/packets.md does not say: " << text;
}

/// All that a regular expression's first group matches.
std::vector<std::string> matches(const std::string& text, const std::string& expression) {
  const std::regex regex(expression);
  std::vector<std::string> found;
  for (std::sregex_iterator at(text.begin(), text.end(), regex); at != std::sregex_iterator(); ++at) {
    found.push_back((*at)[1]);
  }
  return found;
}

/// "3 float", "3 float each", "52 bytes each", "uint16": of one field.
std::size_t bytes_of(const std::string& type) {
  static const std::map<std::string, std::size_t> kUnits = {{"float", 4},  {"int64", 8}, {"uint32", 4},
                                                            {"uint16", 2}, {"uint8", 1}, {"bytes", 1}};
  std::smatch match;
  if (!std::regex_match(type, match, std::regex("([0-9]+ )?([a-z0-9]+)( each)?")) || !kUnits.contains(match[2])) {
    ADD_FAILURE() << "not a type: " << type;
    return 0;
  }
  return (match[1].matched ? std::stoul(match[1]) : 1) * kUnits.at(match[2]);
}

/// The table that follows a record's heading. Several places and one name: an array.
Fields told_of(const std::string& record) {
  const std::size_t heading = page().find("**`" + record + "`, ");
  if (heading == std::string::npos) {
    ADD_FAILURE() << "docs/packets.md has no table of " << record;
    return {};
  }
  std::istringstream lines(page().substr(page().find("| at | type |", heading)));
  Fields fields;
  std::string line;
  for (int number = 0; std::getline(lines, line) && line.starts_with("|"); ++number) {
    if (number < 2) continue;  // head and rule
    std::smatch cells;
    if (!std::regex_match(line, cells, std::regex(R"(\| ([0-9, ]+) \| ([^|]+) \| ([^|]+) \|(.*)\|)"))) {
      ADD_FAILURE() << line;
      continue;
    }
    const std::vector<std::string> places = matches(cells[1], "([0-9]+)");
    const std::vector<std::string> names = matches(cells[3], "`([a-z_]+)`");
    const std::size_t each = bytes_of(cells[2]);
    if (names.size() == 1) {
      fields[names[0]] = {std::stoul(places[0]), each * places.size()};
      for (std::size_t i = 0; i < places.size(); ++i)
        EXPECT_EQ(std::stoul(places[i]), std::stoul(places[0]) + i * each);
      continue;
    }
    EXPECT_EQ(names.size(), places.size()) << line;
    for (std::size_t i = 0; i < std::min(names.size(), places.size()); ++i) {
      fields[names[i]] = {std::stoul(places[i]), each};
    }
  }
  return fields;
}

// The list of fields above is whole: they fill the record without a gap.
TEST(PagesOfTheProtocol, TheListsOfFieldsAreWhole) {
  for (const Record& record : records()) {
    std::map<std::size_t, std::size_t> by_place;
    for (const auto& [name, place] : record.fields) by_place[place.offset] = place.bytes;
    std::size_t end = 0;
    for (const auto& [offset, bytes] : by_place) {
      EXPECT_EQ(offset, end) << record.name;
      end = offset + bytes;
    }
    EXPECT_EQ(end, record.bytes) << record.name;
  }
}

TEST(PagesOfTheProtocol, TablesOfRecordsSayWhereEachFieldLies) {
  for (const Record& record : records()) {
    EXPECT_EQ(told_of(record.name), record.fields) << record.name;
    expect_says("**`" + record.name + "`, " + std::to_string(record.bytes) + " bytes**");
  }
}

TEST(PagesOfTheProtocol, SizesOfPacketsAndMessages) {
  const auto packet = [](protocol::Stage stage, std::uint32_t records) {
    return std::to_string(kPacketHeaderBytes + records * protocol::slot_bytes(stage));
  };
  const auto range = [&](protocol::Stage stage) {
    return packet(stage, 1) + " to " + packet(stage, protocol::records_per_packet(stage));
  };
  expect_says("| " + std::to_string(kPacketHeaderBytes) + " | header:");
  expect_says("1 to " + std::to_string(protocol::kMostRecordsPerPacket) + " records of one stage, at most " +
              std::to_string(protocol::kMostPacketBytes));
  expect_says("a radiosity packet " + range(protocol::Stage::radiosity) + " bytes, a ray packet " +
              range(protocol::Stage::ray_tracing) + ".");
  expect_says(std::to_string(sizeof(protocol::MessageHeader)) +
              " bytes of header (`kind`, `source`, `bytes`), then up to " +
              std::to_string(protocol::kMostMessageBytes) + " bytes");
  expect_says("`PixelAdd` (" + std::to_string(sizeof(protocol::PixelAdd)) + " bytes each)");
  expect_says("`kPointParts` (" + std::to_string(protocol::kPointParts) + ")");
  expect_says("up to " + std::to_string(protocol::Deal::kMost) + ", and only as many");
  expect_says("Kinds below " + std::to_string(protocol::kFirstProgramMessage));
}

TEST(PagesOfTheProtocol, FlagsHaveTheirBits) {
  const std::map<std::string, int> flags = {{"kDirect", protocol::kDirect},
                                            {"kFirst", protocol::kFirst},
                                            {"kBackSide", protocol::kBackSide},
                                            {"kShadow", protocol::kShadow},
                                            {"kGoesOn", protocol::kGoesOn}};
  for (const auto& [name, bit] : flags) expect_says("`" + name + "` " + std::to_string(bit));
  EXPECT_EQ(protocol::kEntryAxisMask, 3U << protocol::kEntryAxisShift);
  expect_says("entry axis in bits " + std::to_string(protocol::kEntryAxisShift) + " and " +
              std::to_string(protocol::kEntryAxisShift + 1));
  expect_says("in bits " + std::to_string(protocol::kPartShift) + " to " + std::to_string(protocol::kPartShift + 3) +
              " which part");
  expect_says("at most " + std::to_string(protocol::kMostVisits) + " |");
}

/// The enumerators of an enumeration, from the header's text.
std::set<std::string> enumerators(const std::string& header, const std::string& name) {
  const std::string text = std::regex_replace(text_of(header), std::regex("//[^\n]*"), "");
  const std::size_t begin = text.find('{', text.find("enum class " + name + " "));
  const auto found =
      matches(text.substr(begin, text.find('}', begin) - begin), R"(([a-z_]+)(?: = [A-Za-z0-9]+)?\s*(?:,|$))");
  return {found.begin(), found.end()};
}

/// The first cells of the tables below a heading, up to the next heading.
std::set<std::string> rows_below(const std::string& heading) {
  const std::size_t begin = page().find(heading);
  const auto found = matches(page().substr(begin, page().find("\n## ", begin + 1) - begin), "\n\\| `([a-z_]+)` \\|");
  return {found.begin(), found.end()};
}

TEST(PagesOfTheProtocol, TablesOfMessagesHaveAllKindsAndNoOthers) {
  std::set<std::string> kinds = enumerators("firmware/protocol/messages.hpp", "MessageKind");
  ASSERT_TRUE(kinds.contains("configure") && kinds.contains("tally"));
  kinds.merge(enumerators("firmware/protocol/niu_window.hpp", "MachineMessage"));
  std::set<std::string> told = rows_below("\n## Message\n");
  // Answers stand in the last column, not in rows of their own.
  for (const char* answer : {"ready", "candidates", "data", "tally"}) {
    expect_says(std::string("`") + answer + "`");
    told.insert(answer);
  }
  EXPECT_EQ(told, kinds);
}

TEST(PagesOfTheProtocol, TheTableOfKindsHasAllKindsOfRecords) {
  EXPECT_EQ(rows_below("\n## Records\n"), enumerators("firmware/protocol/records.hpp", "RecordKind"));
}

// ---- docs/errors.md ----

/// Number and name of each fault code, as a header has them, counted from 1.
std::vector<std::string> numbered(const std::string& header, const std::string& name) {
  const std::string text = std::regex_replace(text_of(header), std::regex("//[^\n]*"), "");
  const std::size_t begin = text.find('{', text.find("enum class " + name + " "));
  std::vector<std::string> result;
  for (const std::string& code :
       matches(text.substr(begin, text.find('}', begin) - begin), R"(([a-z_]+)(?: = 1)?\s*(?:,|$))")) {
    result.push_back(std::to_string(result.size() + 1) + " | `" + code + "`");
  }
  return result;
}

TEST(PageOfErrors, HasEachFaultCodeWithItsNumberAndNoOthers) {
  const std::string page_of_errors = text_of("docs/errors.md");
  std::vector<std::string> codes = numbered("firmware/protocol/messages.hpp", "FaultCode");
  ASSERT_EQ(codes.size(), static_cast<std::size_t>(protocol::FaultCode::words));
  const std::vector<std::string> of_niu = numbered("emulator/niu/channel.hpp", "NiuFaultCode");
  ASSERT_EQ(of_niu.size(), static_cast<std::size_t>(NiuFaultCode::wait_for_interrupt));
  codes.insert(codes.end(), of_niu.begin(), of_niu.end());
  EXPECT_EQ(matches(page_of_errors, "\n\\| ([0-9]+ \\| `[a-z_]+`) \\|"), codes);
}

}  // namespace
}  // namespace torolux::test
