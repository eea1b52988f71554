// SPDX-License-Identifier: MIT
// `torolux compare A B`: two picture files enter; by how much they differ leaves, on standard output.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <optional>

#include "host_tools/cli/command.hpp"
#include "host_tools/picture/compare.hpp"
#include "host_tools/picture/visible_difference.hpp"
#include "host_tools/report/text.hpp"

namespace torolux {
namespace {

struct CompareOptions {
  std::string picture, reference;
  std::optional<std::string> output, flip_map;
  double pixels_per_degree = kPixelsPerDegree;
};

std::string channels(const std::array<double, 3>& values) {
  std::string text;
  for (const double value : values) text += right(significant(value, 6), 14);
  return text;
}

void print(const Comparison& result) {
  constexpr std::size_t kLabel = 24;
  std::cout << left("", kLabel) << right("R", 14) << right("G", 14) << right("B", 14) << "\n"
            << left("mean", kLabel) << channels(result.mean) << "\n"
            << left("mean of the reference", kLabel) << channels(result.reference_mean) << "\n"
            << left("relative RMSE", kLabel) << right(percent(result.relative_rmse, 4), 14) << "\n"
            << left("  of 4 x 4 block means", kLabel) << right(percent(result.block_rmse, 4), 14)
            << "  (clamped at the reference's 97th percentile, " << significant(result.clamp, 4) << ")\n"
            << left("worst", kLabel) << right(significant(result.worst, 6), 14) << "  ("
            << "RGB"[result.worst_channel] << " of pixel " << result.worst_x << ", " << result.worst_y << ")\n"
            << left("differing pixels", kLabel) << right(grouped(result.differing), 14) << "\n"
            << std::flush;
}

std::string pooled(const Pooled& values) {
  return right(significant(values.mean, 4), 14) + "  (95 % of the pixels below " +
         significant(values.percentile_95, 4) + ", worst " + significant(values.worst, 4) + " of pixel " +
         std::to_string(values.worst_x) + ", " + std::to_string(values.worst_y) + ")\n";
}

void print(const VisibleDifference& result, double pixels_per_degree) {
  constexpr std::size_t kLabel = 24;
  std::cout << "As seen, at " << significant(pixels_per_degree, 4)
            << " pixels per degree; both with the exposure of B's .png at 0 EV:\n"
            << left("FLIP", kLabel) << pooled(result.flip) << left("HDR-FLIP", kLabel) << pooled(result.hdr_flip)
            << left("streaks [L*]", kLabel) << right(significant(result.streaks.directed, 4), 14) << "  ("
            << percent(result.streaks.share) << " of the error's energy at their scales, RMS "
            << significant(result.streaks.error, 4) << ")\n"
            << std::flush;
}

int run_compare(const CompareOptions& options) {
  if (options.output) check_writable(*options.output);
  if (options.flip_map) check_writable(*options.flip_map);
  const Picture picture = read_picture(options.picture);
  const Picture reference = read_picture(options.reference);
  print(compare(picture, reference));
  const VisibleDifference visible = visible_difference(picture, reference, options.pixels_per_degree);
  print(visible, options.pixels_per_degree);
  if (options.output) write_picture(difference(picture, reference), *options.output);
  if (options.flip_map) write_flip_map(visible.flip_map, *options.flip_map);
  return 0;
}

}  // namespace

void add_compare_command(CLI::App& app, CommandAction& action) {
  const auto options = std::make_shared<CompareOptions>();
  CLI::App* command = app.add_subcommand("compare", "Tell by how much two pictures differ");
  command->add_option("A", options->picture, "A picture, .pfm or .exr")->required()->type_name("");
  command->add_option("B", options->reference, "The reference, .pfm or .exr, of the same size")
      ->required()
      ->type_name("");
  command->add_option("--output", options->output, "Picture of the absolute difference: .png, .exr or .pfm")
      ->type_name("FILE");
  command->add_option("--flip-map", options->flip_map, "FLIP of each pixel, 0 to 1: .png (grey), .exr or .pfm")
      ->type_name("FILE");
  command
      ->add_option("--pixels-per-degree", options->pixels_per_degree,
                   "Of the display, as the person who looks at it sees them (67: 3840 over 0.7 m, seen from 0.7 m)")
      ->check(CLI::Range(1.0, kMostPixelsPerDegree))
      ->type_name("N");
  command->callback([options, &action] { action = [options] { return run_compare(*options); }; });
}

}  // namespace torolux
