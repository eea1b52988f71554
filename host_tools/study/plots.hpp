// SPDX-License-Identifier: MIT
// A study's table enters; curves leave, one picture for each figure.
#pragma once

#include <string>

#include "host_tools/study/table.hpp"

namespace torolux::study {

/// What is drawn, chosen where the plan does not say.
struct Axes {
  std::string x;  ///< a column; empty: nothing varies, nothing is drawn
  std::vector<std::string> y;
};
Axes axes_of(const Plan& plan);

/// The program for gnuplot that draws `y` as SVG on standard output: a curve for each value of the report's `by` and of
/// all else that varies besides x. x is a number, or takes an equal place for each value. Empty where no run has the
/// figure.
std::string plot_script(const Plan& plan, const Table& table, const std::string& x, const std::string& y);

/// Runs gnuplot: the same script gives the same bytes. Throws InputError where it is not there or refuses.
std::string draw(const std::string& script);

/// "torus.hops.mean" -> "torus_hops_mean.svg"; other characters than letters and digits become '_'.
std::string plot_file(const std::string& y);

}  // namespace torolux::study
