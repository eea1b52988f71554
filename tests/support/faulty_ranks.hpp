// SPDX-License-Identifier: MIT
// A rank's transport that loses its connection, or whose computer is slow, or whose messages somebody looks at, changes
// or holds up: another transport enters, the same calls leave.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <deque>
#include <functional>
#include <optional>
#include <thread>
#include <utility>

#include "emulator/ranks/transport.hpp"

namespace torolux::test {

/// From the message on at which it is cut, nothing comes and nothing that is sent arrives; the process lives on, and
/// ends itself alone where it gives up.
class CutTransport final : public ranks::Transport {
 public:
  /// cuts: asked about each message but signs of life; the one at which it says yes is not received.
  CutTransport(ranks::Transport& whole, std::function<bool(const ranks::Message&)> cuts)
      : whole_(whole), cuts_(std::move(cuts)) {}

  ranks::Ranks ranks() const override { return whole_.ranks(); }
  void send(unsigned to, std::uint32_t kind, std::span<const std::byte> bytes) override {
    if (!is_cut_) whole_.send(to, kind, bytes);
  }
  std::optional<ranks::Message> poll() override {
    if (is_cut_) return std::nullopt;
    std::optional<ranks::Message> message = whole_.poll();
    if (!message || message->kind == ranks::kLifeSign || !cuts_(*message)) return message;
    is_cut_ = true;
    return std::nullopt;
  }
  bool wait(std::chrono::milliseconds limit) override {
    if (!is_cut_) return whole_.wait(limit);
    std::this_thread::sleep_for(std::min(limit, std::chrono::milliseconds(2)));
    return false;
  }
  [[noreturn]] void abort(const std::string& reason) override { throw ranks::RankFailure(reason); }
  void close(std::span<const unsigned> lost, int exit_code) override {
    if (!is_cut_) whole_.close(lost, exit_code);
  }

 private:
  ranks::Transport& whole_;
  std::function<bool(const ranks::Message&)> cuts_;
  std::atomic<bool> is_cut_ = false;
};

/// Each look for a message takes a while, as on a core that others have most of the time.
class SlowTransport final : public ranks::Transport {
 public:
  SlowTransport(ranks::Transport& fast, std::chrono::microseconds look) : fast_(fast), look_(look) {}

  ranks::Ranks ranks() const override { return fast_.ranks(); }
  void send(unsigned to, std::uint32_t kind, std::span<const std::byte> bytes) override { fast_.send(to, kind, bytes); }
  std::optional<ranks::Message> poll() override {
    std::this_thread::sleep_for(look_);
    return fast_.poll();
  }
  bool wait(std::chrono::milliseconds limit) override { return fast_.wait(limit); }
  [[noreturn]] void abort(const std::string& reason) override {
    fast_.abort(reason);
    throw ranks::RankFailure(reason);  // compilers may think that it comes back
  }
  void close(std::span<const unsigned> lost, int exit_code) override { fast_.close(lost, exit_code); }

 private:
  ranks::Transport& fast_;
  std::chrono::microseconds look_;
};

/// Somebody sees each message that comes, but signs of life.
class TappedTransport final : public ranks::Transport {
 public:
  /// tap: may change the message; false: it is lost.
  TappedTransport(ranks::Transport& whole, std::function<bool(ranks::Message&)> tap)
      : whole_(whole), tap_(std::move(tap)) {}

  ranks::Ranks ranks() const override { return whole_.ranks(); }
  void send(unsigned to, std::uint32_t kind, std::span<const std::byte> bytes) override {
    whole_.send(to, kind, bytes);
  }
  std::optional<ranks::Message> poll() override {
    while (std::optional<ranks::Message> message = whole_.poll()) {
      if (message->kind == ranks::kLifeSign || tap_(*message)) return message;
    }
    return std::nullopt;
  }
  bool wait(std::chrono::milliseconds limit) override { return whole_.wait(limit); }
  [[noreturn]] void abort(const std::string& reason) override {
    whole_.abort(reason);
    throw ranks::RankFailure(reason);
  }
  void close(std::span<const unsigned> lost, int exit_code) override { whole_.close(lost, exit_code); }

 private:
  ranks::Transport& whole_;
  std::function<bool(ranks::Message&)> tap_;
};

/// Messages of one kind come later than all others that were sent at about the same time.
class LateTransport final : public ranks::Transport {
 public:
  LateTransport(ranks::Transport& whole, std::uint32_t kind, std::chrono::microseconds late)
      : whole_(whole), kind_(kind), late_(late) {}

  ranks::Ranks ranks() const override { return whole_.ranks(); }
  void send(unsigned to, std::uint32_t kind, std::span<const std::byte> bytes) override {
    whole_.send(to, kind, bytes);
  }
  std::optional<ranks::Message> poll() override {
    while (std::optional<ranks::Message> message = whole_.poll()) {
      if (message->kind != kind_) return message;
      held_.emplace_back(Clock::now() + late_, std::move(*message));
    }
    if (held_.empty() || held_.front().first > Clock::now()) return std::nullopt;
    ranks::Message first = std::move(held_.front().second);
    held_.pop_front();
    return first;
  }
  bool wait(std::chrono::milliseconds limit) override { return whole_.wait(limit); }
  [[noreturn]] void abort(const std::string& reason) override {
    whole_.abort(reason);
    throw ranks::RankFailure(reason);
  }
  void close(std::span<const unsigned> lost, int exit_code) override { whole_.close(lost, exit_code); }

  bool holds() const { return !held_.empty(); }

 private:
  using Clock = std::chrono::steady_clock;

  ranks::Transport& whole_;
  std::uint32_t kind_;
  std::chrono::microseconds late_;
  std::deque<std::pair<Clock::time_point, ranks::Message>> held_;
};

}  // namespace torolux::test
