// SPDX-License-Identifier: MIT
// Messages to the host, and records and messages to a PE, cut and changed at random (a fixed seed): nothing crashes,
// and what does not hold fails the run.
#include <gtest/gtest.h>

#include "tests/fuzz/mutator.hpp"
#include "tests/fuzz/send_messages.hpp"

namespace torolux {
namespace {

template <class Send>
void smoke(const std::string& name, int count, Send send) {
  const std::vector<std::string> inputs = corpus(name);
  ASSERT_FALSE(inputs.empty());
  for (const std::string& input : inputs) EXPECT_TRUE(send(std::as_bytes(std::span(input)))) << "the corpus is good";
  Mutator mutator(inputs);
  int taken = 0;
  for (int i = 0; i < count; ++i) {
    const std::string input = mutator.next();
    taken += send(std::as_bytes(std::span(input))) ? 1 : 0;
  }
  // Some must live and some must be refused, or the test would prove nothing.
  EXPECT_GT(taken, count / 200);
  EXPECT_LT(taken, count - count / 100);
}

TEST(FuzzSmoke, MessagesToTheHost) {
  smoke("host_messages", 20'000, send_to_host);
}
TEST(FuzzSmoke, RecordsToAPe) {
  smoke("records", 2'000, send_to_pe);
}

}  // namespace
}  // namespace torolux
