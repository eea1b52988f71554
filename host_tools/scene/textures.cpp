// SPDX-License-Identifier: MIT
// See textures.hpp.
#include "host_tools/scene/textures.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/scene/texture_image.hpp"

namespace torolux {
namespace {

/// Reads options from the left; what is left over is the file's name, which may hold spaces.
class TextureArguments {
 public:
  TextureArguments(const Statement& statement, const Place& place, Notices& notices)
      : words_(statement.arguments()), rest_(statement.rest()), place_(place), notices_(notices) {}

  TextureUse read() {
    TextureUse use;
    use.place = place_;
    while (next_ < words_.size() && known(words_[next_])) option(words_[next_++], use);
    if (next_ == words_.size()) refuse(place_, "map_Kd without a file name");
    use.file = rest_.substr(static_cast<std::size_t>(words_[next_].data() - rest_.data()));
    std::replace(use.file.begin(), use.file.end(), '\\', '/');
    return use;
  }

 private:
  static bool known(std::string_view word) {
    constexpr std::array<std::string_view, 12> options{"-s",      "-o",      "-t",  "-mm",    "-clamp",  "-cc",
                                                       "-blendu", "-blendv", "-bm", "-boost", "-texres", "-imfchan"};
    return std::find(options.begin(), options.end(), word) != options.end();
  }

  void option(std::string_view name, TextureUse& use) {
    if (name == "-s" || name == "-o") {
      auto& target = name == "-s" ? use.scale : use.offset;
      const std::vector<double> values = numbers(name, 3, name == "-s" ? 1 : 0);
      std::copy_n(values.begin(), 2, target.begin());
    } else if (name == "-t") {
      if (numbers(name, 3, 0) != std::vector<double>{0, 0, 0}) refuse_option(name, "turbulence");
    } else if (name == "-mm") {
      if (numbers(name, 2, 1) != std::vector<double>{0, 1}) refuse_option(name, "base and gain; change the image");
    } else if (name == "-clamp" || name == "-cc") {
      if (word(name) == "on") refuse_option(name, name == "-cc" ? "colour correction" : "textures repeat");
    } else if (name == "-imfchan") {
      refuse_option(name, "one channel of an image; save it as a grey image");
    } else {
      word(name);
      notices_.note("option " + std::string(name) + " of map_Kd is not used", place_);
    }
  }

  [[noreturn]] void refuse_option(std::string_view name, const std::string& what) const {
    refuse(place_, "option " + std::string(name) + " of map_Kd is not provided for (" + what + "); take it out");
  }

  std::string_view word(std::string_view option) {
    if (next_ == words_.size()) refuse(place_, "option " + std::string(option) + " of map_Kd without a value");
    return words_[next_++];
  }

  /// One to `most` numbers; those that are not given are `absent`.
  std::vector<double> numbers(std::string_view option, std::size_t most, double absent) {
    std::vector<double> values{read_number(word(option), place_)};
    while (values.size() < most && next_ + 1 < words_.size() && looks_like_number(words_[next_]))
      values.push_back(read_number(words_[next_++], place_));
    values.resize(most, absent);
    return values;
  }
  static bool looks_like_number(std::string_view text) {
    return text.find_first_not_of("+-.0123456789eE") == std::string_view::npos &&
           text.find_first_of("0123456789") != std::string_view::npos;
  }

  std::vector<std::string_view> words_;
  std::string_view rest_;
  const Place& place_;
  Notices& notices_;
  std::size_t next_ = 0;
};

}  // namespace

TextureUse read_texture_use(const Statement& statement, const Place& place, Notices& notices) {
  return TextureArguments(statement, place, notices).read();
}

double linear_of_srgb(std::uint8_t value) {
  const double v = value / 255.0;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

std::uint32_t TextureLibrary::load(const TextureUse& use) {
  const auto [entry, fresh] = number_.emplace(use.file, static_cast<std::uint32_t>(textures_.size()));
  if (!fresh) return entry->second;
  if (!files_.exists(use.file))
    refuse(use.place, "there is no texture '" + use.file +
                          "'; put it there (names are relative to the material library), or take the map_Kd line out");
  textures_.push_back(decode_texture(files_.read(use.file, use.place, kMostImageBytes), use.file, use.place, notices_));
  return entry->second;
}

Vec3d TextureLibrary::brightest(std::uint32_t texture) const {
  std::array<std::uint8_t, 3> most{};
  for (const auto& texel : textures_[texture].texels) {
    for (std::size_t c = 0; c < 3; ++c) most[c] = std::max(most[c], texel[c]);
  }
  return {linear_of_srgb(most[0]), linear_of_srgb(most[1]), linear_of_srgb(most[2])};
}

}  // namespace torolux
