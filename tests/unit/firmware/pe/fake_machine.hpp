// SPDX-License-Identifier: MIT
// PEs with fake NIUs in one thread: queues in place of torus and bus, and a host that tests speak for.
#pragma once

#include <array>
#include <cstddef>
#include <cstring>
#include <deque>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "tests/unit/firmware/pe/fake_pe.hpp"
#include "tests/unit/firmware/pe/test_stores.hpp"

namespace torolux::test {

struct HostMessage {
  std::uint16_t source;
  protocol::MessageKind kind;
  std::vector<std::byte> bytes;

  template <class T>
  T as() const {
    T out{};
    std::memcpy(&out, bytes.data(), std::min(bytes.size(), sizeof(T)));
    return out;
  }
};

class FakeMachine {
 public:
  explicit FakeMachine(std::uint32_t pes, std::uint32_t local_memory_bytes = 2U << 20U);

  /// Lays out, loads and begins a stage; returns when all PEs are ready.
  void begin(const TestScene& scene, protocol::Stage stage, std::uint32_t niu_slots = 64, float irradiance_value = 1);
  /// Lays out and loads, without begin. change: applied to each PE's stores before they are loaded.
  template <class Change>
  void load(const TestScene& scene, protocol::Stage stage, std::uint32_t niu_slots, float irradiance_value,
            const Change& change) {
    stores = build_stores(scene, stage, irradiance_value);
    for (std::uint16_t p = 0; p < pes.size(); ++p) {
      change(stores[p]);
      load_stores(p, niu_slots);
    }
    run();
  }
  void message(std::uint16_t pe, protocol::MessageKind kind, std::span<const std::byte> bytes = {});
  template <class T>
  void message(std::uint16_t pe, protocol::MessageKind kind, const T& contents) {
    message(pe, kind, std::as_bytes(std::span(&contents, 1)));
  }
  /// Until every PE sleeps and nothing is under way.
  void run();
  void send(Packet packet) { torus.push_back(std::move(packet)); }

  /// All that came to the host of one kind since the last call, in order.
  std::vector<HostMessage> take(protocol::MessageKind kind);
  /// Sum of all `credits` messages since the last call.
  std::uint32_t take_credits();
  /// Shoots, as a host would: deals the points, and grants `credits` at a time to each PE that asks. Returns how many
  /// records were created. Checks that credits come home, and that PEs ask when they should.
  std::uint32_t shoot(std::uint16_t owner, const protocol::Shoot& shoot, std::uint32_t credits = 100);
  /// The owner's next points, one to each of these PEs.
  void deal(std::uint16_t owner, std::span<const std::uint16_t> to, std::uint32_t in_parts = 1);
  std::uint32_t points_of(std::uint16_t pe, const protocol::Shoot& shoot) const;
  std::vector<protocol::Candidate> select(std::uint16_t pe, std::uint32_t count, std::int64_t threshold);
  protocol::Tally tally(std::uint16_t pe);
  /// A store of a PE as it stands in its memory.
  template <class T>
  std::vector<T> store(std::uint16_t pe, const protocol::Store& s) const {
    std::vector<T> out(s.count);
    if (s.count > 0) std::memcpy(out.data(), pes[pe]->at(s.address, s.count * sizeof(T)).data(), s.count * sizeof(T));
    return out;
  }
  void stop();

  std::vector<std::unique_ptr<FakePe>> pes;
  std::vector<PeStores> stores;  ///< with addresses
  std::deque<Packet> torus;
  std::vector<HostMessage> to_host;
  using Pixels = std::map<std::uint32_t, std::array<std::int64_t, 3>>;
  Pixels pixels;                             ///< colours
  std::map<protocol::Plane, Pixels> layers;  ///< other planes
  std::uint64_t records_sent = 0, largest_packet = 0;
  bool points_travel = true;         ///< shoot deals them to all PEs in turn; else to their owner
  std::uint32_t shoot_in_parts = 1;  ///< into which it divides each

 private:
  std::uint32_t grant_to_all_in_need(std::uint32_t credits);
  std::uint64_t rays();  ///< records made so far by all PEs, of final gathering too
  void load_stores(std::uint16_t pe, std::uint32_t niu_slots);
  void load_bytes(std::uint16_t pe, std::uint32_t address, std::span<const std::byte> bytes);
};

}  // namespace torolux::test
