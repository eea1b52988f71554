// SPDX-License-Identifier: MIT
// Checks each statement of a material library. What is wrong is kept beside its material: who uses that, decides.
#include "host_tools/scene/mtl_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "emulator/nearest_name.hpp"
#include "host_tools/scene/statements.hpp"
#include "host_tools/scene/textures.hpp"

namespace torolux {
namespace {

constexpr std::array<std::string_view, 12> kRead{"newmtl", "Kd",    "Ks", "Ke", "Tf",     "Ni",
                                                 "Ns",     "illum", "d",  "Tr", "map_Kd", "map_d"};
constexpr std::array<std::string_view, 5> kOtherTextures{"bump", "norm", "disp", "decal", "refl"};
/// Values of other kinds of light, on which pictures here do not depend.
constexpr std::array<std::string_view, 11> kQuiet{"Ka", "sharpness", "Km",  "Kr",    "Pr",    "Pm",
                                                  "Ps", "Pc",        "Pcr", "aniso", "anisor"};

MaterialValue value_of(std::string_view keyword) {
  if (keyword == "Kd") return MaterialValue::diffuse;
  if (keyword == "Ks") return MaterialValue::specular;
  if (keyword == "Ke") return MaterialValue::emission;
  if (keyword == "Tf") return MaterialValue::filter;
  if (keyword == "Ni") return MaterialValue::index;
  if (keyword == "Ns") return MaterialValue::exponent;
  return keyword == "illum" ? MaterialValue::model : MaterialValue::texture;
}

class MtlChecker {
 public:
  MtlChecker(std::string file, std::filesystem::path folder, Notices& notices)
      : file_(std::move(file)), folder_(std::move(folder)), notices_(notices) {}

  CheckedLibrary run(std::string_view text) {
    StatementReader reader(text, file_);
    for (Statement statement; reader.next(statement);) check(statement);
    return std::move(library_);
  }

 private:
  void check(const Statement& statement) {
    place_ = {file_, statement.line};
    const std::string_view word = statement.keyword();
    std::string_view keyword = keyword_among(word, kRead);
    if (!keyword.empty() && keyword != word)
      notices_.note("a statement in another letter case is read", place_,
                    in_quotes(word) + " as " + std::string(keyword));
    if (keyword == "newmtl") return begin_material(statement);
    if (library_.materials.empty())
      return notices_.note("statements before the first newmtl are passed over", place_, in_quotes(word));
    if (keyword.empty()) return tell_unread(word);
    tell_again(keyword);
    if (keyword == "d" || keyword == "Tr") return check_transparency(statement, keyword);
    if (keyword == "map_Kd" || keyword == "map_d") {
      check_texture(statement, keyword == "map_d");
    } else {
      std::string fault = keyword == "illum" ? check_model(statement) : check_values(statement, keyword);
      set_fault(value_of(keyword), std::move(fault));
      CheckedMaterial& material = library_.materials.back();
      material.has_kd |= keyword == "Kd";
      material.has_ni |= keyword == "Ni";
      material.has_ns |= keyword == "Ns";
    }
  }

  void tell_unread(std::string_view word) {
    if (equal_but_for_case(word.substr(0, 4), "map_") || !keyword_among(word, kOtherTextures).empty()) {
      notices_.note("textures other than map_Kd and map_d are not used", place_, std::string(word.substr(0, 60)));
    } else if (keyword_among(word, kQuiet).empty()) {
      const std::vector<std::string> names(kRead.begin(), kRead.end());
      notices_.note("statement " + in_quotes(word) + " is not known and not used" +
                        (word.size() > 3 ? did_you_mean(word, names) : ""),
                    place_);
    }
  }

  /// The last statement of a kind counts.
  void tell_again(std::string_view keyword) {
    const auto [first, fresh] = given_.emplace(keyword, place_.line);
    if (!fresh)
      notices_.note("of a statement that stands twice in a material the last one counts", place_,
                    std::string(keyword) + ", first in line " + std::to_string(first->second));
  }

  void begin_material(const Statement& statement) {
    given_.clear();
    const std::string name(statement.rest());
    if (name.empty()) notices_.note("a material without a name is that of usemtl without a name", place_);
    library_.text += "newmtl " + std::to_string(library_.materials.size()) + "\n";
    library_.materials.push_back({name, place_});
  }

