// SPDX-License-Identifier: MIT
// --display and what belongs to it: options enter; the display of a run leaves, and is kept up after it.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "host_tools/display/display.hpp"

namespace CLI {
class App;
}

namespace torolux {

struct DisplayOptions {
  bool display = false;
  std::optional<int> port;
  std::optional<std::string> address;
  bool open = false;
  bool paused = false;  ///< the run stands until a page lets it go
};

/// --display, --display-address, --open, --paused.
void add_display_options(CLI::App& command, DisplayOptions& options, const std::string& group);

/// Serves from now on, and says where on standard error; null: it is not asked for. Throws UsageError, InputError.
std::unique_ptr<Display> open_display(const DisplayOptions& options, const DisplayedRun& run);

/// What run() returns. display (null: none): is told of what it throws.
template <class Run>
auto run_displayed(Display* display, Run run) {
  try {
    return run();
  } catch (const std::exception& error) {
    if (display != nullptr) display->fail(error.what());
    throw;
  }
}

/// keep: serves on until a page asks to end, or what it is given says so, which is at Ctrl-C.
void keep_display(bool quiet, const std::function<void(const std::function<bool()>&)>& keep);

}  // namespace torolux
