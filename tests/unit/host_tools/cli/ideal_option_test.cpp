// SPDX-License-Identifier: MIT
// Proves: --ideal switches off the costs that it names and no others, besides those that the machine file does.
#include "host_tools/cli/ideal_option.hpp"

#include <gmock/gmock.h>

#include "emulator/errors.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux {
namespace {

using Ideal = MachineDescription::Ideal;
using testing::HasSubstr;
using testing_support::message_of;

Ideal ideal_of(const std::string& text) {
  Ideal ideal;
  make_ideal(text, ideal);
  return ideal;
}

TEST(MakeIdeal, TakesNamesAndAll) {
  EXPECT_EQ(ideal_of("host"), (Ideal{.host = true}));
  EXPECT_EQ(ideal_of("niu,signals"), (Ideal{.niu = true, .signals = true}));
  EXPECT_EQ(ideal_of("all"), (Ideal{.host = true, .niu = true, .signals = true}));
}

TEST(MakeIdeal, RefusesWhatIsNoPart) {
  for (const char* text : {"", "bus", "host,", "host,,niu", "Host"}) {
    EXPECT_THAT(message_of<UsageError>([&] { ideal_of(text); }), HasSubstr("host, niu, signals")) << text;
  }
}

TEST(Either, IsWhatOneOfThemSays) {
  EXPECT_EQ(either({.host = true}, {.signals = true}), (Ideal{.host = true, .signals = true}));
}

}  // namespace
}  // namespace torolux
