// SPDX-License-Identifier: MIT
// The display's server: requests of pages enter; the page, its endless stream of messages, and answers leave. Commands
// go into a queue. Runs in threads of its own, and never makes the run wait.
#pragma once

#include <memory>
#include <string>

#include "host_tools/display/commands.hpp"
#include "host_tools/display/live_state.hpp"

namespace torolux {

struct DisplayAddress {
  std::string address = "127.0.0.1";  ///< to listen on; another than this computer's own demands a token
  int port = 8080;                    ///< 0: any that is free
};

class DisplayServer {
 public:
  /// Serves from now on. state, commands: outlive this. Throws InputError: it cannot listen there.
  DisplayServer(const DisplayAddress& where, LiveState& state, CommandQueue& commands);
  DisplayServer(const DisplayServer&) = delete;
  DisplayServer& operator=(const DisplayServer&) = delete;
  ~DisplayServer();

  /// What to open in a browser, token included.
  const std::string& url() const;
  /// Pages that are looking on.
  int viewers() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace torolux
