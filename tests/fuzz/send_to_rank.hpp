// SPDX-License-Identifier: MIT
// What the fuzzer of messages between a study's ranks does with its bytes: cut them into messages to rank 0 or to
// another, and let only those refusals pass that end all ranks with a reason.
#pragma once

#include <cstdlib>
#include <deque>
#include <filesystem>
#include <iostream>
#include <span>
#include <sstream>
#include <string>

#include "emulator/ranks/transport.hpp"
#include "host_tools/study/rank_hands.hpp"
#include "host_tools/study/results.hpp"
#include "host_tools/study/serve.hpp"
#include "tests/fuzz/fuzzed_bytes.hpp"

namespace torolux {

/// A rank to which all messages come that it is given, each after a poll that finds none; what it sends is looked at
/// and goes nowhere.
class FedRank : public ranks::Transport {
 public:
  static constexpr unsigned kRanks = 3;
  class Aborted : public ranks::RankFailure {
   public:
    using RankFailure::RankFailure;
  };

  FedRank(unsigned own, std::deque<ranks::Message> messages) : own_(own), messages_(std::move(messages)) {}

  bool more() const { return !messages_.empty(); }
  ranks::Ranks ranks() const override { return {own_, kRanks}; }
  /// Called by the thread of life signs, too.
  void send(unsigned to, std::uint32_t kind, std::span<const std::byte> bytes) override {
    if (to >= kRanks || kind > ranks::kMostKind) std::abort();
    if (kind == static_cast<std::uint32_t>(study::FarmMessage::answer)) study::content_of<study::FarmAnswer>(bytes);
  }
  std::optional<ranks::Message> poll() override {
    pause_ = !pause_;
    if (pause_ || messages_.empty()) return std::nullopt;
    ranks::Message message = std::move(messages_.front());
    messages_.pop_front();
    return message;
  }
  bool wait(std::chrono::milliseconds) override {
    if (messages_.empty()) throw ranks::RankFailure("nothing more will come");
    return true;
  }
  [[noreturn]] void abort(const std::string& reason) override { throw Aborted(reason); }
  void close(std::span<const unsigned> lost, int) override {
    for (const unsigned rank : lost)
      if (rank >= kRanks) std::abort();
  }

 private:
  unsigned own_;
  std::deque<ranks::Message> messages_;
  bool pause_ = false;
};

/// Does at once what it is ordered; stays in the folder in which the fuzzer is.
class IdleHands : public study::Hands {
 public:
  bool brings_results() const override { return true; }
  bool free() const override { return true; }
  std::optional<pid_t> start(const study::Order& order) override {
    std::filesystem::current_path(folder_);
    orders_.push_back(order);
    return std::nullopt;
  }
  std::optional<study::Answer> poll() override {
    if (orders_.empty()) return std::nullopt;
    const study::Order order = std::move(orders_.front());
    orders_.pop_front();
    std::string words;
    for (const std::string& word : order.words) words += word;
    return study::Answer{order.number, study::Outcome{order.from_output ? 1 : 0, "", words}};
  }
  void stop() override { orders_.clear(); }

 private:
  inline static const std::filesystem::path folder_ = std::filesystem::current_path();
  std::deque<study::Order> orders_;
};

/// What a rank that is given runs answers is read as its result.
inline void lead_ranks(FedRank& rank, ranks::LifeTimes times) {
  study::RankHands hands(rank, 2, "a program", times);
  std::uint64_t orders = 0;
  for (bool more = true; more;) {
    more = rank.more();
    while (hands.free()) hands.start({orders++, {"render", "a"}, orders % 2 == 0});
    while (const std::optional<study::Answer> answer = hands.poll()) {
      if (answer->number >= orders) std::abort();
      if (!answer->outcome) continue;
      study::row_of_csv(answer->outcome->result);
      try {
        study::statistics_of(answer->outcome->result, R"({"seed":1,"inputs":[{"size":3}]})", "a.json");
      } catch (const InputError&) {
        // Of another run.
      }
    }
  }
  hands.end(0);
}

/// The first byte: which rank. Each message: who sends it, kind, a length of 16 bits, contents. True: all were taken;
/// false: one has ended all ranks.
inline bool send_to_rank(std::span<const std::byte> bytes) {
  constexpr ranks::LifeTimes kNoSilence{std::chrono::hours(100), std::chrono::hours(100)};
  FuzzedBytes fuzzed(bytes);
  const unsigned own = fuzzed.as<std::uint8_t>() % 2;
  std::deque<ranks::Message> messages;
  while (!fuzzed.empty()) {
    ranks::Message& message = messages.emplace_back();
    message.from = fuzzed.as<std::uint8_t>() % FedRank::kRanks;
    message.kind = fuzzed.as<std::uint8_t>();
    const auto contents = fuzzed.next(fuzzed.as<std::uint16_t>());
    message.bytes.assign(contents.begin(), contents.end());
  }
  FedRank rank(own, std::move(messages));
  // What is told of ranks is nobody's to read here.
  std::ostringstream told;
  std::streambuf* const errors = std::cerr.rdbuf(told.rdbuf());
  bool taken = true;
  try {
    if (own == 0) {
      lead_ranks(rank, kNoSilence);
    } else {
      IdleHands hands;
      study::serve(rank, hands, "a program", kNoSilence);
    }
  } catch (const FedRank::Aborted&) {
    taken = false;
  } catch (const ranks::RankFailure&) {
    // No message has closed the ranks.
  }
  std::cerr.rdbuf(errors);
  return taken;
}

}  // namespace torolux
