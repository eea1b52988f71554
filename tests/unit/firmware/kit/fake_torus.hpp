// SPDX-License-Identifier: MIT
// PEs with fake NIUs whose programs wait in the middle of a call: one thread each, of which one at a time goes on.
// Enters: a program, and a seed; leaves: packets brought in any order that the machine might bring them in.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "firmware/niu/niu.hpp"

namespace torolux::test {

class FakeTorus;

/// The NIU of one PE, and its local memory.
class FakeNode final : public pe::HintTarget {
 public:
  FakeNode(FakeTorus& torus, std::uint16_t number, unsigned columns, unsigned rows);
  void hint(std::int32_t immediate) override;

  pe::Niu& niu() { return niu_; }
  /// Local memory behind the NIU window that no record slot of the NIU's covers.
  std::span<std::byte> memory();

 private:
  friend class FakeTorus;
  struct Packet {
    std::uint16_t source;
    std::vector<std::byte> records;
  };
  /// False: too few slots are free.
  bool take(const Packet& packet);
  void receive(bool wait);
  void send_records();
  void release();
  std::byte* slot(std::uint32_t number);

  FakeTorus& torus_;
  std::uint16_t number_;
  std::unique_ptr<std::byte[]> bytes_;
  pe::NiuPage* page_;
  pe::Niu niu_;
  protocol::NiuWindow::Slots slots_{};
  std::vector<std::uint16_t> free_;
  std::vector<bool> in_use_;
  struct Item {
    std::uint16_t source;
    std::vector<std::uint16_t> slots;
  };
  std::deque<Item> arrivals_;
  bool asleep_ = false;
  bool done_ = false;
};

class FakeTorus {
 public:
  static constexpr std::uint32_t kMemoryBytes = protocol::kSmallestLocalMemory;
  using Program = std::function<void(FakeNode&)>;

  /// divert: the chance that a packet comes late and from the host.
  FakeTorus(unsigned columns, unsigned rows, double divert, std::uint32_t seed);
  /// Runs the program on every PE to its end. Throws what a PE has thrown first: a failed check, std::logic_error where
  /// firmware has broken the NIU's rules or all wait for ever, Failed at Hint::fail.
  void run(const Program& program);
  std::uint64_t diverted() const { return diverted_; }

  struct Failed : std::runtime_error {
    explicit Failed(const protocol::Fault& fault) : std::runtime_error("Hint::fail"), code(fault.code) {}
    std::uint32_t code;
  };

 private:
  friend class FakeNode;
  struct Stopped {};
  struct Late {
    std::uint16_t destination;
    FakeNode::Packet packet;
  };
  void send(std::uint16_t from, std::uint16_t to, FakeNode::Packet packet);
  bool bring_one();
  void let_others(std::uint16_t self);
  std::optional<std::uint16_t> next();
  bool chance(double of) { return std::uniform_real_distribution<>(0, 1)(random_) < of; }
  std::size_t below(std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_); }
  void fail(std::exception_ptr error);

  double divert_;
  std::mt19937 random_;
  std::vector<std::unique_ptr<FakeNode>> nodes_;
  std::map<std::pair<std::uint16_t, std::uint16_t>, std::deque<FakeNode::Packet>> under_way_;  // of a pair, in order
  std::vector<Late> late_;
  std::uint64_t diverted_ = 0;
  std::mutex mutex_;
  std::condition_variable turn_changed_;
  std::uint16_t turn_ = 0;
  bool stopping_ = false;
  std::exception_ptr error_;
};

}  // namespace torolux::test
