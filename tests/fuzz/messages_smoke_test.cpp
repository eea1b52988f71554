// SPDX-License-Identifier: MIT
// Messages to the host, to a rank of a study, and records and messages to a PE, cut and changed at random (a fixed
// seed): nothing crashes, and what does not hold fails the run.
#include <gtest/gtest.h>

#include <span>
#include <string>

#include "tests/fuzz/send_messages.hpp"
#include "tests/fuzz/send_to_listener.hpp"
#include "tests/fuzz/send_to_rank.hpp"
#include "tests/fuzz/smoke.hpp"

namespace torolux {
namespace {

TEST(FuzzSmoke, MessagesToTheHost) {
  smoke("host_messages", 20'000,
        [](const std::string& input) { return send_to_host(std::as_bytes(std::span(input))); });
}
TEST(FuzzSmoke, MessagesToTheHostOfAnyImage) {
  smoke("run_messages", 20'000,
        [](const std::string& input) { return send_to_listener(std::as_bytes(std::span(input))); });
}
TEST(FuzzSmoke, MessagesToARank) {
  smoke("rank_messages", 5'000, [](const std::string& input) { return send_to_rank(std::as_bytes(std::span(input))); });
}
TEST(FuzzSmoke, RecordsToAPe) {
  smoke("records", 2'000, [](const std::string& input) { return send_to_pe(std::as_bytes(std::span(input))); });
}

}  // namespace
}  // namespace torolux
