// SPDX-License-Identifier: MIT
// Who is free, who has what, who is silent.
#include "host_tools/study/rank_hands.hpp"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <numeric>

namespace torolux::study {
namespace {

std::vector<unsigned> all_but_first(unsigned count) {
  std::vector<unsigned> others(count - 1);
  std::iota(others.begin(), others.end(), 1U);
  return others;
}

void tell(const std::string& text) {
  std::cerr << "torolux: " << text << std::endl;
}

}  // namespace

RankHands::RankHands(ranks::Transport& transport, unsigned jobs, std::string program, ranks::LifeTimes times)
    : transport_(transport),
      jobs_(jobs),
      program_(std::move(program)),
      times_(times),
      others_(transport.ranks().count),
      life_(std::in_place, transport, all_but_first(transport.ranks().count), times) {}

/// 0: nobody is free.
unsigned RankHands::least_busy() const {
  unsigned found = 0;
  for (unsigned rank = 1; rank < others_.size(); ++rank) {
    const Other& other = others_[rank];
    if (other.host.empty() || other.silent || other.left || other.orders.size() >= jobs_) continue;
    if (found == 0 || other.orders.size() < others_[found].orders.size()) found = rank;
  }
  return found;
}

std::string RankHands::name_of(unsigned rank) const {
  const std::string& host = others_[rank].host;
  return "rank " + std::to_string(rank) + (host.empty() ? "" : " (" + host + ")");
}

std::optional<pid_t> RankHands::start(const Order& order) {
  const unsigned rank = least_busy();
  others_[rank].orders.insert(order.number);
  transport_.send(rank, static_cast<std::uint32_t>(FarmMessage::order),
                  bytes_of(FarmOrder{std::filesystem::current_path().string(), order}));
  return std::nullopt;
}

std::optional<Answer> RankHands::poll() {
  while (const std::optional<ranks::Message> message = life_->poll()) receive(*message);
  look_for_silence();
  if (answers_.empty()) return std::nullopt;
  Answer answer = std::move(answers_.front());
  answers_.pop_front();
  return answer;
}

void RankHands::receive(const ranks::Message& message) {
  try {
    switch (static_cast<FarmMessage>(message.kind)) {
      case FarmMessage::greeting:
        return greet(message.from, message.bytes);
      case FarmMessage::answer:
        return take_answer(message.from, message.bytes);
      case FarmMessage::leaving:
        others_[message.from].left = true;
        tell(name_of(message.from) + " was told to end");
        return give_up(others_[message.from]);
      case FarmMessage::ready:
        others_[message.from].ready = true;
        return;
      case FarmMessage::order:
      case FarmMessage::end:
      case FarmMessage::close:
        break;
    }
  } catch (const InputError& error) {
    transport_.abort(name_of(message.from) + ": " + error.what());
  }
  transport_.abort(name_of(message.from) + " has sent a message of kind " + std::to_string(message.kind));
}

void RankHands::greet(unsigned rank, const std::vector<std::byte>& bytes) {
  const auto greeting = content_of<Greeting>(bytes);
  others_[rank].host = greeting.host;
  if (greeting.program != program_)
    transport_.abort(name_of(rank) + " runs another build of torolux than rank 0; start the same on all computers");
}

void RankHands::take_answer(unsigned rank, const std::vector<std::byte>& bytes) {
  auto answer = content_of<FarmAnswer>(bytes);
  if (others_[rank].orders.erase(answer.number) == 0) return;
  answers_.push_back({answer.number, Outcome{answer.exit_code, std::move(answer.errors), std::move(answer.result)}});
}

void RankHands::give_up(const Other& other) {
  for (const std::uint64_t number : other.orders) answers_.push_back({number, std::nullopt});
}

void RankHands::look_for_silence() {
  for (unsigned rank = 1; rank < others_.size(); ++rank) {
    Other& other = others_[rank];
    if (life_->silent(rank) == other.silent) continue;
    other.silent = !other.silent;
    if (!other.silent) {
      tell(name_of(rank) + " is heard again");
      continue;
    }
    const double seconds = std::chrono::duration<double>(times_.silence).count();
    tell(name_of(rank) + " has been silent for " + std::to_string(static_cast<int>(seconds)) +
         " s and counts as lost; its runs are handed out again");
    give_up(other);
  }
}

void RankHands::send_all(FarmMessage kind, const std::vector<std::byte>& bytes) {
  for (unsigned rank = 1; rank < others_.size(); ++rank) transport_.send(rank, static_cast<std::uint32_t>(kind), bytes);
}

void RankHands::end(int exit_code) {
  constexpr std::chrono::milliseconds kPause{50};
  send_all(FarmMessage::end, {});
  // Closing would wait for ever for one that has died since it was last looked at.
  while (std::any_of(others_.begin() + 1, others_.end(), [](const Other& o) { return !o.ready && !o.silent; })) {
    transport_.wait(kPause);
    poll();
  }
  std::vector<unsigned> lost;
  for (unsigned rank = 1; rank < others_.size(); ++rank) {
    if (!others_[rank].ready) lost.push_back(rank);
  }
  send_all(FarmMessage::close, bytes_of(FarmClose{lost, exit_code}));
  life_.reset();
  transport_.close(lost, exit_code);
}

}  // namespace torolux::study
