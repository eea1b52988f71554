// SPDX-License-Identifier: MIT
// tinyobjloader reads `nan` as 0, only warns of an index out of range and rounds coordinates (0.3 becomes
// 0.30000000000000004); garbage can crash it. So each statement is checked here first, and only good ones go on.
#include "host_tools/scene/obj_check.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "emulator/nearest_name.hpp"
#include "host_tools/scene/statements.hpp"

namespace torolux {
namespace {

constexpr std::array<std::string_view, 7> kRead{"v", "vn", "vt", "f", "fo", "usemtl", "mtllib"};
constexpr std::array<std::string_view, 3> kQuiet{"g", "o", "s"};
/// Statements of the format that hold nothing Torolux renders.
constexpr std::array<std::string_view, 33> kNotRendered{
    "l",    "p",    "vp",    "deg",   "bmat",      "step",  "cstype",   "curv",     "curv2",  "surf",   "parm",
    "trim", "hole", "scrv",  "sp",    "end",       "con",   "mg",       "lod",      "usemap", "maplib", "shadow_obj",
    "call", "csh",  "bevel", "ctech", "trace_obj", "stech", "c_interp", "d_interp", "bsp",    "bzp",    "cdc"};
/// Files are not read on for more positions than these that no face could use.
constexpr std::size_t kMostUnusable = 1000;

class ObjChecker {
 public:
  ObjChecker(const std::string& file, Notices& notices) : file_(file), notices_(notices) {}

  CheckedObj run(std::string_view text) {
    StatementReader reader(text, file_);
    for (Statement statement; reader.next(statement);) check(statement);
    if (foremost_.index > result_.positions.size()) {
      place_ = foremost_.place;
      refuse_index(std::to_string(foremost_.index), foremost_.corner, "in this file");
    }
    return std::move(result_);
  }

 private:
  void check(const Statement& statement) {
    place_ = {file_, statement.line};
    const std::string_view word = statement.keyword();
    std::string_view keyword = keyword_among(word, kRead);
    if (keyword.empty()) keyword = keyword_among(word, kQuiet);
    if (keyword.empty()) keyword = keyword_among(word, kNotRendered);
    if (!keyword.empty() && keyword != word)
      notices_.note("a statement in another letter case is read", place_,
                    in_quotes(word) + " as " + std::string(keyword));
    if (keyword == "v") {
      check_position(statement);
    } else if (keyword == "vn") {
      check_normal(statement);
    } else if (keyword == "vt") {
      check_texture_point(statement);
    } else if (keyword == "f" || keyword == "fo") {
      check_face(statement);
    } else if (keyword == "usemtl") {
      use_material(std::string(statement.rest()));
    } else if (keyword == "mtllib") {
      name_libraries(statement);
    } else if (keyword.empty()) {
      const std::vector<std::string> names{"usemtl", "mtllib"};
      notices_.note("statement " + in_quotes(word) + " is not of the format and passed over" +
                        (word.size() > 4 ? did_you_mean(word, names) : ""),
                    place_);
    } else if (std::ranges::find(kQuiet, keyword) == kQuiet.end()) {
      notices_.note("statement '" + std::string(keyword) + "' is not rendered", place_);
    }
  }

  /// The first `count` numbers of a statement; words that are not there are 0. Returns why they cannot be read, or "".
  template <std::size_t count>
  static std::string read_values(const Statement& statement, std::size_t least, std::array<double, count>& values) {
    const std::vector<std::string_view> words = statement.arguments();
    if (words.size() < least)
      return std::string(statement.keyword()) + " has " + std::to_string(words.size()) + " numbers; expected " +
             std::to_string(least);
    for (std::size_t i = 0; i < std::min(count, words.size()); ++i) {
      const ReadNumber read = parse_number(words[i]);
      if (!read.fault.empty()) return read.fault;
      // + 0.0 turns -0 into 0, so that equal positions have equal bits.
      values[i] = read.value + 0.0;
    }
    return {};
  }

  void check_position(const Statement& statement) {
    Vec3d position{0, 0, 0};
    std::string fault = read_values(statement, 3, position);
    if (fault.empty() && std::ranges::any_of(position, [](double x) { return std::abs(x) > kMostCoordinate; }))
      fault = "a coordinate is beyond 1e15 in magnitude; scale the mesh to other units";
    if (!fault.empty()) {
      if (result_.unusable_positions.size() == kMostUnusable) refuse(place_, fault);
      result_.unusable_positions.emplace(static_cast<std::uint32_t>(result_.positions.size()),
                                         UnusablePosition{place_, fault});
      position = {0, 0, 0};
    }
    // Four: a weight; more: a colour per vertex. Neither is used.
    const std::vector<std::string_view> words = statement.arguments();
    if (words.size() == 4 && parse_number(words[3]).value != 1)
      notices_.note("weights of vertices are not used", place_, in_quotes(words[3]));
    if (words.size() > 4) notices_.note("colours of vertices are not used", place_);
    result_.positions.push_back(position);
    limit(result_.positions.size(), "positions");
  }

  void check_normal(const Statement& statement) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    Vec3d normal{0, 0, 0};
    const std::string fault = read_values(statement, 3, normal);
    if (!fault.empty()) {
      notices_.note("a normal (vn) is not three finite numbers", place_, fault);
      normal = {nan, nan, nan};
    }
    result_.normals.push_back(normal);
    limit(result_.normals.size(), "normals");
  }

