// SPDX-License-Identifier: MIT
// Who is where, and who is silent.
#include "emulator/remote/pe_ranks.hpp"

#include <algorithm>
#include <chrono>
#include <numeric>

#include "emulator/errors.hpp"
#include "emulator/ranks/content.hpp"
#include "emulator/ranks/launched.hpp"
#include "emulator/remote/remote_pes.hpp"

namespace torolux::remote {
namespace {

constexpr std::chrono::milliseconds kSleep{2};

std::vector<unsigned> all_but_first(unsigned count) {
  std::vector<unsigned> others(count - 1);
  std::iota(others.begin(), others.end(), 1U);
  return others;
}

}  // namespace

PeRanks::PeRanks(ranks::Transport& transport, Placing placing, std::string program, ranks::LifeTimes times)
    : transport_(transport),
      placing_(placing),
      program_(std::move(program)),
      hosts_(transport.ranks().count),
      life_(std::in_place, transport, all_but_first(transport.ranks().count), times) {}

void PeRanks::check(const MachineSetup& setup) const {
  check_goes_with_ranks(setup);
}

std::unique_ptr<Engine> PeRanks::make_engine(const MachineSetup& setup, const ImageSet& images,
                                             std::vector<PeMemory>& pes) {
  return make_remote_pes(*this, setup, images, pes);
}

std::vector<unsigned> PeRanks::place(unsigned pes) const {
  return place_pes(pes, count(), placing_);
}

unsigned PeRanks::sharers(unsigned rank, const std::vector<unsigned>& of) {
  const auto unknown = [this](unsigned one) { return hosts_[one].empty(); };
  while (std::ranges::any_of(of, unknown)) {
    if (!poll()) wait();
    check_lost();
  }
  const auto same = [&](unsigned one) { return hosts_[one] == hosts_[rank]; };
  return static_cast<unsigned>(std::ranges::count_if(of, same));
}

bool PeRanks::is_here(unsigned rank) const {
  return hosts_[rank] == ranks::host_name();
}

std::string PeRanks::name_of(unsigned rank) const {
  return "rank " + std::to_string(rank) + (hosts_[rank].empty() ? "" : " (" + hosts_[rank] + ")");
}

void PeRanks::send(unsigned rank, Kind kind, std::span<const std::byte> bytes) {
  transport_.send(rank, static_cast<std::uint32_t>(kind), bytes);
}

std::optional<ranks::Message> PeRanks::poll() {
  while (std::optional<ranks::Message> message = life_->poll()) {
    switch (static_cast<Kind>(message->kind)) {
      case Kind::greeting:
        greet(*message);
        break;
      case Kind::failed:
        throw ranks::RankFailure(name_of(message->from) + ": " + ranks::content_of<std::string>(message->bytes));
      default:
        return message;
    }
  }
  return std::nullopt;
}

void PeRanks::greet(const ranks::Message& message) {
  const auto greeting = ranks::content_of<Greeting>(message.bytes);
  hosts_[message.from] = greeting.host;
  if (greeting.program != program_) {
    throw ranks::RankFailure(name_of(message.from) +
                             " runs another build of torolux than rank 0; start the same on all computers");
  }
}

void PeRanks::wait() {
  transport_.wait(kSleep);
}

void PeRanks::check_lost() const {
  const std::vector<unsigned> silent = life_->silent_ones();
  if (!silent.empty()) throw ranks::RankFailure(name_of(silent.front()) + " is silent and counts as lost");
}

void PeRanks::end(int exit_code) {
  const Close close{life_->silent_ones(), exit_code};
  for (unsigned rank = 1; rank < count(); ++rank) send(rank, Kind::close, ranks::bytes_of(close));
  life_.reset();  // nothing is sent behind that
  transport_.close(close.lost, exit_code);
}

}  // namespace torolux::remote
