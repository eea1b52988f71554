// SPDX-License-Identifier: MIT
// Words into a choice.
#include "host_tools/cli/growing_options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "emulator/errors.hpp"
#include "host_tools/cli/parse_values.hpp"
#include "host_tools/cli/table_options.hpp"

namespace torolux {
namespace {

constexpr double kLeastPreviewSeconds = 0.1, kMostPreviewSeconds = 86400;

}  // namespace

void add_growing_options(CLI::App& command, GrowingPictureChoice& choice, const std::string& group) {
  add_value(command, "--preview", "SECONDS",
            "Write the .png anew every so many seconds while rays are traced; what no ray has reached is black",
            [&choice](const std::string& text) {
              choice.preview_seconds = parse_number(text, kLeastPreviewSeconds, kMostPreviewSeconds);
            })
      ->group(group);
  add_value(command, "--display-server", "HOST:PORT",
            "Show the picture while it grows in tev or HDRView, which listens there (tev: localhost:14158)",
            [&choice](const std::string& text) { choice.viewer = parse_viewer_address(text); })
      ->group(group);
}

std::unique_ptr<GrowingPicture> growing_picture(const GrowingPictureChoice& choice, const std::string& title,
                                                const Resolved& resolved) {
  if (!choice.preview_seconds && !choice.viewer) return nullptr;
  const auto& outputs = resolved.outputs;
  if (choice.preview_seconds) {
    if (!resolved.path.empty()) throw UsageError("--preview is of one picture, and --path makes several");
    if (std::all_of(outputs.begin(), outputs.end(), holds_radiance))
      throw UsageError("--preview writes the .png anew, and none is asked for: --output FILE.png");
  }
  return std::make_unique<GrowingPicture>(choice, title, resolved.quality, resolved.tone, outputs);
}

}  // namespace torolux
