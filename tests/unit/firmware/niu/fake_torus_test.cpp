// SPDX-License-Identifier: MIT
// Proves: on the torus for tests of one's own, a program works as on the machine: records go round, messages come and
// go, whatever the order; it ends with what is wrong where the NIU's rules are broken, and a seed repeats its order.
#include "firmware/niu/native/fake_torus.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

namespace torolux::native {
namespace {

using pe::Niu;
using pe::Slot;
using protocol::ArrivalKind;
using protocol::NiuWindow;
using testing::HasSubstr;

struct Token {
  std::uint64_t visits;
};

constexpr std::uint16_t kAsk = 16, kAnswer = 17;

void set_slots(Niu& niu) {
  niu.set_slots(niu.memory().stores_begin(), sizeof(Token), 1, 2);
}
Token& token_in(Niu& niu, Slot slot) {
  return *niu.memory().at<Token>(niu.memory().stores_begin() + slot * static_cast<std::uint32_t>(sizeof(Token)));
}

/// firmware/examples/token in small: once round all PEs, from slot to slot.
void token_round(FakeNode& node) {
  Niu& niu = node.niu();
  set_slots(niu);
  const auto next = static_cast<protocol::PeNumber>((niu.pe() + 1U) % niu.pes());
  if (niu.pe() == 0) {
    token_in(niu, 0) = {1};
    constexpr Slot own = 0;
    niu.send_records(next, std::span(&own, 1));
  }
  const NiuWindow::Arrival& arrival = niu.receive();
  ASSERT_EQ(arrival.kind, ArrivalKind::records);
  const Slot slot = arrival.slots[0];
  Token& token = token_in(niu, slot);
  if (niu.pe() != 0) {
    ++token.visits;
    niu.send_records(next, std::span(&slot, 1));
    return;
  }
  niu.send_message(protocol::kHost, kAnswer, std::as_bytes(std::span(&token, 1)));
  niu.release(slot);
  niu.halt();
}

TEST(FakeTorus, LetsATokenGoRoundInAnyOrder) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    FakeTorus torus(3, 2, seed % 3 == 0 ? 0.5 : 0.0, seed);
    torus.run(token_round);
    ASSERT_EQ(torus.sent().size(), 1U);
    Token token{};
    std::memcpy(&token, torus.sent()[0].bytes.data(), sizeof token);
    EXPECT_EQ(token.visits, 6U);
    EXPECT_EQ(torus.sent()[0].kind, kAnswer);
  }
}

/// Asked for a square by the host, answers it; ends at a message of another kind.
void squares(FakeNode& node) {
  Niu& niu = node.niu();
  for (;;) {
    const NiuWindow::Arrival& arrival = niu.receive();
    if (arrival.kind != ArrivalKind::message || arrival.source != protocol::kHost) continue;
    if (niu.message().kind != kAsk) return;
    const auto number = niu.message_as<std::uint32_t>();
    const std::uint32_t square = number * number;
    niu.send_message(protocol::kHost, kAnswer, std::as_bytes(std::span(&square, 1)));
  }
}

TEST(FakeTorus, BringsMessagesOfTheHostInOrderAndKeepsWhatIsAnswered) {
  FakeTorus torus(1, 1);
  for (const std::uint32_t number : {7U, 9U}) torus.message(0, kAsk, std::as_bytes(std::span(&number, 1)));
  torus.message(0, kAsk + 5, {});
  torus.run(squares);
  ASSERT_EQ(torus.sent().size(), 2U);
  std::uint32_t square = 0;
  std::memcpy(&square, torus.sent()[1].bytes.data(), sizeof square);
  EXPECT_EQ(square, 81U);
}

TEST(FakeTorus, EndsWhereAPeFails) {
  FakeTorus torus(2, 1);
  const std::byte half{};
  torus.message(1, kAsk, std::span(&half, 1));
  torus.message(0, kAsk + 5, {});
  try {
    torus.run(squares);
    FAIL() << "a message that is too short was taken";
  } catch (const FakeTorus::Failed& failed) {
    EXPECT_EQ(failed.code, static_cast<std::uint32_t>(protocol::FaultCode::short_message));
  }
}

std::string broken_rule(const FakeTorus::Program& program) {
  FakeTorus torus(2, 1);
  try {
    torus.run(program);
  } catch (const std::logic_error& error) {
    return error.what();
  }
  return "nothing was wrong";
}

TEST(FakeTorus, SaysWhichRuleIsBroken) {
  EXPECT_THAT(broken_rule([](FakeNode& node) { node.niu().receive(); }), HasSubstr("all PEs wait"));
  EXPECT_THAT(broken_rule([](FakeNode& node) {
                set_slots(node.niu());
                const Slot slot = 1;  // the NIU's, and empty
                node.niu().send_records(1, std::span(&slot, 1));
              }),
              HasSubstr("that holds a record"));
  EXPECT_THAT(broken_rule([](FakeNode& node) {
                set_slots(node.niu());
                const Slot slot = 0;
                node.niu().send_records(2, std::span(&slot, 1));
              }),
              HasSubstr("destination"));
  EXPECT_THAT(broken_rule([](FakeNode& node) { node.niu().send_message(0, kAsk, {}); }), HasSubstr("destination"));
}

TEST(FakeTorus, RepeatsItsOrderWithTheSameSeed) {
  const auto order_of = [](std::uint32_t seed) {
    FakeTorus torus(4, 2, 0, seed);
    torus.run([](FakeNode& node) {
      for (int i = 0; i < 5; ++i) node.niu().send_message(protocol::kHost, kAnswer, {});
    });
    std::vector<unsigned> order;
    for (const BusMessage& message : torus.sent()) order.push_back(message.pe);
    return order;
  };
  EXPECT_EQ(order_of(3), order_of(3));
  EXPECT_NE(order_of(3), order_of(4));
}

}  // namespace
}  // namespace torolux::native
