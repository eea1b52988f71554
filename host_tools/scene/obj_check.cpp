// SPDX-License-Identifier: MIT
// tinyobjloader reads `nan` as 0, only warns of an index out of range and rounds coordinates (0.3 becomes
// 0.30000000000000004); garbage can crash it. So each statement is checked here first, and only good ones go on.
#include "host_tools/scene/obj_check.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>

#include "host_tools/scene/statements.hpp"

namespace torolux {
namespace {

constexpr std::array<std::string_view, 3> kQuiet{"g", "o", "s"};
/// Statements of the format that hold nothing Torolux renders.
constexpr std::array<std::string_view, 33> kNotRendered{
    "l",    "p",    "vp",    "deg",   "bmat",      "step",  "cstype",   "curv",     "curv2",  "surf",   "parm",
    "trim", "hole", "scrv",  "sp",    "end",       "con",   "mg",       "lod",      "usemap", "maplib", "shadow_obj",
    "call", "csh",  "bevel", "ctech", "trace_obj", "stech", "c_interp", "d_interp", "bsp",    "bzp",    "cdc"};

class ObjChecker {
 public:
  ObjChecker(const std::string& file, Notices& notices) : file_(file), notices_(notices) {}

  CheckedObj run(std::string_view text) {
    StatementReader reader(text, file_);
    for (Statement statement; reader.next(statement);) check(statement);
    return std::move(result_);
  }

 private:
  void check(const Statement& statement) {
    place_ = {file_, statement.line};
    const std::string_view keyword = statement.keyword();
    if (keyword == "v") {
      check_position(statement);
    } else if (keyword == "vn") {
      const Vec3d normal = triple(statement, 3, 3);
      result_.normals.push_back(normal);
    } else if (keyword == "vt") {
      const Vec3d point = triple(statement, 1, 3);
      result_.texture_points.push_back({point[0], point[1]});
    } else if (keyword == "f" || keyword == "fo") {
      check_face(statement);
    } else if (keyword == "usemtl") {
      use_material(std::string(statement.rest()));
    } else if (keyword == "mtllib") {
      name_libraries(statement);
    } else if (std::find(kNotRendered.begin(), kNotRendered.end(), keyword) != kNotRendered.end()) {
      notices_.note("statement '" + std::string(keyword) + "' is not rendered", place_);
    } else if (std::find(kQuiet.begin(), kQuiet.end(), keyword) == kQuiet.end()) {
      refuse(place_, "unknown statement " + in_quotes(keyword) + "; expected v, vn, vt, f, g, o, s, usemtl or mtllib");
    }
  }

  /// The first three numbers; absent ones are 0.
  Vec3d triple(const Statement& statement, std::size_t least, std::size_t most) const {
    const std::vector<std::string_view> words = statement.arguments();
    if (words.size() < least || words.size() > most)
      refuse(place_, std::string(statement.keyword()) + " has " + std::to_string(words.size()) + " numbers; expected " +
                         (least == most ? "" : std::to_string(least) + " to ") + std::to_string(most));
    Vec3d values{0, 0, 0};
    for (std::size_t i = 0; i < words.size(); ++i) {
      const double value = read_number(words[i], place_);
      // + 0.0 turns -0 into 0, so that equal positions have equal bits.
      if (i < 3) values[i] = value + 0.0;
    }
    return values;
  }

  void check_position(const Statement& statement) {
    // Four: a weight; six: a colour per vertex. Neither is used.
    const std::size_t count = statement.arguments().size();
    const Vec3d position = triple(statement, 3, 7);
    if (count == 6 || count == 7) notices_.note("colours of vertices are not used", place_);
    for (const double x : position)
      if (std::abs(x) > kMostCoordinate)
        refuse(place_, "a coordinate is beyond 1e15 in magnitude; scale the mesh to other units");
    result_.positions.push_back(position);
    limit(result_.positions.size(), "positions");
  }

  void limit(std::size_t count, const char* what) const {
    if (count > 3 * kMostTriangles)
      refuse(place_, "more than " + std::to_string(3 * kMostTriangles) + " " + what + "; at most " +
                         std::to_string(kMostTriangles) + " triangles can be rendered");
  }

  /// An index as written, to one from 1.
  std::size_t index(std::string_view word, std::size_t count, const char* what, std::string_view corner) const {
    std::int64_t value = 0;
    std::string_view digits = word;
    if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size())
      refuse(place_, in_quotes(word) + " in " + in_quotes(corner) + " is not an index");
    if (value == 0) refuse(place_, "index 0 in " + in_quotes(corner) + "; indices count from 1, or from -1 backwards");
    const auto limit = static_cast<std::int64_t>(count);
    if (value > limit || value < -limit)
      refuse(place_, "index " + std::string(word) + " in " + in_quotes(corner) + ", but there are " +
                         std::to_string(count) + " " + what + " before this line");
    return static_cast<std::size_t>(value > 0 ? value : limit + value + 1);
  }

  void check_corner(std::string_view corner) {
    const std::size_t first = std::min(corner.find('/'), corner.size());
    const std::string_view position = corner.substr(0, first);
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
    result_.text += ' ' + std::to_string(index(position, result_.positions.size(), "positions (v)", corner));
    if (!texture.empty() || !normal.empty()) result_.text += '/';
    if (!texture.empty())
      result_.text += std::to_string(index(texture, result_.texture_points.size(), "texture points (vt)", corner));
    if (!normal.empty())
      result_.text += '/' + std::to_string(index(normal, result_.normals.size(), "normals (vn)", corner));
  }

  void check_face(const Statement& statement) {
    const std::vector<std::string_view> corners = statement.arguments();
    if (corners.size() < 3)
      refuse(place_, "a face with " + std::to_string(corners.size()) + " corners; at least 3 are needed");
    corners_ += corners.size() - 2;
    limit(corners_, "triangles in faces");
    result_.text += 'f';
    for (const std::string_view corner : corners) check_corner(corner);
    result_.text += '\n';
    result_.face_lines.push_back(
        static_cast<std::uint32_t>(std::min<std::size_t>(place_.line, std::numeric_limits<std::uint32_t>::max())));
  }

  void use_material(const std::string& name) {
    if (name.empty()) refuse(place_, "usemtl without a name");
    const auto same = [&name](const NameUse& use) { return use.name == name; };
    auto& materials = result_.materials;
    const auto found = std::find_if(materials.begin(), materials.end(), same);
    result_.text += "usemtl " + std::to_string(found - materials.begin()) + "\n";
    if (found == materials.end()) materials.push_back({name, place_});
  }

  void name_libraries(const Statement& statement) {
    // One name with spaces, or several names: the reader of the files tries both.
    if (statement.rest().empty()) refuse(place_, "mtllib without a file name");
    result_.libraries.push_back({std::string(statement.rest()), place_});
  }

  std::string file_;
  Notices& notices_;
  Place place_;
  std::size_t corners_ = 0;
  CheckedObj result_;
};

}  // namespace

CheckedObj check_obj(std::string_view text, const std::string& file, Notices& notices) {
  return ObjChecker(file, notices).run(text);
}

}  // namespace torolux
