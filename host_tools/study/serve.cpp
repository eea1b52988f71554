// SPDX-License-Identifier: MIT
// A loop over messages and child processes.
#include "host_tools/study/serve.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <system_error>

#include "emulator/ranks/launched.hpp"
#include "host_tools/cli/command.hpp"
#include "host_tools/study/farm_messages.hpp"

namespace torolux::study {
namespace {

/// Child processes are looked at so often; messages wake at once.
constexpr std::chrono::milliseconds kShortestPause{1}, kLongestPause{50};

class Server {
 public:
  Server(ranks::Transport& transport, Hands& hands, ranks::LifeTimes times)
      : transport_(transport), hands_(hands), life_(transport, {0}, times) {}

  FarmClose run(const std::string& program) {
    send(FarmMessage::greeting, bytes_of(Greeting{ranks::host_name(), program}));
    std::chrono::milliseconds pause = kShortestPause;
    while (!close_) {
      const bool received = receive();
      const bool answered = answer();
      if (interrupted() && !left_) leave();
      if (life_.silent(0)) transport_.abort("rank 0 is silent and counts as lost");
      pause = received || answered ? kShortestPause : std::min(2 * pause, kLongestPause);
      if (!close_) transport_.wait(pause);
    }
    return *close_;
  }

 private:
  void send(FarmMessage kind, const std::vector<std::byte>& bytes) {
    transport_.send(0, static_cast<std::uint32_t>(kind), bytes);
  }

  bool receive() {
    bool any = false;
    while (const std::optional<ranks::Message> message = life_.poll()) {
      any = true;
      try {
        take(*message);
      } catch (const InputError& error) {
        transport_.abort(error.what());
      } catch (const std::system_error& error) {
        transport_.abort(error.what());
      }
    }
    return any;
  }

  void take(const ranks::Message& message) {
    if (message.from != 0)
      throw InputError("rank " + std::to_string(message.from) + " has sent a message; only rank 0 gives orders");
    switch (static_cast<FarmMessage>(message.kind)) {
      case FarmMessage::order:
        return begin(content_of<FarmOrder>(message.bytes));
      case FarmMessage::end:
        hands_.stop();
        return send(FarmMessage::ready, {});
      case FarmMessage::close:
        return close(content_of<FarmClose>(message.bytes));
      case FarmMessage::greeting:
      case FarmMessage::answer:
      case FarmMessage::leaving:
      case FarmMessage::ready:
        break;
    }
    throw InputError("rank 0 has sent a message of kind " + std::to_string(message.kind));
  }

  void close(FarmClose asked) {
    const unsigned count = transport_.ranks().count;
    for (const unsigned rank : asked.lost)
      if (rank >= count)
        throw InputError("rank 0 counts rank " + std::to_string(rank) + " as lost; there are " + std::to_string(count));
    close_ = std::move(asked);
  }

  void begin(const FarmOrder& order) {
    if (left_) return;
    std::error_code error;
    std::filesystem::current_path(order.folder, error);
    if (error) throw InputError("there is no folder " + order.folder + " here as rank 0 has: " + error.message());
    hands_.start(order.order);
  }

  bool answer() {
    bool any = false;
    while (std::optional<Answer> answer = hands_.poll()) {
      any = true;
      Outcome& outcome = *answer->outcome;
      // Told to end, both this process and its runs may have been: then they have not failed.
      if (interrupted()) continue;
      send(FarmMessage::answer, bytes_of(FarmAnswer{answer->number, outcome.exit_code, std::move(outcome.errors),
                                                    std::move(outcome.result)}));
    }
    return any;
  }

  void leave() {
    hands_.stop();
    left_ = true;
    send(FarmMessage::leaving, {});
  }

  ranks::Transport& transport_;
  Hands& hands_;
  ranks::LifeSigns life_;
  std::optional<FarmClose> close_;
  bool left_ = false;
};

}  // namespace

void serve(ranks::Transport& transport, Hands& hands, const std::string& program, ranks::LifeTimes times) {
  const FarmClose close = Server(transport, hands, times).run(program);
  transport.close(close.lost, close.exit_code);
}

}  // namespace torolux::study
