// SPDX-License-Identifier: MIT
// A measured lamp's web and how it hangs enter; what it sends in a direction leaves. By angles, straight from the web.
#pragma once

#include "tests/references/vectors.hpp"

namespace torolux::references {

class MeasuredLight {
 public:
  MeasuredLight(const LampWeb& web, const SceneLamp& lamp);

  /// Intensity over the material's emission and the opening's area: over all directions its integral is pi. out: unit
  /// length, away from the lamp.
  double intensity(const Vec& out) const;

 private:
  double in_web(double gamma, double turn) const;

  LampWeb web_;
  Vec x_, y_, nadir_;
  double all_ = 1;
};

}  // namespace torolux::references
