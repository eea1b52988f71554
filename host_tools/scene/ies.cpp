// SPDX-License-Identifier: MIT
// After lines of words come numbers, each a word, on as many lines as the writer liked.
#include "host_tools/scene/ies.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "host_tools/colour/colour.hpp"
#include "host_tools/scene/lamp_web.hpp"
#include "host_tools/scene/statements.hpp"

namespace torolux {
namespace {

/// What a file may have: the finest goniophotometers turn by a tenth of a degree.
constexpr std::size_t kMostAngles = 3601, kMostIntensities = 1'000'000;
/// What is smaller, a point or a line, has this size [m].
constexpr double kLeastSize = 0.02;
constexpr double kMostSize = 1000, kMostCandela = 1e12;
constexpr double kMetresInFoot = 0.3048;

std::string_view trimmed(std::string_view line) {
  constexpr std::string_view blanks = " \t\r\f\v";
  const std::size_t first = line.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return line.substr(first, line.find_last_not_of(blanks) - first + 1);
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

bool has_decimal_comma(std::string_view word) {
  const std::size_t comma = word.find(',');
  return comma != std::string_view::npos && comma > 0 && comma + 1 < word.size() && is_digit(word[comma - 1]) &&
         is_digit(word[comma + 1]) && word.find_first_of(",.", comma + 1) == std::string_view::npos &&
         word.find('.') == std::string_view::npos;
}

/// The first word among the numbers that looks like one, and its line. Absent: there is none, or a word has several
/// commas, which part numbers then.
std::optional<std::pair<std::string_view, std::size_t>> decimal_comma(std::string_view text) {
  std::optional<std::pair<std::string_view, std::size_t>> first;
  bool numbers = false;
  for (std::size_t line = 1; !text.empty(); ++line) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view rest = trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (!numbers) {
      numbers = equal_but_for_case(rest.substr(0, 4), "TILT");
      continue;
    }
    while (!rest.empty()) {
      const std::size_t length = std::min(rest.find_first_of(" \t\r\f\v"), rest.size());
      const std::string_view word = rest.substr(0, length);
      rest = trimmed(rest.substr(length));
      if (std::ranges::count(word, ',') > 1) return std::nullopt;
      if (!first && has_decimal_comma(word)) first.emplace(word, line);
    }
  }
  return first;
}

class IesReader {
 public:
  IesReader(std::string_view text, const std::string& file, Notices& notices)
      : rest_(text), file_(file), notices_(notices) {}

  MeasuredLamp read() {
    read_tilt(to_tilt());
    read_header();
    const std::vector<double> gamma = angles(gammas_, "vertical");
    if (gamma.back() > 180) refuse(place(), "a vertical angle above 180 degrees; type C has 0 (straight down) to 180");
    const std::vector<double> turn = angles(turns_, "horizontal");
    const Place last_turn = place();
    read_web(gamma, turn);
    ended_ = !next_word();
    if (!ended_) notices_.note("numbers after the last intensity are passed over", place());
    close_turns(turn, last_turn);
    add_horizon();
    lamp_.flux = flux_of(lamp_.web);
    if (!(lamp_.flux[0] + lamp_.flux[1] > 0)) refuse(place(), "the lamp gives no light: all intensities are zero");
    return std::move(lamp_);
  }
  /// No numbers were left over.
  bool ended() const { return ended_; }

 private:
  Place place() const { return {file_, line_}; }

  std::string_view next_line() {
    ++line_;
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    const std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    return trimmed(line);
  }

  /// What follows TILT=.
  std::string_view to_tilt() {
    while (!rest_.empty()) {
      const std::string_view line = next_line();
      if (line_ == 1) later_ = line.find("LM-63-") != std::string_view::npos;
      const std::string_view value = trimmed(line.substr(std::min<std::size_t>(4, line.size())));
      if (equal_but_for_case(line.substr(0, 4), "TILT") && value.starts_with('=')) return trimmed(value.substr(1));
    }
    refuse({file_, 0}, "no line begins with TILT=: this is not a measured lamp (IESNA LM-63)");
  }

  std::optional<std::string_view> next_word() {
    constexpr std::string_view between = " \t\r\f\v,";
    for (;;) {
      const std::size_t first = words_.find_first_not_of(between);
      if (first != std::string_view::npos) {
        words_.remove_prefix(first);
        const std::size_t end = std::min(words_.find_first_of(between), words_.size());
        const std::string_view word = words_.substr(0, end);
        words_.remove_prefix(end);
        return word;
      }
      if (rest_.empty()) return std::nullopt;
      words_ = next_line();
    }
  }

