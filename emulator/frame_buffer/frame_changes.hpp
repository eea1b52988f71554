// SPDX-License-Identifier: MIT
// Which parts of a frame buffer have changed: pixels enter as they are added to, runs of them and when leave.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace torolux {

/// Of runs of kRunPixels pixels, row by row. "When" is a number of pixels that had been added: whoever remembers it
/// sees later what is newer. Any number of readers.
class FrameChanges {
 public:
  static constexpr unsigned kRunShift = 6;
  static constexpr std::size_t kRunPixels = std::size_t{1} << kRunShift;

  void resize(std::size_t pixels) { last_.assign((pixels + kRunPixels - 1) >> kRunShift, 0); }
  /// added: so many in all, with this one.
  void note(std::size_t pixel, std::uint64_t added) {
    last_[pixel >> kRunShift] = added;
    added_ = added;
  }

  /// All of it is new; added: as in note.
  void note_all(std::uint64_t added) {
    last_.assign(last_.size(), added);
    added_ = added;
  }

  std::uint64_t added() const { return added_; }
  /// Of each run: `added` at its last change; 0: never. The last run may be shorter than the others.
  std::span<const std::uint64_t> last() const { return last_; }

 private:
  std::vector<std::uint64_t> last_;
  std::uint64_t added_ = 0;
};

}  // namespace torolux
