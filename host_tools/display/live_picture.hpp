// SPDX-License-Identifier: MIT
// The picture that pages show: changed pixels enter, and for each page what is newer than what it has leaves.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace torolux {

/// What a page has of the picture.
struct PictureSeen {
  std::uint64_t begun = 0;              ///< which picture
  std::vector<std::uint64_t> versions;  ///< of its runs
};

class LivePicture {
 public:
  /// More are not shown: pages and this computer would be busy with nothing else.
  static constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 23U;
  static constexpr std::size_t kRunPixels = 64;
  /// In one message: what is copied while the machine may have to wait.
  static constexpr std::size_t kMostPixelsAtOnce = std::size_t{1} << 16U;

  using Pixel = std::array<float, 3>;  ///< linear radiance [W/(m^2 sr)]

  /// Another picture, black. width * height: at most kMostPixels. description: JSON.
  void begin(std::uint32_t width, std::uint32_t height, std::string description, std::uint64_t version);
  /// first: a multiple of kRunPixels.
  void put(std::size_t first, std::span<const Pixel> pixels, std::uint64_t version);

  /// Appends messages to `out`; false: there is more that `seen` has not.
  bool append_news(PictureSeen& seen, std::string& out) const;

 private:
  std::string description_;
  std::uint64_t begun_ = 0;  // the version when it did
  std::vector<Pixel> pixels_;
  std::vector<std::uint64_t> versions_;  // of each run of kRunPixels
};

}  // namespace torolux