  double number(const std::string& what, double least, double most) {
    const auto word = next_word();
    if (!word) refuse(place(), "the file ends where " + what + " should stand");
    const ReadNumber read = parse_number(*word);
    if (!read.fault.empty()) refuse(place(), what + ": " + read.fault);
    if (!(read.value >= least && read.value <= most))
      refuse(place(), what + " is " + in_quotes(*word) + "; " + shown(least) + " to " + shown(most) + " are allowed");
    return read.value;
  }
  static std::string shown(double value) {
    std::string text = std::to_string(value);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text;
  }
  std::size_t count(const std::string& what, double least, double most) {
    const double value = number(what, least, most);
    if (value != std::floor(value)) refuse(place(), what + " is not a whole number");
    return static_cast<std::size_t>(value);
  }

  /// Factors by which a lamp shines in a tilted luminaire. How it is tilted is not known here: it hangs as measured.
  void read_tilt(std::string_view tilt) {
    if (equal_but_for_case(tilt, "NONE")) return;
    if (!equal_but_for_case(tilt, "INCLUDE")) {
      notices_.note("factors for tilted lamps in another file are not read: the lamp hangs as it was measured", place(),
                    in_quotes(tilt));
      return;
    }
    count("the lamp's position in the luminaire", 1, 3);
    const std::size_t angles = count("the number of tilt angles", 1, kMostAngles);
    std::vector<double> at;
    for (std::size_t i = 0; i < angles; ++i) at.push_back(number("a tilt angle", -360, 360));
    for (std::size_t i = 0; i < angles; ++i) {
      const double factor = number("a tilt factor", 0, 1000);
      if (at[i] == 0) multiplier_ = factor;
    }
    notices_.note("a tilted lamp's factors (TILT=INCLUDE): the lamp hangs as it was measured, at 0 degrees", place());
  }

  void read_header() {
    number("the number of lamps", 0, 1e6);
    number("the lumens of each lamp (-1: not known)", -1e12, 1e12);
    multiplier_ *= number("the multiplier", 0, 1e12);
    gammas_ = count("the number of vertical angles", 2, kMostAngles);
    turns_ = count("the number of horizontal angles", 1, kMostAngles);
    if (gammas_ * turns_ > kMostIntensities)
      refuse(place(), "more than " + std::to_string(kMostIntensities) + " intensities; leave angles out");
    if (const std::size_t type = count("the photometric type", 1, 3); type != 1)
      refuse(place(), std::string("photometry of type ") + (type == 2 ? "B" : "A") +
                          "; only type C (1) is read. Have the file converted to type C");
    const std::size_t units = count("the units (1 feet, 2 metres)", 1, 2);
    const double metres = units == 1 ? kMetresInFoot : 1;
    const double width = metres * number("the opening's width", -kMostSize, kMostSize);
    const double length = metres * number("the opening's length", -kMostSize, kMostSize);
    if (number("the opening's height", -kMostSize, kMostSize) != 0)
      notices_.note("a lamp whose opening has a height counts as a flat one", place());
    set_size(length, width);
    multiplier_ *= number("the ballast's factor", 0, 1000);
    // Later than in 1991 it is no factor: 1995 and 2002 keep it for future use, 2019 says by it how the file was made.
    const double lamp_factor = number("the ballast lamp's factor", 0, 1000);
    if (!later_) multiplier_ *= lamp_factor;
    number("the watts", 0, 1e12);
  }

  /// Below zero: round. Both zero: a point.
  void set_size(double length, double width) {
    lamp_.round = std::max(length, width) <= 0;
    const double along = std::abs(length);
    const double aside = std::abs(width);
    if (lamp_.round) {
      const double diameter = along > 0 && aside > 0 ? std::sqrt(along * aside) : std::max(along, aside);
      if (diameter < kLeastSize) notices_.note("a lamp that is a point counts as a disc of 2 cm", place());
      lamp_.length = lamp_.width = std::max(diameter, kLeastSize);
      return;
    }
    if (std::min(along, aside) < kLeastSize) notices_.note("a lamp that is a line counts as 2 cm wide", place());
    lamp_.length = std::max(along, kLeastSize);
    lamp_.width = std::max(aside, kLeastSize);
  }

  std::vector<double> angles(std::size_t count, const std::string& kind) {
    std::vector<double> all;
    for (std::size_t i = 0; i < count; ++i) {
      all.push_back(number("a " + kind + " angle", 0, 360));
      if (i > 0 && !(all[i] > all[i - 1])) refuse(place(), kind + " angles must rise; this one does not");
    }
    return all;
  }

