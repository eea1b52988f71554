// SPDX-License-Identifier: MIT
// Messages of any length between PEs, in order. Enters: bytes to send, packets that the NIU brings; leaves: packets,
// and messages in their receiver's memory. What comes while nobody asks for it waits on the heap, never in record
// slots.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "firmware/kit/packet.hpp"
#include "firmware/kit/peers.hpp"
#include "firmware/kit/words.hpp"
#include "firmware/niu/niu.hpp"

namespace torolux::kit {

/// PEs as torolux.h names them.
inline constexpr int kAnyPe = -1;

class Messenger {
 public:
  /// Sets the record slots. Fails the run where there is no memory for the table of PEs.
  Messenger(pe::Niu& niu, const SlotLayout& slots);
  Messenger(const Messenger&) = delete;
  Messenger& operator=(const Messenger&) = delete;
  ~Messenger() = default;

  pe::Niu& niu() { return niu_; }
  /// From now on, who is at fault: the function's name, and where it was called.
  void called(std::string_view function, const void* from) {
    function_ = function;
    from_ = from;
  }
  /// The same of what all PEs must call: each message of Channel::together must belong to the same call as this.
  void called_together(Call call) {
    call_ = call.after(call_);
    together_from_ = from_;
  }
  /// Ends the run: "function: words", and the place.
  [[noreturn]] void fail(const Words& words) const;
  /// The program ends well. Fails the run if others have called what this PE has not, as far as their messages are
  /// here.
  void end();

  /// To a PE of the machine, this one too; copied. Waits while the NIU's queue is full; what comes meanwhile is taken
  /// in.
  void send(Channel channel, int pe, std::span<const std::byte> data);
  /// Waits for the next message from `pe` or kAnyPe; the bytes that it had.
  std::size_t receive(Channel channel, int pe, std::span<std::byte> room);
  /// Both; what comes in goes to its place while the rest goes out. The two must not overlap.
  std::size_t exchange(int to, std::span<const std::byte> data, int from, std::span<std::byte> room);
  /// Bytes of the message that `receive` would return at once, or -1.
  std::int64_t waiting(Channel channel, int pe);
  /// Who sent what was received last.
  std::uint32_t source() const { return source_; }

  /// Waits for a message of the host; packets that come meanwhile are taken in. Valid until the next call.
  const protocol::MessageHeader& receive_from_host();

 private:
  /// Where `receive` waits, and how far it is.
  struct Posted {
    bool open = false;
    bool claimed = false;  ///< a message has begun to come here
    bool done = false;
    Channel channel{};
    int from = kAnyPe;
    std::uint16_t source = 0;
    std::uint32_t bytes = 0;
    std::span<std::byte> room;
  };
  /// Of one channel, whole messages in the order in which they came.
  struct Queue {
    Block<Waiting> first;
    Waiting* last = nullptr;
  };

  void check_pe(int pe) const;
  void check(Channel channel, std::uint32_t source, std::uint32_t bytes, Call call, std::size_t room) const {
    if (channel == Channel::together && call != call_) fail_other_call(source, call);
    if (bytes > room) fail_no_room(bytes, source, room);
  }
  [[noreturn, gnu::cold]] void fail_other_call(std::uint32_t source, Call theirs) const;
  [[noreturn, gnu::cold]] void fail_no_room(std::uint32_t bytes, std::uint32_t source, std::size_t room) const;
  [[noreturn]] void fail_left_over(std::uint32_t source, Call theirs) const;
  void send_to_self(Channel channel, std::span<const std::byte> data);
  void send_packets(Channel channel, std::uint16_t pe, std::span<const std::byte> data);
  void put_head(const PacketHead& head);
  std::uint32_t send_part(std::uint16_t pe, PacketHead& head, std::span<const std::byte> rest);
  std::uint32_t send_staged(std::uint16_t pe, PacketHead& head, std::span<const std::byte> data);
  std::uint32_t send_from_place(std::uint16_t pe, PacketHead& head, std::span<const std::byte> rest,
                                std::uint32_t lead);
  void post(Channel channel, int from, std::span<std::byte> room);
  std::size_t wait_for_posted();
  bool posted_takes(Channel channel, std::uint32_t source) const;
  void claim(std::uint32_t source, std::uint32_t bytes, Call call);
  const Waiting* next_of(Channel channel, int pe, Waiting** before);
  std::size_t hand_over(Channel channel, Waiting* before, std::span<std::byte> room);

  void drain();
  PacketHead head_of(const protocol::NiuWindow::Arrival& arrival) const;
  void take(const protocol::NiuWindow::Arrival& arrival);
  void take_packet(const protocol::NiuWindow::Arrival& arrival);
  void take_early(Peer& peer);
  void copy_payload(const protocol::NiuWindow::Arrival& arrival, const PacketHead& head, std::uint32_t payload,
                    std::byte* to) const;
  std::byte* place_for(Peer& peer, const PacketHead& head);
  void placed(Peer& peer, const PacketHead& head, std::uint32_t payload);
  void end_message(Peer& peer, const PacketHead& head);
  Early& keep_early(Peer& peer, const PacketHead& head, std::uint32_t payload);
  Peer& peer_of(std::uint32_t pe);
  std::byte* slot(std::uint32_t number) const { return slots_ + std::size_t{number} * kRecordBytes; }
  Queue& queue_of(Channel channel) { return queues_[static_cast<std::size_t>(channel)]; }
  Block<Waiting> new_waiting(const PacketHead& head);

  pe::Niu niu_;
  SlotLayout layout_;
  std::byte* slots_;    ///< slot 0
  std::byte* staging_;  ///< the last of the program's own slots
  pe::Slot staging_slot_;
  Peers peers_;
  Posted posted_;
  std::array<Queue, kChannels> queues_{};
  std::uint32_t source_ = 0;
  std::uint32_t sent_since_drain_ = 0;  ///< packets
  std::uint32_t waiting_bytes_ = 0;     ///< of messages on the heap
  std::string_view function_ = "main";
  const void* from_ = nullptr;
  Call call_;  ///< the last of those of all PEs together
  const void* together_from_ = nullptr;
};

}  // namespace torolux::kit