  void check_texture_point(const Statement& statement) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    std::array<double, 2> point{0, 0};
    const std::string fault = read_values(statement, 1, point);
    if (!fault.empty()) {
      notices_.note("a texture point (vt) is not finite numbers", place_, fault);
      point = {nan, nan};
    }
    result_.texture_points.push_back(point);
    limit(result_.texture_points.size(), "texture points");
  }

  void limit(std::size_t count, const char* what) const {
    if (count > 3 * kMostTriangles)
      refuse(place_, "more than " + std::to_string(3 * kMostTriangles) + " " + what + "; at most " +
                         std::to_string(kMostTriangles) + " triangles can be rendered");
  }

  std::int64_t index(std::string_view word, std::string_view corner) const {
    std::int64_t value = 0;
    std::string_view digits = word;
    if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size())
      refuse(place_, in_quotes(word) + (word == corner ? std::string() : " in " + in_quotes(corner)) +
                         " is not an index" +
                         (error == std::errc::result_out_of_range ? ": there are not that many" : ""));
    return value;
  }

  [[noreturn]] void refuse_index(const std::string& index, std::string_view corner, const char* where) const {
    refuse(place_, "index " + index + " in " + in_quotes(corner) + ", but there are " +
                       std::to_string(result_.positions.size()) + " positions (v) " + where);
  }

  /// From 1. Positions may stand behind their faces: whether they do is known at the end.
  std::size_t position_index(std::string_view word, std::string_view corner) {
    const std::int64_t value = index(word, corner);
    if (value == 0) refuse(place_, "index 0 in " + in_quotes(corner) + "; indices count from 1, or from -1 backwards");
    const auto count = static_cast<std::int64_t>(result_.positions.size());
    if (value < -count) refuse_index(std::string(word), corner, "before this line");
    if (value > count && static_cast<std::uint64_t>(value) > foremost_.index)
      foremost_ = {static_cast<std::uint64_t>(value), place_, std::string(corner.substr(0, 100))};
    return static_cast<std::size_t>(value > 0 ? value : count + value + 1);
  }

  /// Of a normal or texture point, from 1; kIndexOfNone where there cannot be one; 0 where none is named.
  std::size_t other_index(std::string_view word, std::size_t so_far, std::string_view corner) {
    if (word.empty()) return 0;
    const std::int64_t value = index(word, corner);
    if (value == 0)
      notices_.note("index 0 of a normal or texture point: the corner has none", place_, in_quotes(corner));
    const auto count = static_cast<std::int64_t>(so_far);
    if (value < -count || value > kIndexOfNone) return kIndexOfNone;
    return static_cast<std::size_t>(value >= 0 ? value : count + value + 1);
  }

  void check_corner(std::string_view corner) {
    const std::size_t first = std::min(corner.find('/'), corner.size());
    std::string_view texture;
    std::string_view normal;
    if (first < corner.size()) {
      texture = corner.substr(first + 1);
      const std::size_t second = texture.find('/');
      if (second != std::string_view::npos) {
        normal = texture.substr(second + 1);
        texture = texture.substr(0, second);
      }
    }
    result_.text += ' ' + std::to_string(position_index(corner.substr(0, first), corner));
    const std::size_t texture_index = other_index(texture, result_.texture_points.size(), corner);
    const std::size_t normal_index = other_index(normal, result_.normals.size(), corner);
    if (texture_index > 0 || normal_index > 0) result_.text += '/';
    if (texture_index > 0) result_.text += std::to_string(texture_index);
    if (normal_index > 0) result_.text += '/' + std::to_string(normal_index);
  }

  void check_face(const Statement& statement) {
    const std::vector<std::string_view> corners = statement.arguments();
    if (corners.size() < 3) {
      notices_.note("a face with fewer than three corners is left out", place_, in_quotes(statement.text));
      return;
    }
    corners_ += corners.size() - 2;
    limit(corners_, "triangles in faces");
    result_.text += 'f';
    for (const std::string_view corner : corners) check_corner(corner);
    result_.text += '\n';
    result_.face_lines.push_back(
        static_cast<std::uint32_t>(std::min<std::size_t>(place_.line, std::numeric_limits<std::uint32_t>::max())));
  }

  void use_material(const std::string& name) {
    const auto [entry, fresh] = number_of_material_.emplace(name, result_.materials.size());
    if (fresh) result_.materials.push_back({name, place_});
    result_.text += "usemtl " + std::to_string(entry->second) + "\n";
  }

  void name_libraries(const Statement& statement) {
    // One name with spaces, or several names: the reader of the files tries both.
    if (statement.rest().empty())
      notices_.note("mtllib without a file name is passed over", place_);
    else
      result_.libraries.push_back({std::string(statement.rest()), place_});
  }

  struct Foremost {
    std::uint64_t index = 0;
    Place place;
    std::string corner;
  };

  std::string file_;
  Notices& notices_;
  Place place_;
  std::size_t corners_ = 0;
  Foremost foremost_;  ///< the greatest index of a position that was not there yet
  std::unordered_map<std::string, std::size_t> number_of_material_;
  CheckedObj result_;
};

}  // namespace

CheckedObj check_obj(std::string_view text, const std::string& file, Notices& notices) {
  return ObjChecker(file, notices).run(text);
}

}  // namespace torolux
