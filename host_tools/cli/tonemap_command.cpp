// SPDX-License-Identifier: MIT
// `torolux tonemap IN OUT.png`: a picture of radiance enters, one for a display leaves, as `render` would have made it.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <string>

#include "emulator/errors.hpp"
#include "host_tools/cli/command.hpp"
#include "host_tools/cli/render_options.hpp"
#include "host_tools/picture/picture.hpp"

namespace torolux {
namespace {

struct TonemapOptions {
  std::string picture, output;
  GivenSettings given;
};

/// Tone mapping shows them, but not what they are.
void tell_no_numbers(const Picture& picture, const std::string& file) {
  const auto wrong = [](const auto& pixel) {
    return !std::ranges::all_of(pixel, [](float value) { return std::isfinite(value); });
  };
  if (const auto count = std::ranges::count_if(picture.pixels, wrong); count > 0)
    std::cerr << "torolux: note: " << file << ": " << count << " of " << picture.pixels.size()
              << " pixels hold what is infinite or no number; that is black\n";
}

int run_tonemap(const TonemapOptions& options) {
  const std::filesystem::path output = options.output;
  check_writable(output);
  if (holds_radiance(output)) throw UsageError(options.output + ": a tone-mapped picture is a .png");
  const Picture picture = read_picture(options.picture);
  tell_no_numbers(picture, options.picture);
  write_picture(picture, output, options.given.values().tone);
  return 0;
}

}  // namespace

void add_tonemap_command(CLI::App& app, CommandAction& action) {
  const auto options = std::make_shared<TonemapOptions>();
  CLI::App* command = app.add_subcommand("tonemap", "Make a .png of a picture of radiance");
  command->add_option("IN", options->picture, "A picture, .exr or .pfm")->required()->type_name("");
  command->add_option("OUT", options->output, "The picture to write, .png")->required()->type_name("");
  add_tone_options(*command, options->given, "Picture");
  command->callback([options, &action] { action = [options] { return run_tonemap(*options); }; });
}

}  // namespace torolux