  void read_web(const std::vector<double>& gamma, const std::vector<double>& turn) {
    lamp_.web.gamma = gamma;
    for (std::size_t i = 0; i < gamma.size() * turn.size(); ++i) {
      double candela = number("an intensity", -kMostCandela, kMostCandela);
      if (candela < 0) notices_.note("an intensity below zero counts as zero", place());
      candela = std::max(candela, 0.0) * multiplier_;
      if (candela > kMostCandela) refuse(place(), "an intensity, with all factors, beyond 1e12 candela");
      lamp_.web.intensity.push_back(candela / kLumenPerWatt);
    }
  }

  /// Turns of the whole circle out of those of a part of it, which the rest mirrors.
  void close_turns(const std::vector<double>& turn, const Place& at) {
    LampWeb& web = lamp_.web;
    if (turn.size() == 1) {
      web.turn = {0};
      return;
    }
    const std::vector<double> measured = std::move(web.intensity);
    web.intensity.clear();
    const auto add = [&](double angle, std::size_t from) {
      if (!web.turn.empty() && !(angle > web.turn.back())) return;
      web.turn.push_back(angle);
      const auto first = measured.begin() + static_cast<std::ptrdiff_t>(from * web.gamma.size());
      web.intensity.insert(web.intensity.end(), first, first + static_cast<std::ptrdiff_t>(web.gamma.size()));
    };
    const auto forwards = [&] {
      for (std::size_t i = 0; i < turn.size(); ++i) add(turn[i], i);
    };
    const double first = turn.front();
    const double last = turn.back();
    if (first == 90 && last == 270) {  // alike on both sides of the plane of 90 and 270 degrees
      const auto half = static_cast<std::size_t>(std::ranges::lower_bound(turn, 180.0) - turn.begin());
      if (turn[half] != 180) refuse(at, "horizontal angles from 90 to 270 degrees without 180");
      for (std::size_t i = half + 1; i-- > 0;) add(180 - turn[i], i);
      forwards();
      for (std::size_t i = turn.size(); i-- > half;) add(540 - turn[i], i);
      return;
    }
    if (first != 0 || last > 360 || (last < 180 && last != 90))
      refuse(at, "horizontal angles from " + shown(first) + " to " + shown(last) +
                     "; type C has 0 alone, 0 to 90, 0 to 180, 0 to 360, or 90 to 270");
    forwards();
    for (std::size_t i = turn.size(); last == 90 && i-- > 0;) add(180 - turn[i], i);
    if (last == 90 || last == 180) mirror_half();
    if (last > 180 && last < 360) {
      notices_.note("horizontal angles that end before 360 degrees: there, all is as at 0", at);
      add(360, 0);
    }
  }
  /// The second half of the circle from the first.
  void mirror_half() {
    LampWeb& web = lamp_.web;
    for (std::size_t i = web.turn.size() - 1; i-- > 0;) {
      web.turn.push_back(360 - web.turn[i]);
      for (std::size_t g = 0; g < web.gamma.size(); ++g)
        web.intensity.push_back(web.intensity[i * web.gamma.size() + g]);
    }
  }

  /// So that each half of the web is one of its own.
  void add_horizon() {
    LampWeb& web = lamp_.web;
    if (web.gamma.front() > 90 || web.gamma.back() < 90 || std::ranges::binary_search(web.gamma, 90.0)) return;
    LampWeb with{web.gamma, web.turn, {}};
    with.gamma.insert(std::ranges::lower_bound(with.gamma, 90.0), 90);
    for (const double turn : web.turn)
      for (const double gamma : with.gamma) with.intensity.push_back(intensity_of(web, gamma, turn));
    web = std::move(with);
  }

  std::string_view rest_, words_;
  const std::string& file_;
  Notices& notices_;
  std::size_t line_ = 0;
  std::size_t gammas_ = 0, turns_ = 0;
  double multiplier_ = 1;
  bool later_ = false;  ///< than of 1991
  bool ended_ = false;
  MeasuredLamp lamp_;
};

}  // namespace

MeasuredLamp read_ies(std::string_view text, const std::string& file, Notices& notices) {
  const auto comma = decimal_comma(text);
  if (!comma) return IesReader(text, file, notices).read();
  // Commas part numbers in this format: where they do so without blanks, the right count of numbers comes out.
  try {
    IesReader reader(text, file, notices);
    MeasuredLamp lamp = reader.read();
    if (reader.ended()) return lamp;
  } catch (const InputError&) {
    // It is told below by what it most likely comes from.
  }
  refuse({file, comma->second}, "a number with a decimal comma, " + in_quotes(comma->first) +
                                    ": commas part numbers here (IESNA LM-63), and so read they are not a lamp. Write "
                                    "decimal points");
}

}  // namespace torolux
