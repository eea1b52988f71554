// SPDX-License-Identifier: MIT
// The images of one machine: each is held once, whatever the number of PEs that run it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "emulator/engines/image/image.hpp"

namespace torolux {

class ImageSet {
 public:
  ImageSet() = default;  ///< none yet
  /// Every PE runs this one.
  ImageSet(Image image) { images_.push_back(std::move(image)); }  // NOLINT(google-explicit-constructor)
  /// number_of_pe: for each PE, the number of its image.
  ImageSet(std::vector<Image> images, std::vector<std::uint32_t> number_of_pe)
      : images_(std::move(images)), number_of_pe_(std::move(number_of_pe)) {}

  const std::vector<Image>& images() const { return images_; }
  std::size_t number_of(std::size_t pe) const { return number_of_pe_.empty() ? 0 : number_of_pe_[pe]; }
  const Image& of(std::size_t pe) const { return images_[number_of(pe)]; }
  /// Of all together: where they call one phase differently, "a / b". No two are the same.
  PhaseNames phase_names() const;

 private:
  std::vector<Image> images_;
  std::vector<std::uint32_t> number_of_pe_;  // empty: all have the first
};

}  // namespace torolux
