// SPDX-License-Identifier: MIT
// Registers the PE program's own handlers as the engine `native`: to link this file is enough.
#include <memory>

#include "firmware/pe/pe.hpp"
#include "tests/native_engine/native_engine.hpp"

namespace torolux::test {

namespace {

const bool registered = [] {
  register_native_engine([](pe::Niu& niu, NativeClock& /*clock*/) {
    const auto state = std::make_unique<pe::Pe>();
    pe::run_pe(*state, niu);
  });
  return true;
}();

}  // namespace

}  // namespace torolux::test
