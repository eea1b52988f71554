// SPDX-License-Identifier: MIT
// What the command line says of signals becomes an exception.
#include "host_tools/scene/keep_on.hpp"

#include "emulator/errors.hpp"

namespace torolux {
namespace {

bool (*interruption)() = nullptr;

}  // namespace

void set_interruption(bool (*asked)()) {
  interruption = asked;
}

HeldInterruption::HeldInterruption(bool held) : before_(interruption) {
  if (held) interruption = nullptr;
}

HeldInterruption::~HeldInterruption() {
  interruption = before_;
}

void look_for_interruption() {
  if (interruption != nullptr && interruption()) throw Interrupted("interrupted while the scene was loaded");
}

}  // namespace torolux
