// SPDX-License-Identifier: MIT
// A token, one record, goes from PE to PE over the torus, once around all of them; each halts as it passes the token
// on. PE 0 sends it off, takes it back, checks it and reports how long it was under way.
#include "firmware/boot/boot.hpp"
#include "firmware/examples/text.hpp"

namespace torolux::examples {
namespace {

struct Token {
  std::uint32_t passed;  ///< PEs so far
  std::uint32_t unused;
};

// The record slots: slot 0 is the program's own, the others are the NIU's.
constexpr std::uint32_t kOwnSlots = 1;
constexpr std::uint32_t kNiuSlots = protocol::kMostRecordsPerPacket;

Token& token_in(const pe::Niu& niu, pe::Slot slot) {
  return niu.memory().at<Token>(niu.memory().stores_begin())[slot];
}

/// Waits for the token and returns the slot in which the NIU has put it.
pe::Slot take(pe::Niu& niu) {
  const auto& arrival = niu.receive();
  if (arrival.kind != protocol::ArrivalKind::records || arrival.count != 1U) {
    niu.fail(protocol::FaultCode::unexpected_message, static_cast<std::uint32_t>(arrival.kind), arrival.count);
  }
  return arrival.slots[0];
}

void pass_on(pe::Niu& niu, pe::Slot slot) {
  ++token_in(niu, slot).passed;
  const auto next = static_cast<protocol::PeNumber>((niu.pe() + 1U) % niu.pes());
  niu.send_records(next, std::span(&slot, 1));
}

void lead(pe::Niu& niu) {
  const std::uint64_t begin = niu.clock();
  token_in(niu, 0).passed = 0;
  pass_on(niu, 0);
  const pe::Slot slot = take(niu);
  const std::uint64_t end = niu.clock();

  const std::uint32_t passed = token_in(niu, slot).passed;
  if (passed != niu.pes()) niu.fail(protocol::FaultCode::bad_record, passed, niu.pes());
  Text line;
  line << "The token has passed " << passed << " PEs in " << end - begin << " cycles";
  line.send(niu);
}

}  // namespace
}  // namespace torolux::examples

void torolux::pe::pe_main(Niu& niu) {
  niu.set_slots(niu.memory().stores_begin(), sizeof(examples::Token), examples::kOwnSlots, examples::kNiuSlots);
  if (niu.pe() == 0U) {
    examples::lead(niu);
  } else {
    examples::pass_on(niu, examples::take(niu));
  }
}
