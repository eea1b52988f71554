// SPDX-License-Identifier: MIT
// The `torolux` executable: all of it is in torolux_main, so that tests can call it and add engines of their own.
#include "host_tools/cli/command.hpp"

int main(int argc, char** argv) {
  return torolux::torolux_main(argc, argv);
}
