// SPDX-License-Identifier: MIT
// A PE with a fake NIU. A PE that would sleep throws out of its loop, which keeps no state of its own, and is entered
// again when something comes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <stdexcept>
#include <vector>

#include "firmware/pe/pe.hpp"

namespace torolux::test {

/// Hint::fail of a PE.
struct PeFailed : std::runtime_error {
  explicit PeFailed(const protocol::Fault& f);
  protocol::Fault fault;
};

struct Packet {
  std::uint16_t source, destination;
  std::vector<std::vector<std::byte>> records;
};

class FakeMachine;

class FakePe final : public pe::HintTarget {
 public:
  FakePe(FakeMachine& machine, std::uint16_t number, std::uint16_t pes, std::uint32_t local_memory_bytes);
  void hint(std::int32_t immediate) override;
  /// Lets the PE work until it sleeps or halts.
  void work();
  /// Takes a packet into free slots of the NIU, or returns false.
  bool take(const Packet& packet);
  void take_message(std::uint16_t kind, std::span<const std::byte> bytes);
  void write(std::uint32_t address, std::span<const std::byte> bytes);
  std::span<const std::byte> at(std::uint32_t address, std::size_t bytes) const;
  std::uint32_t stores_begin() const;
  std::uint32_t memory_end() const { return protocol::kLocalMemoryBase + bytes_; }
  bool halted() const { return halted_; }
  std::size_t free_niu_slots() const { return free_.size(); }
  std::uint32_t niu_slots() const { return slots_.niu; }
  const pe::Pe& state() const { return *pe_; }

 private:
  struct Item {
    std::uint16_t source;
    std::vector<std::uint16_t> slots;  ///< records, already in their slots
    std::uint16_t kind;
    std::vector<std::byte> message;
  };
  void receive(bool wait);
  void release();
  void set_slots();
  void send_records();
  void send_message();
  std::byte* slot(std::uint16_t number);
  protocol::NiuWindow& window() { return page_->window; }

  FakeMachine& machine_;
  std::uint16_t number_;
  std::uint32_t bytes_;
  std::unique_ptr<std::byte[]> memory_;  // exactly as large as local memory: the sanitizer sees what goes beyond
  pe::NiuPage* page_;
  pe::Niu niu_;
  std::unique_ptr<pe::Pe> pe_ = std::make_unique<pe::Pe>();
  protocol::NiuWindow::Slots slots_{};
  std::vector<std::uint16_t> free_;
  std::vector<bool> in_use_;
  std::deque<Item> arrivals_;
  bool halted_ = false;
};

}  // namespace torolux::test
