// SPDX-License-Identifier: MIT
// --preview: states of the picture enter, .png files that are written anew leave.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "host_tools/growing_picture/newest.hpp"
#include "host_tools/growing_picture/picture_state.hpp"

namespace torolux {

/// The .png among `outputs`, with their layers, exposed and tone-mapped as the finished picture will be; each is
/// written beside itself and renamed. Throws InputError.
void write_preview(const PictureState& state, const std::vector<std::filesystem::path>& outputs,
                   const ToneMapping& tone);

/// Writes in a thread of its own.
class PreviewWriter {
 public:
  PreviewWriter(std::vector<std::filesystem::path> outputs, const ToneMapping& tone);
  PreviewWriter(const PreviewWriter&) = delete;
  PreviewWriter& operator=(const PreviewWriter&) = delete;
  ~PreviewWriter();

  void put(std::shared_ptr<const PictureState> state) { states_.put(std::move(state)); }
  /// What has not been written yet never is; afterwards nothing writes to the files. What could not be written; empty:
  /// all could.
  std::string stop();

 private:
  void work();

  std::vector<std::filesystem::path> outputs_;
  ToneMapping tone_;
  Newest<PictureState> states_;
  std::string failure_;  // of the thread, until it has ended
  std::thread thread_;
};

}  // namespace torolux
