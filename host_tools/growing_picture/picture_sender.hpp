// SPDX-License-Identifier: MIT
// --display-server: states of the picture enter; a viewer, whenever one is there, gets what has changed.
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "host_tools/growing_picture/newest.hpp"
#include "host_tools/growing_picture/picture_state.hpp"
#include "host_tools/growing_picture/viewer_connection.hpp"
#include "host_tools/growing_picture/viewer_messages.hpp"

namespace torolux {

/// Sends in a thread of its own, some times a second: tiles that differ from what this viewer has. A viewer that comes
/// later, or again, gets all of them; one that does not read is waited for there. Keeps three states at most.
class PictureSender {
 public:
  /// name: of the picture, as the viewer shows it. begin: what it shows first. Throws InputError.
  PictureSender(const ViewerAddress& where, std::string name, std::shared_ptr<const PictureState> begin);
  PictureSender(const PictureSender&) = delete;
  PictureSender& operator=(const PictureSender&) = delete;
  ~PictureSender();

  /// Of the size and with the layers of the first.
  void put(std::shared_ptr<const PictureState> state) { states_.put(std::move(state)); }
  /// The finished picture. Waits as long as a viewer takes bytes. Whether one has all of it.
  bool finish(std::shared_ptr<const PictureState> state);

 private:
  void work();
  /// Whether the viewer has the newest state now.
  bool update();
  bool create();
  bool send_tile(const Rectangle& tile);
  bool stalled();
  bool send(const std::vector<std::byte>& message);

  ViewerConnection connection_;
  std::string name_;
  Newest<PictureState> states_;
  // Of the thread.
  std::uint32_t width_ = 0, height_ = 0;
  std::vector<NamedPlane> planes_;                  // the newest
  std::vector<std::vector<float>> shown_;           // what the viewer has; empty: nothing yet
  std::chrono::steady_clock::time_point taken_at_;  // when it last took anything
  bool complete_ = false;
  std::thread thread_;
};

}  // namespace torolux
