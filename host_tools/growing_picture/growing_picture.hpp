// SPDX-License-Identifier: MIT
// The picture while it grows, for whoever asked to see it: a render's progress enters.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host_tools/growing_picture/picture_sender.hpp"
#include "host_tools/growing_picture/preview_writer.hpp"
#include "host_tools/render/render.hpp"
#include "host_tools/settings/quality.hpp"

namespace torolux {

struct GrowingPictureChoice {
  std::optional<double> preview_seconds;  ///< between two previews; absent: none
  std::optional<ViewerAddress> viewer;
};

class GrowingPicture {
 public:
  /// title: of the picture, in a viewer. Throws InputError: an unknown host.
  GrowingPicture(const GrowingPictureChoice& choice, const std::string& title, const Quality& quality,
                 const ToneMapping& tone, const std::vector<std::filesystem::path>& outputs);

  /// From within the render's `progress`; looks at the machine when it is time, and never waits.
  void show(const RenderProgress& progress);
  /// The run has ended with this picture, which has not been written yet. What the user should know; empty: nothing.
  std::string finish(const Picture& picture, const std::vector<Layer>& layers);

 private:
  using Clock = std::chrono::steady_clock;
  /// What is done again after so long [s].
  struct Due {
    double seconds;
    Clock::time_point last{};
    bool now(Clock::time_point time) const { return std::chrono::duration<double>(time - last).count() >= seconds; }
  };

  std::optional<Due> preview_due_, viewer_due_;
  double taking_seconds_ = 0;  // that the last look took
  std::unique_ptr<PreviewWriter> preview_;
  std::unique_ptr<PictureSender> sender_;
};

}  // namespace torolux
