// SPDX-License-Identifier: MIT
// Proves that whatever travels or is laid out (structs, enumerations, names of types and constants of
// firmware/protocol) is that of the protocol's version: a change without a new version fails.
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "firmware/protocol/machine.hpp"

namespace torolux::test {
namespace {

const std::filesystem::path kSource = TOROLUX_SOURCE_DIR;
const std::filesystem::path kLayouts = kSource / "tests/data/protocol_layouts.txt";

/// Without comments and with single spaces; kProtocolVersion itself is left out.
std::string plain(const std::filesystem::path& header) {
  std::ostringstream text;
  text << std::ifstream(header).rdbuf();
  std::string code = std::regex_replace(text.str(), std::regex("//[^\n]*"), "");
  code = std::regex_replace(code, std::regex("inline constexpr std::uint32_t kProtocolVersion = [0-9]+;"), "");
  return std::regex_replace(code, std::regex("\\s+"), " ");
}

/// From `begin` to the end of the statement: the semicolon outside all braces.
std::string statement_from(const std::string& code, std::size_t begin) {
  int depth = 0;
  for (std::size_t at = begin; at < code.size(); ++at) {
    if (code[at] == '{') ++depth;
    if (code[at] == '}') --depth;
    if (code[at] == ';' && depth == 0) return code.substr(begin, at + 1 - begin);
  }
  return code.substr(begin);
}

/// All that fixes how bytes lie and what they mean, in the order of the headers' names. Functions are rules, not
/// layouts: their results are held by the lock step and by the pictures.
std::string layouts() {
  std::set<std::filesystem::path> headers;
  for (const auto& entry : std::filesystem::directory_iterator(kSource / "firmware/protocol")) {
    if (entry.path().extension() == ".hpp") headers.insert(entry.path());
  }
  const std::regex begins("(struct [A-Za-z]+ \\{|enum class |using [A-Za-z]+ = |inline constexpr )");
  std::string all;
  for (const auto& header : headers) {
    const std::string code = plain(header);
    for (std::size_t from = 0;;) {
      std::smatch match;
      const std::string rest = code.substr(from);
      if (!std::regex_search(rest, match, begins)) break;
      const std::string statement = statement_from(rest, static_cast<std::size_t>(match.position()));
      all += statement + "\n";
      from += static_cast<std::size_t>(match.position()) + statement.size();
    }
  }
  return all;
}

// FNV-1a, 64 bits (Fowler, Noll, Vo).
std::string digest(const std::string& text) {
  std::uint64_t hash = 0xCBF2'9CE4'8422'2325U;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100'0000'01B3U;
  std::ostringstream out;
  out << std::hex << hash;
  return out.str();
}

TEST(ProtocolVersion, RisesWithEveryChangeOfALayout) {
  const std::string all = layouts();
  for (const char* name :
       {"struct RayRecord {", "struct StageLayout {", "struct NiuWindow {", "enum class MessageKind"})
    ASSERT_NE(all.find(name), std::string::npos) << name;
  std::ifstream known(kLayouts);
  std::map<std::uint32_t, std::string> digests;
  for (std::string line; std::getline(known, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    std::uint32_t version = 0;
    std::string value;
    words >> version >> value;
    EXPECT_TRUE(digests.emplace(version, value).second) << "version " << version << " stands there twice";
  }
  ASSERT_FALSE(digests.empty()) << kLayouts;
  EXPECT_EQ(digests.rbegin()->first, protocol::kProtocolVersion)
      << "the last line of " << kLayouts << " is to be: " << protocol::kProtocolVersion << " " << digest(all);
  EXPECT_EQ(digests[protocol::kProtocolVersion], digest(all))
      << "a struct, an enumeration, a type or a constant of firmware/protocol has changed since version "
      << protocol::kProtocolVersion << ": raise kProtocolVersion in firmware/protocol/machine.hpp and add to "
      << kLayouts << " the line: " << protocol::kProtocolVersion + 1 << " " << digest(all)
      << "\n(Only where nothing but a name or the order of declarations has changed, replace the digest.)";
}

}  // namespace
}  // namespace torolux::test
