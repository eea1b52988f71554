// SPDX-License-Identifier: MIT
// A loop over messages and PEs.
#include "emulator/remote/serve_pes.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>

#include "emulator/errors.hpp"
#include "emulator/ranks/content.hpp"
#include "emulator/ranks/launched.hpp"
#include "emulator/remote/pe_block.hpp"
#include "emulator/remote/wire.hpp"

namespace torolux::remote {
namespace {

using Clock = std::chrono::steady_clock;

/// News wait so long for others to go with them, while PEs run and rank 0 waits for none of them.
constexpr std::chrono::microseconds kGather{500};
/// But not when there are so many bytes of them.
constexpr std::size_t kManyBytes = 64U << 10U;
/// While other threads run PEs, their news are looked for so often.
constexpr std::chrono::microseconds kBetweenLooks{50};
/// A sleep where nothing can run; and where there is no machine. Transports sleep the longer the longer nothing comes.
constexpr std::chrono::milliseconds kSleep{2}, kLongSleep{100};

class Server {
 public:
  Server(ranks::Transport& transport, ranks::LifeTimes times)
      : transport_(transport), times_(times), life_(transport, {0}, times) {}

  Close run(const std::string& program) {
    send(Kind::greeting, ranks::bytes_of(Greeting{ranks::host_name(), program}));
    while (!close_) {
      receive();
      if (close_) break;
      const bool ran = runs_ && attempt([this] { return block_->run(); });
      send_news();
      if (life_.silent(0)) transport_.abort("rank 0 is silent and counts as lost");
      look_for_lost_payloads();
      if (ran) continue;
      if (runs_ && !block_->rests()) {
        std::this_thread::sleep_for(kBetweenLooks);
        attempt([this] {
          block_->check();
          return true;
        });
      } else {
        transport_.wait(runs_ ? kSleep : kLongSleep);
      }
    }
    return *close_;
  }

 private:
  void send(Kind kind, std::span<const std::byte> bytes) {
    transport_.send(0, static_cast<std::uint32_t>(kind), bytes);
  }

  /// What goes wrong here ends the machine, and rank 0 says why.
  template <class Work>
  bool attempt(Work work) {
    try {
      return work();
    } catch (const ranks::RankFailure&) {
      throw;
    } catch (const std::bad_alloc&) {
      fail("this computer has too little memory for its PEs");
    } catch (const std::exception& error) {
      fail(error.what());
    }
    return false;
  }
  void fail(const std::string& why) {
    runs_ = false;
    block_.reset();
    send(Kind::failed, ranks::bytes_of(why));
  }

  void receive() {
    while (const std::optional<ranks::Message> message = life_.poll()) {
      attempt([&] {
        take(*message);
        return true;
      });
    }
  }

  void take(const ranks::Message& message) {
    const auto kind = static_cast<Kind>(message.kind);
    if (kind == Kind::close) {
      close_ = ranks::content_of<Close>(message.bytes);
      return;
    }
    if (kind == Kind::setup) {
      block_.reset();
      block_ = std::make_unique<PeBlock>(setup_of_bytes(message.bytes));
      return send(Kind::ready, ranks::bytes_of(block_->can_be_saved()));
    }
    if (kind == Kind::stop) {
      runs_ = false;
      if (block_ != nullptr) block_->stop();
      return send(Kind::stopped, {});
    }
    if (block_ == nullptr) return;  // it has failed, and rank 0 does not know that yet
    if (kind == Kind::payloads) {
      awaited_for_ = Clock::duration(0);
      block_->take_payloads(message.from, message.bytes);
      return send_kept();
    }
    take_of_machine(kind, message.bytes);
  }

  void take_of_machine(Kind kind, std::span<const std::byte> bytes) {
    switch (kind) {
      case Kind::start:
        block_->start(ranks::content_of<Start>(bytes));
        runs_ = true;
        return;
      case Kind::restore:
        block_->restore(bytes);
        return send(Kind::restored, {});
      case Kind::words:
        return block_->take_words(bytes);
      case Kind::ask_figures:
        return send(Kind::figures, block_->figures());
      case Kind::ask_memory:
        return send(Kind::memory, block_->memory(ranks::content_of<MemoryPart>(bytes)));
      case Kind::ask_registers:
        return send(Kind::registers, ranks::bytes_of(block_->registers(ranks::content_of<std::uint32_t>(bytes))));
      case Kind::hold:
        block_->hold();
        send_all_news();
        return send(Kind::held, {});
      case Kind::ask_kept:
        block_->ask_kept(bytes);
        return send_kept();
      case Kind::ask_channel:
        return send(Kind::channel, block_->channel(ranks::content_of<std::uint32_t>(bytes)));
      case Kind::ask_saved:
        return send(Kind::saved, ranks::bytes_of(block_->saved(ranks::content_of<std::uint32_t>(bytes))));
      case Kind::let_go:
        return block_->let_go();
      default:
        throw MachineFailure("rank 0 has sent a message of kind " + std::to_string(static_cast<std::uint32_t>(kind)));
    }
  }

  void send_news() {
    if (!runs_ || block_->news().empty()) return;
    const Clock::time_point now = Clock::now();
    const bool due =
        block_->has_wanted_news() || block_->rests() || block_->bytes_to_send() >= kManyBytes || now - sent_ >= kGather;
    if (due) send_all_news();
  }

  void send_all_news() {
    sent_ = Clock::now();
    block_->send_payloads([this](unsigned rank, std::span<const std::byte> bytes) {
      transport_.send(rank, static_cast<std::uint32_t>(Kind::payloads), bytes);
    });
    send(Kind::news, block_->news().bytes());
    block_->forget_news();
  }

  void send_kept() {
    if (const auto payloads = block_->kept()) send(Kind::kept, *payloads);
  }

  /// Those that a word names were sent before. As in LifeSigns, time in which this rank was busy counts little.
  void look_for_lost_payloads() {
    const Clock::time_point now = Clock::now();
    const Clock::duration since = std::min<Clock::duration>(now - looked_, times_.silence / 8);
    looked_ = now;
    const bool awaits = block_ != nullptr && block_->awaits_payload();
    awaited_for_ = awaits ? awaited_for_ + since : Clock::duration(0);
    if (awaited_for_ >= times_.silence) fail(block_->awaited_payload() + ": it counts as lost");
  }

  ranks::Transport& transport_;
  ranks::LifeTimes times_;
  ranks::LifeSigns life_;
  std::unique_ptr<PeBlock> block_;
  bool runs_ = false;
  Clock::time_point sent_;
  Clock::time_point looked_ = Clock::now();
  Clock::duration awaited_for_{0};
  std::optional<Close> close_;
};

}  // namespace

void serve_pes(ranks::Transport& transport, const std::string& program, ranks::LifeTimes times) {
  const Close close = Server(transport, times).run(program);
  transport.close(close.lost, close.exit_code);
}

}  // namespace torolux::remote
