// SPDX-License-Identifier: MIT
// A torus for tests of one's own firmware, compiled for this computer: PEs with fake NIUs, a thread each, of which one
// at a time goes on. Enters: a program, messages of the host, and a seed; leaves: what the PEs send the host. Packets
// are brought in any order in which the machine might bring them, drawn by the seed: the same seed, the same order.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "firmware/niu/niu.hpp"

namespace torolux::native {

class FakeTorus;

/// What a PE has sent over the system bus.
struct BusMessage {
  protocol::PeNumber pe;           ///< who sent it
  protocol::PeNumber destination;  ///< kHost or kFrameBuffer
  std::uint16_t kind;              ///< as in its header
  std::vector<std::byte> bytes;

  /// As characters: for messages of kind MachineMessage::text.
  std::string_view text() const { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }
};

/// One PE of a FakeTorus: its local memory, and the NIU that its program works with.
class FakeNode final : public pe::HintTarget {
 public:
  /// Made by FakeTorus.
  FakeNode(FakeTorus& torus, std::uint16_t number, unsigned columns, unsigned rows);
  /// What the NIU does; called by the driver. Throws std::logic_error where its rules are broken.
  void hint(std::int32_t immediate) override;

  /// The driver, for what is to be tested: pe_main(node.niu()).
  pe::Niu& niu() { return niu_; }
  /// Local memory that the program may use as it likes, for record slots, too: 128 KiB less the NIU window's page, from
  /// stores_begin() on.
  std::span<std::byte> memory();

 private:
  friend class FakeTorus;
  struct Packet {
    std::uint16_t source;
    std::vector<std::byte> records;
  };
  struct Item {
    std::uint16_t source;
    std::vector<std::uint16_t> slots;  ///< of records
    std::optional<BusMessage> message;
  };
  /// False: too few slots are free.
  bool take(const Packet& packet);
  void receive(bool wait);
  void set_slots();
  void send_records();
  void send_message();
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
  std::deque<Item> arrivals_;
  std::uint64_t clock_ = 0;
  bool asleep_ = false;
  bool done_ = false;
};

/// The torus, the bus and the host: a test sends what the host would, runs a program on all PEs, and reads what came.
class FakeTorus {
 public:
  /// Of each PE's local memory.
  static constexpr std::uint32_t kMemoryBytes = protocol::kSmallestLocalMemory;
  /// What a PE does. It ends by returning, or by Niu::halt.
  using Program = std::function<void(FakeNode&)>;

  /// divert: the chance, 0 to 1, that a packet comes late and from the host, as those do for which no slot was free.
  /// seed: of all that is left to chance.
  FakeTorus(unsigned columns, unsigned rows, double divert = 0, std::uint32_t seed = 1);

  /// A message of the host to a PE, up to kMostMessageBytes; it comes after those before it.
  void message(protocol::PeNumber pe, std::uint16_t kind, std::span<const std::byte> bytes);
  /// Runs the program on every PE to its end. Throws what a PE has thrown first: a test's own failed check,
  /// std::logic_error where firmware has broken the NIU's rules or all wait for ever, Failed at Niu::fail.
  void run(const Program& program);

  /// All that was sent over the bus, in order.
  const std::vector<BusMessage>& sent() const { return sent_; }
  /// Packets that came late and from the host.
  std::uint64_t diverted() const { return diverted_; }

  /// A PE has called Niu::fail.
  struct Failed : std::runtime_error {
    explicit Failed(const protocol::Fault& fault);
    std::uint32_t code;  ///< a FaultCode
  };

 private:
  friend class FakeNode;
  struct Stopped {};
  struct Halted {};
  struct Late {
    std::uint16_t destination;
    FakeNode::Packet packet;
  };
  void send(std::uint16_t from, std::uint16_t to, FakeNode::Packet packet);
  bool bring_one();
  void let_others(std::uint16_t self);
  void work(FakeNode& node, const Program& program);
  std::optional<std::uint16_t> next();
  bool chance(double of) { return std::uniform_real_distribution<>(0, 1)(random_) < of; }
  std::size_t below(std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_); }
  void fail(std::exception_ptr error);

  double divert_;
  std::mt19937 random_;
  std::vector<std::unique_ptr<FakeNode>> nodes_;
  std::map<std::pair<std::uint16_t, std::uint16_t>, std::deque<FakeNode::Packet>> under_way_;  // of a pair, in order
  std::vector<Late> late_;
  std::vector<BusMessage> sent_;
  std::uint64_t diverted_ = 0;
  std::mutex mutex_;
  std::condition_variable turn_changed_;
  std::uint16_t turn_ = 0;
  bool stopping_ = false;
  std::exception_ptr error_;
};

}  // namespace torolux::native
