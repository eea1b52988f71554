// SPDX-License-Identifier: MIT
// The radiosity stage's form factors, of all kinds that are known in closed form, with few records; with
// many, at the presets: tests/accuracy.
#include <gtest/gtest.h>

#include "tests/support/form_factor_cases.hpp"

namespace torolux::test {
namespace {

TEST(FormFactors, OfAllKindsAreTheClosedOnes) {
  Quality quality;
  quality.emission_records = 500'000;
  for (const FormFactorCase& shapes : form_factor_cases()) {
    const double measured = measured_form_factor(shapes, quality);
    // Some thousand hemi-cubes, whose mean this is, each good for some 2 %: 0.4 % were seen above 0.05, 0.00016 below.
    // A point sends from fewer of them.
    if (shapes.exact >= 0.05) {
      EXPECT_NEAR(measured / shapes.exact, 1, shapes.name.starts_with("point") ? 0.015 : 0.007) << shapes.name;
    } else {
      EXPECT_NEAR(measured, shapes.exact, 0.0004) << shapes.name;
    }
  }
}

}  // namespace
}  // namespace torolux::test