  /// The last statement of a value counts, good or not.
  void set_fault(MaterialValue value, std::string message) {
    std::vector<MaterialFault>& faults = library_.materials.back().faults;
    std::erase_if(faults, [value](const MaterialFault& fault) { return fault.value == value; });
    if (!message.empty()) faults.push_back({value, place_, std::move(message)});
  }

  /// Numbers >= 0, written in full; one stands for three. Returns what is wrong with them.
  std::string check_values(const Statement& statement, std::string_view keyword) {
    const std::size_t count = keyword == "Ni" || keyword == "Ns" ? 1 : 3;
    std::vector<std::string_view> words = statement.arguments();
    std::string values(keyword);
    std::string fault;
    const auto name = std::string(keyword);
    if (!words.empty() && (equal_but_for_case(words[0], "spectral") || equal_but_for_case(words[0], "xyz"))) {
      fault = name + " as a spectrum or in XYZ is not read; give red, green and blue";
    } else if (count == 3 && words.size() == 4) {
      notices_.note("a fourth number (alpha) of a colour is not used", place_, name + " " + std::string(words[3]));
      words.pop_back();
    }
    if (fault.empty() && words.size() != count && words.size() != 1)
      fault = name + " has " + std::to_string(words.size()) + " values; expected " + std::to_string(count);
    for (std::size_t i = 0; fault.empty() && i < count; ++i) {
      const std::string_view word = words[words.size() == 1 ? 0 : i];
      const ReadNumber read = parse_number(word);
      if (!read.fault.empty())
        fault = read.fault;
      else if (read.value < 0)
        fault = name + " is " + std::string(word) + "; it must not be negative";
      else if (read.value > kMostCoordinate)
        fault = name + " is " + std::string(word) + "; at most 1e15 is allowed";
      values += ' ';
      values += word;
    }
    // Whether a material is specular must not depend on a value that is not known to be zero.
    if (fault.empty())
      library_.text += values + "\n";
    else if (keyword == "Ks")
      library_.text += "Ks 1 1 1\n";
    return fault;
  }

  std::string check_model(const Statement& statement) {
    const std::vector<std::string_view> words = statement.arguments();
    if (words.size() != 1) return "illum has " + std::to_string(words.size()) + " values; expected 1";
    const ReadNumber model = parse_number(words[0]);
    if (!model.fault.empty()) return model.fault;
    if (model.value != std::floor(std::clamp(model.value, 0.0, 10.0)))
      return "illum " + in_quotes(words[0]) + " is not an illumination model; they are 0 to 10";
    library_.text += "illum " + std::to_string(static_cast<int>(model.value)) + "\n";
    return {};
  }

  void check_transparency(const Statement& statement, std::string_view keyword) {
    const std::vector<std::string_view> words = statement.arguments();
    if (words.empty()) return;
    const std::string_view word = words[0] == "-halo" && words.size() > 1 ? words[1] : words[0];
    const ReadNumber read = parse_number(word);
    CheckedMaterial& material = library_.materials.back();
    auto& value = keyword == "d" ? material.dissolve : material.transparency;
    value.reset();
    if (read.fault.empty() && read.value >= 0 && read.value <= 1)
      value = read.value;
    else
      notices_.note("transparency by d or Tr that is not a number from 0 to 1 is not used", place_,
                    std::string(keyword) + " " + std::string(word.substr(0, 60)));
  }

  void check_texture(const Statement& statement, bool opacity) {
    TextureUse use;
    set_fault(opacity ? MaterialValue::opacity : MaterialValue::texture,
              read_texture_use(statement, place_, notices_, use));
    use.folders = {std::filesystem::path(file_).parent_path()};
    if (use.folders[0] != folder_) use.folders.push_back(folder_);
    CheckedMaterial& material = library_.materials.back();
    (opacity ? material.opacity : material.texture) = std::move(use);
  }

  std::string file_;
  std::filesystem::path folder_;
  Notices& notices_;
  Place place_;
  std::map<std::string_view, std::size_t> given_;  // statements of the current material, their first lines
  CheckedLibrary library_;
};

}  // namespace

CheckedLibrary check_mtl(std::string_view text, const std::string& file, const std::filesystem::path& folder,
                         Notices& notices) {
  return MtlChecker(file, folder, notices).run(text);
}

}  // namespace torolux
