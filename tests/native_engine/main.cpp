// SPDX-License-Identifier: MIT
// `torolux_native`: the command line of torolux with the engine `native` beside the others.
#include "host_tools/cli/command.hpp"

int main(int argc, char** argv) {
  return torolux::torolux_main(argc, argv);
}
