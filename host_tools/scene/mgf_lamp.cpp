// SPDX-License-Identifier: MIT
// Tells of measured lamps.
#include "host_tools/scene/mgf_lamp.hpp"

#include <array>
#include <optional>
#include <sstream>

#include "host_tools/scene/find_file.hpp"
#include "host_tools/scene/statements.hpp"

namespace torolux {
namespace {

/// Of all lamps in the luminaire. After the line TILT=NONE come their number and the lumens of each (below 0: they are
/// not known); after TILT=INCLUDE stands first the lamp's position, a count, and as many angles and factors.
std::optional<double> lumens_in(const std::string& text) {
  const std::size_t tilt = text.find("TILT=");
  if (tilt == std::string::npos) return std::nullopt;
  const std::size_t end = text.find('\n', tilt);
  if (end == std::string::npos) return std::nullopt;
  std::istringstream numbers(text.substr(end));
  double skipped = 0;
  if (text.compare(tilt, 12, "TILT=INCLUDE") == 0) {
    std::size_t angles = 0;
    numbers >> skipped >> angles;
    for (std::size_t i = 0; i < 2 * angles && numbers; ++i) numbers >> skipped;
  }
  double lamps = 0;
  double lumens = 0;
  numbers >> lamps >> lumens;
  if (!numbers || !(lamps > 0) || !(lumens > 0)) return std::nullopt;
  return lamps * lumens;
}

}  // namespace

void note_measured_lamp(const MgfStatement& statement, const std::filesystem::path& folder, SceneFiles& files,
                        Notices& notices) {
  if (statement.count() == 0)
    statement.refuse_with("'ies' names no file; it is written ies FILE [-m FACTOR] [TRANSFORM]");
  const std::string name(statement.word(0));
  const std::array<std::filesystem::path, 1> folders{folder};
  std::string told = in_quotes(name);
  if (const auto found = find_file(name, folders, files, statement.place())) {
    auto lumens = lumens_in(files.read(found->path, statement.place(), kMostTextBytes));
    if (lumens && statement.count() > 2 && statement.word(1) == "-m") *lumens *= statement.number(2);
    std::ostringstream figure;
    if (lumens) figure << " of " << *lumens << " lumens";
    told += figure.str();
  }
  notices.note("a measured lamp (ies) is not rendered", statement.place(), told);
}

}  // namespace torolux
