// SPDX-License-Identifier: MIT
// Reads MGF's colours. Whatever they are made of, a chromaticity is what counts.
#include "host_tools/scene/mgf_colours.hpp"

#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

Chromaticity checked(const MgfStatement& statement, const Chromaticity& colour) {
  if (!(colour.x >= 0 && colour.y >= 1e-6 && colour.x + colour.y <= 1 + 1e-9))
    statement.refuse_with("no light has this colour: its x and y are 0 and up, y not 0, and their sum is at most 1");
  return colour;
}

Chromaticity of_tristimulus(const MgfStatement& statement, const Vec3d& xyz) {
  if (!(xyz[1] > 0) || !std::isfinite(xyz[0] + xyz[1] + xyz[2]))
    statement.refuse_with("this colour has no brightness; visible light has 380 to 780 nm");
  return checked(statement, chromaticity(vec::scale(xyz, 1 / xyz[1])));
}

}  // namespace

bool MgfColours::knows(std::string_view keyword) {
  return keyword == "c" || keyword == "cxy" || keyword == "cspec" || keyword == "cct" || keyword == "cmix";
}

void MgfColours::handle(const MgfStatement& statement) {
  const std::string_view keyword = statement.keyword();
  if (keyword == "c") {
    colours_.select(statement);
  } else if (keyword == "cxy") {
    statement.expect(2, 2, "cxy X Y");
    colours_.current() = checked(statement, {statement.number(0), statement.number(1)});
  } else if (keyword == "cspec") {
    colours_.current() = once(statement, spectrum);
  } else if (keyword == "cct") {
    colours_.current() = once(statement, temperature);
  } else {
    colours_.current() = mixture(statement);
  }
}

Chromaticity MgfColours::once(const MgfStatement& statement, Chromaticity (*work_out)(const MgfStatement&)) {
  const char* const where = statement.keyword().data();
  if (const auto known = worked_out_.find(where); known != worked_out_.end()) return known->second;
  return worked_out_.emplace(where, work_out(statement)).first->second;
}

Chromaticity MgfColours::temperature(const MgfStatement& statement) {
  statement.expect(1, 1, "cct KELVIN");
  const double kelvin = statement.number(0);
  if (!(kelvin >= 100 && kelvin <= 1e9)) statement.refuse_with("the temperature must be 100 to 1e9 kelvin");
  return of_tristimulus(statement, black_body(kelvin));
}

Chromaticity MgfColours::spectrum(const MgfStatement& statement) {
  statement.expect(4, statement.count(), "cspec FIRST LAST VALUE VALUE ..., FIRST and LAST in nanometers");
  const double first = statement.number(0);
  const double last = statement.number(1);
  if (!(first > 0 && first < last && last <= 1e6))
    statement.refuse_with("the spectrum runs from " + std::string(statement.word(0)) + " to " +
                          std::string(statement.word(1)) + " nm; it must run upwards, within 1e6 nm");
  std::vector<double> values;
  for (std::size_t i = 2; i < statement.count(); ++i) values.push_back(statement.number(i));
  return of_tristimulus(statement, tristimulus(first, last, values));
}

/// The weights are brightnesses, so that the mixture of XYZ is exact, whatever the colours were made of.
Chromaticity MgfColours::mixture(const MgfStatement& statement) {
  if (statement.count() < 2 || statement.count() % 2 != 0)
    statement.refuse_with("a mixture is written cmix WEIGHT COLOUR WEIGHT COLOUR ...");
  Vec3d sum{0, 0, 0};
  for (std::size_t i = 0; i < statement.count(); i += 2) {
    const double weight = statement.number(i);
    if (weight < 0 || weight > 1e15) statement.refuse_with("a weight must be 0 to 1e15");
    sum = vec::add(sum, tristimulus(colours_.found(statement, statement.word(i + 1)), weight));
  }
  return of_tristimulus(statement, sum);
}

}  // namespace torolux
