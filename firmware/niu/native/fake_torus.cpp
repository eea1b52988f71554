// SPDX-License-Identifier: MIT
// HINTs in, packets out, in an order drawn by chance.
#include "firmware/niu/native/fake_torus.hpp"

#include <algorithm>
#include <cstring>
#include <new>
#include <thread>

namespace torolux::native {
namespace {

using protocol::Hint;

/// Of HINTs after which another PE goes on.
constexpr double kYields = 0.3;
/// Of HINTs before which a packet is brought.
constexpr double kBrings = 0.5;

void require(bool holds, const char* what) {
  if (!holds) throw std::logic_error(std::string("the NIU's rules are broken: ") + what);
}

}  // namespace

FakeNode::FakeNode(FakeTorus& torus, std::uint16_t number, unsigned columns, unsigned rows)
    : torus_(torus),
      number_(number),
      bytes_(std::make_unique<std::byte[]>(FakeTorus::kMemoryBytes)),
      page_(new (bytes_.get()) pe::NiuPage{}),
      niu_(*page_, pe::Memory(pe::LocalBase(bytes_.get(), protocol::kLocalMemoryBase + protocol::kPageBytes)),
           pe::HintGate(*this)) {
  page_->window.pe = number;
  page_->window.columns = columns;
  page_->window.rows = rows;
  page_->window.local_memory_bytes = FakeTorus::kMemoryBytes;
}

std::span<std::byte> FakeNode::memory() {
  return std::span(bytes_.get(), FakeTorus::kMemoryBytes / 2).subspan(protocol::kPageBytes);
}

std::byte* FakeNode::slot(std::uint32_t number) {
  require(number < slots_.own + slots_.niu, "slot number");
  return bytes_.get() + (slots_.address - protocol::kLocalMemoryBase) + std::size_t{number} * slots_.bytes;
}

void FakeNode::hint(std::int32_t immediate) {
  if (protocol::is_phase_marker(immediate)) return;
  ++clock_;
  if (torus_.chance(kBrings)) torus_.bring_one();
  switch (static_cast<Hint>(immediate)) {
    case Hint::send_records:
      send_records();
      break;
    case Hint::send_message:
      send_message();
      break;
    case Hint::receive:
      receive(true);
      break;
    case Hint::receive_if_any:
    case Hint::receive_more:
    case Hint::receive_due:
      receive(false);
      break;
    case Hint::clock:
      page_->window.clock = clock_;
      break;
    case Hint::set_slots:
      set_slots();
      break;
    case Hint::halt:
      throw FakeTorus::Halted();
    case Hint::fail:
      throw FakeTorus::Failed(page_->window.fault);
    default:
      throw std::logic_error("there is no HINT " + std::to_string(immediate));
  }
  if (torus_.chance(kYields)) torus_.let_others(number_);
}

void FakeNode::set_slots() {
  require(std::ranges::find(in_use_, true) == in_use_.end(), "all slots free before they are set");
  slots_ = page_->window.slots;
  const std::uint64_t end = std::uint64_t{slots_.address} + std::uint64_t{slots_.own + slots_.niu} * slots_.bytes;
  require(slots_.address >= protocol::kLocalMemoryBase && end <= niu_.memory_end(), "slots inside local memory");
  require(slots_.bytes % 8 == 0 && slots_.bytes <= protocol::kMostPacketBytes, "bytes of a slot");
  in_use_.assign(slots_.own + slots_.niu, false);
  free_.clear();
  for (std::uint32_t s = slots_.own + slots_.niu; s-- > slots_.own;) free_.push_back(static_cast<std::uint16_t>(s));
}

void FakeNode::release() {
  for (std::uint32_t i = 0; i < page_->window.released; ++i) {
    const std::uint16_t s = page_->window.release[i];
    require(s >= slots_.own && s < slots_.own + slots_.niu && in_use_[s], "released a slot that it did not have");
    in_use_[s] = false;
    free_.push_back(s);
  }
  page_->window.released = 0;
}

void FakeNode::send_records() {
  release();
  const auto& out = page_->window.send;
  require(out.count >= 1 && out.count <= protocol::kMostRecordsPerPacket, "records of a packet");
  require(out.destination < torus_.nodes_.size() && out.destination != number_, "destination");
  Packet packet{number_, {}};
  for (std::uint32_t i = 0; i < out.count; ++i) {
    const std::uint16_t s = out.slots[i];
    packet.records.insert(packet.records.end(), slot(s), slot(s) + slots_.bytes);
    if (s < slots_.own) continue;
    require(in_use_[s], "a slot of the NIU's that holds a record");
    in_use_[s] = false;
    free_.push_back(s);
  }
  torus_.send(number_, out.destination, std::move(packet));
}

void FakeNode::send_message() {
  release();
  const auto& out = page_->window.send;
  require(out.destination == protocol::kHost || out.destination == protocol::kFrameBuffer, "destination");
  require(out.address % 8 == 0 && out.address >= protocol::kLocalMemoryBase &&
              out.address < niu_.memory_end() - sizeof(protocol::MessageHeader),
          "a message in local memory, aligned to 8");
  const auto& header = *niu_.memory().at<protocol::MessageHeader>(out.address);
  require(header.bytes <= protocol::kMostMessageBytes, "bytes of a message");
  const auto* const contents = reinterpret_cast<const std::byte*>(&header + 1);
  torus_.sent_.push_back({number_, out.destination, header.kind, {contents, contents + header.bytes}});
}

bool FakeNode::take(const Packet& packet) {
  const std::size_t records = slots_.bytes != 0 ? packet.records.size() / slots_.bytes : 1;
  if (free_.size() < records) return false;
  Item item{packet.source, {}, std::nullopt};
  for (std::size_t i = 0; i < records; ++i) {
    const std::uint16_t s = free_.back();
    free_.pop_back();
    in_use_[s] = true;
    std::memcpy(slot(s), &packet.records[i * slots_.bytes], slots_.bytes);
    item.slots.push_back(s);
  }
  arrivals_.push_back(std::move(item));
  return true;
}

void FakeNode::receive(bool wait) {
  release();
  auto& arrival = page_->window.arrival;
  arrival.kind = protocol::ArrivalKind::none;
  while (wait && arrivals_.empty()) {
    asleep_ = true;
    torus_.let_others(number_);
    asleep_ = false;
  }
  if (arrivals_.empty()) return;
  const Item item = std::move(arrivals_.front());
  arrivals_.pop_front();
  arrival.source = item.source;
  if (item.message) {
    arrival.kind = protocol::ArrivalKind::message;
    page_->window.message = {item.message->kind, item.source, static_cast<std::uint32_t>(item.message->bytes.size())};
    std::ranges::copy(item.message->bytes, page_->window.message_bytes.begin());
    return;
  }
  arrival.kind = protocol::ArrivalKind::records;
  arrival.count = static_cast<std::uint16_t>(item.slots.size());
  std::ranges::copy(item.slots, arrival.slots.begin());
}

// ---- All of them ----

FakeTorus::FakeTorus(unsigned columns, unsigned rows, double divert, std::uint32_t seed)
    : divert_(divert), random_(seed) {
  for (unsigned pe = 0; pe < columns * rows; ++pe) {
    nodes_.push_back(std::make_unique<FakeNode>(*this, static_cast<std::uint16_t>(pe), columns, rows));
  }
}

FakeTorus::Failed::Failed(const protocol::Fault& fault)
    : std::runtime_error("a PE has failed with code " + std::to_string(fault.code) + ", details " +
                         std::to_string(fault.detail[0]) + ", " + std::to_string(fault.detail[1]) + ", " +
                         std::to_string(fault.detail[2])),
      code(fault.code) {}

void FakeTorus::message(protocol::PeNumber pe, std::uint16_t kind, std::span<const std::byte> bytes) {
  require(pe < nodes_.size() && bytes.size() <= protocol::kMostMessageBytes, "a message of the host");
  nodes_[pe]->arrivals_.push_back(
      {protocol::kHost, {}, BusMessage{protocol::kHost, pe, kind, {bytes.begin(), bytes.end()}}});
}

void FakeTorus::send(std::uint16_t from, std::uint16_t to, FakeNode::Packet packet) {
  if (chance(divert_)) {
    packet.source = protocol::kHost;
    ++diverted_;
    late_.push_back({to, std::move(packet)});
  } else {
    under_way_[{from, to}].push_back(std::move(packet));
  }
}

/// Of one pair the oldest, or any that was diverted. False: there is nothing for which there is room.
bool FakeTorus::bring_one() {
  std::vector<std::pair<std::uint16_t, std::uint16_t>> pairs;
  for (const auto& [pair, packets] : under_way_) {
    if (!packets.empty()) pairs.push_back(pair);
  }
  const std::size_t choices = pairs.size() + late_.size();
  if (choices == 0) return false;
  const std::size_t choice = below(choices);
  if (choice < pairs.size()) {
    auto& packets = under_way_[pairs[choice]];
    FakeNode::Packet packet = std::move(packets.front());
    packets.pop_front();
    if (nodes_[pairs[choice].second]->take(packet)) return true;
    packet.source = protocol::kHost;
    ++diverted_;
    late_.push_back({pairs[choice].second, std::move(packet)});
    return true;
  }
  const auto place = late_.begin() + static_cast<std::ptrdiff_t>(choice - pairs.size());
  if (nodes_[place->destination]->take(place->packet)) late_.erase(place);
  return true;
}

/// Somebody who can go on.
std::optional<std::uint16_t> FakeTorus::next() {
  for (int tries = 0; tries < 100'000; ++tries) {
    std::vector<std::uint16_t> able;
    for (const auto& node : nodes_) {
      if (!node->done_ && (!node->asleep_ || !node->arrivals_.empty())) able.push_back(node->number_);
    }
    if (!able.empty()) return able[below(able.size())];
    if (!bring_one()) break;
  }
  return std::nullopt;
}

void FakeTorus::fail(std::exception_ptr error) {
  if (!error_) error_ = std::move(error);
  stopping_ = true;
  turn_changed_.notify_all();
}

/// Called by the thread whose turn it is; returns when it is again.
void FakeTorus::let_others(std::uint16_t self) {
  const auto chosen = next();
  if (!chosen) throw std::logic_error("all PEs wait, and nothing is under way");
  if (*chosen == self) return;
  turn_ = *chosen;
  turn_changed_.notify_all();
  std::unique_lock lock(mutex_, std::adopt_lock);
  turn_changed_.wait(lock, [&] { return turn_ == self || stopping_; });
  lock.release();
  if (stopping_) throw Stopped{};
}

/// On a thread of its own, with the turn when it begins.
void FakeTorus::work(FakeNode& node, const Program& program) {
  try {
    if (!stopping_) program(node);
  } catch (const Halted&) {  // as good as returning
  }
  node.done_ = true;
  if (const auto chosen = next()) {
    turn_ = *chosen;
    turn_changed_.notify_all();
  } else if (!stopping_ && !std::ranges::all_of(nodes_, [](const auto& each) { return each->done_; })) {
    throw std::logic_error("the others wait, and nothing is under way");
  }
}

void FakeTorus::run(const Program& program) {
  std::vector<std::thread> threads;
  for (const auto& node : nodes_) {
    threads.emplace_back([this, &program, node = node.get()] {
      std::unique_lock lock(mutex_);
      turn_changed_.wait(lock, [&] { return turn_ == node->number_ || stopping_; });
      lock.release();
      try {
        work(*node, program);
      } catch (const Stopped&) {  // another has failed
      } catch (...) {
        fail(std::current_exception());
      }
      mutex_.unlock();
    });
  }
  for (std::thread& thread : threads) thread.join();
  if (error_) std::rethrow_exception(error_);
}

}  // namespace torolux::native
