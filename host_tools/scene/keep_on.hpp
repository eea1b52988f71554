// SPDX-License-Identifier: MIT
// Whether the user has ended the program while a scene loads and its mesh is made, which may take a minute.
#pragma once

#include <cstddef>

namespace torolux {

/// Whom to ask; null: nobody, as at first. Once, before there are threads.
void set_interruption(bool (*asked)());

/// Between parts of the work. Throws Interrupted.
void look_for_interruption();

/// While it lives, and `held`, nobody is asked: what was done before is to be saved first, by a machine that looks
/// itself.
class HeldInterruption {
 public:
  explicit HeldInterruption(bool held);
  HeldInterruption(const HeldInterruption&) = delete;
  HeldInterruption& operator=(const HeldInterruption&) = delete;
  ~HeldInterruption();

 private:
  bool (*before_)();
};

/// In a loop of many small steps: looks now and then. step: its number.
inline void look_for_interruption(std::size_t step) {
  constexpr std::size_t often = 4096;
  if (step % often == 0) look_for_interruption();
}

}  // namespace torolux
