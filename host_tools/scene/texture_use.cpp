// SPDX-License-Identifier: MIT
// Reads the arguments of map_Kd and map_d: options, and what the file's name may be.
#include <algorithm>
#include <array>

#include "host_tools/scene/textures.hpp"

namespace torolux {
namespace {

/// Reads options from the left; what is left over is the file's name, which may hold spaces.
class TextureArguments {
 public:
  TextureArguments(const Statement& statement, const Place& place, Notices& notices)
      : keyword_(statement.keyword()),
        words_(statement.arguments()),
        rest_(statement.rest()),
        place_(place),
        notices_(notices) {}

  /// Returns what is not provided for.
  std::string read(TextureUse& use) {
    use.place = place_;
    while (next_ < words_.size() && looks_like_option(words_[next_])) option(words_[next_++], use);
    name_files(use);
    use.optional = last_may_be_number_ && next_ + 1 == words_.size();
    if (use.present()) return fault_;
    notices_.note(keyword_ + " without a file name: no texture", place_);
    return {};
  }

 private:
  static bool looks_like_option(std::string_view word) {
    return word.size() > 1 && word[0] == '-' &&
           word.find_first_not_of("-_abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ") == std::string_view::npos;
  }

  /// The rest of the line; without a word that an unknown option may have; without options that follow the name.
  void name_files(TextureUse& use) const {
    const auto from = [&](std::size_t word) {
      return std::string(rest_.substr(static_cast<std::size_t>(words_[word].data() - rest_.data())));
    };
    if (next_ >= words_.size()) return;
    use.names.push_back(from(next_));
    if (word_may_follow_ && next_ + 1 < words_.size()) use.names.push_back(from(next_ + 1));
    const std::string& name = use.names[0];
    if (const std::size_t option = name.find(" -"); option != std::string::npos)
      use.names.push_back(name.substr(0, name.find_last_not_of(' ', option) + 1));
  }

  void option(std::string_view name, TextureUse& use) {
    word_may_follow_ = false;
    if (name == "-s" || name == "-o") {
      auto& target = name == "-s" ? use.scale : use.offset;
      const std::vector<double> values = numbers(name, {target[0], target[1], 0});
      std::copy_n(values.begin(), 2, target.begin());
    } else if (name == "-t") {
      if (numbers(name, {0, 0, 0}) != std::vector<double>{0, 0, 0}) refuse_option(name, "turbulence");
    } else if (name == "-mm") {
      const std::vector<double> values = numbers(name, {0, 1});
      constexpr double most = 1e6;  // far more than takes any value out of sight
      use.base = std::clamp(values[0], -most, most);
      use.gain = std::clamp(values[1], -most, most);
      if (use.base != 0 || use.gain != 1)
        notices_.note("option -mm of " + keyword_ + ": an image's values are base + gain times what is in the file",
                      place_);
    } else if (name == "-clamp") {
      use.clamp = switched() && words_[next_ - 1] == "on";
    } else if (name == "-cc") {
      if (switched() && words_[next_ - 1] == "on")
        notices_.note("option -cc of " + keyword_ + ": colours are corrected in the one way that there is, from sRGB",
                      place_);
    } else if (name == "-imfchan" && next_ + 1 < words_.size() && words_[next_].size() == 1) {
      channel(words_[next_++][0], name, use);
    } else if (name == "-colorspace" && next_ + 1 < words_.size()) {
      if (equal_but_for_case(words_[next_++], "linear")) refuse_option(name, "linear values; save it as sRGB");
    } else {
      pass_over(name);
    }
  }

  /// The format gives it to images of one value; what of a colour it would leave can be understood in two ways.
  void channel(char channel, std::string_view name, TextureUse& use) {
    if (!equal_but_for_case(keyword_, "map_d"))
      refuse_option(name, "one channel of an image; save it as a grey image");
    else if (std::string_view("rgblm").find(channel) == std::string_view::npos)
      refuse_option(name, "channels of map_d are r, g, b, l and m");
    else
      use.channel = channel;
  }

  void pass_over(std::string_view name) {
    const std::size_t before = next_;
    if (!switched())
      while (next_ + 1 < words_.size() && is_number(words_[next_])) ++next_;
    constexpr std::array<std::string_view, 6> without_words{"-blendu", "-blendv", "-bm",
                                                            "-boost",  "-texres", "-imfchan"};
    // A word of its own, where another option follows: not the file's name.
    if (next_ == before && next_ + 1 < words_.size() && !looks_like_option(words_[next_]) &&
        looks_like_option(words_[next_ + 1]))
      ++next_;
    word_may_follow_ = next_ == before && std::ranges::find(without_words, name) == without_words.end();
    notices_.note("option " + std::string(name.substr(0, 60)) + " of " + keyword_ + " is not used", place_);
  }

  void refuse_option(std::string_view name, const std::string& what) {
    fault_ = "option " + std::string(name) + " of " + keyword_ + " is not provided for (" + what + "); take it out";
  }

  bool switched() {
    if (next_ == words_.size() || (words_[next_] != "on" && words_[next_] != "off")) return false;
    ++next_;
    return true;
  }

  static bool is_number(std::string_view word) { return parse_number(word).fault.empty(); }

  /// As many as there are, over those that hold where they are absent. The last word is the file's name, whatever it
  /// looks like.
  std::vector<double> numbers(std::string_view name, std::vector<double> values) {
    std::size_t read = 0;
    while (read < values.size() && next_ + 1 < words_.size() && is_number(words_[next_]))
      values[read++] = parse_number(words_[next_++]).value;
    last_may_be_number_ = read < values.size() && next_ + 1 == words_.size() && is_number(words_[next_]);
    if (read == 0)
      notices_.note("option " + std::string(name) + " of " + keyword_ + " without a value is not used", place_);
    return values;
  }

  std::string keyword_;
  std::vector<std::string_view> words_;
  std::string_view rest_;
  const Place& place_;
  Notices& notices_;
  std::size_t next_ = 0;
  bool word_may_follow_ = false, last_may_be_number_ = false;
  std::string fault_;
};

}  // namespace

std::string read_texture_use(const Statement& statement, const Place& place, Notices& notices, TextureUse& use) {
  return TextureArguments(statement, place, notices).read(use);
}

}  // namespace torolux
