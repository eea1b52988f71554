// SPDX-License-Identifier: MIT
// Threads take PEs that may run; the scheduler's thread lends a hand instead of sleeping.
#include "emulator/engines/translated/run/translated_engine.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <deque>
#include <thread>

#include "emulator/engines/translated/run/lent_processor.hpp"
#include "emulator/engines/translated/run/processor.hpp"
#include "emulator/engines/translated/run/run_queue.hpp"
#include "emulator/engines/translated/run/turn_keeper.hpp"
#include "emulator/niu/channel.hpp"
#include "emulator/pause.hpp"
#include "emulator/profile/cycle_profile.hpp"

namespace torolux {
namespace {

using translated::Goal;
using translated::Processor;
using translated::RunQueue;
using translated::TranslatedImage;
using translated::TurnKeeper;
using Clock = std::chrono::steady_clock;

/// Looks for news or another PE before the scheduler's thread sleeps: some 20 microseconds.
constexpr int kLooks = 500;

/// While takers have nothing to do, the scheduler's thread is wanted: by the news of a PE.
class News final : public Goal {
 public:
  News(const NiuChannel& channel, std::uint64_t wanted, const RunQueue& queue)
      : channel_(channel), wanted_(wanted), queue_(queue) {}
  bool there() const {
    return channel_.bound.load(std::memory_order_relaxed) > wanted_ ||
           wait_kind(channel_.wait.load(std::memory_order_relaxed)) != WaitKind::running;
  }
  bool reached() const override { return queue_.has_idle_takers() && there(); }

 private:
  const NiuChannel& channel_;
  std::uint64_t wanted_;
  const RunQueue& queue_;
};

/// One thread for events and one for each PE: more would only look for work.
EngineSetup with_threads_that_help(EngineSetup setup) {
  setup.threads = std::min(setup.threads, static_cast<unsigned>(setup.pes.size()) + 1U);
  return setup;
}

class TranslatedEngine final : public Engine, private ProcessorWaker {
 public:
  TranslatedEngine(const EngineSetup& setup, const translated::TranslationOptions& options)
      : setup_(with_threads_that_help(setup)),
        interprets_(options.interpret),
        queue_(setup.pes.size(), setup_.threads - 1),
        turns_(setup_.threads == 1 ? setup.turns : nullptr, setup.pes.size()) {
    translated::TranslationOptions of_images = options;
    of_images.interrupted = setup.interrupted;
    for (const Image& image : setup.images.images()) {
      codes_.emplace_back(image, setup.machine.processor.latency, of_images);
    }
    for (unsigned pe = 0; pe < setup.pes.size(); ++pe) {
      // A debugger's PEs are run by nobody else.
      if ((!setup_.runs(pe) || setup_.holds(pe)) && queue_.claim(pe)) queue_.finish(pe);
    }
  }
  TranslatedEngine(const TranslatedEngine&) = delete;
  TranslatedEngine& operator=(const TranslatedEngine&) = delete;
  ~TranslatedEngine() override { end(); }

  std::string_view name() const override { return interprets_ ? "interpreted" : "translated"; }

  void start() override {
    if (setup_.profile != nullptr) setup_.profile->begin(setup_.pes.size());
    for (unsigned pe = 0; pe < setup_.pes.size(); ++pe) {
      if (setup_.profile != nullptr) setup_.profile->add(setup_.images.of(pe));
      processors_.emplace_back(codes_[setup_.images.number_of(pe)], setup_, pe);
      if (pe < restored_.size() && restored_[pe]) processors_.back().restore(*restored_[pe]);
    }
    restored_.clear();
    lend_to_debugger();
    turns_.begin();
    for (unsigned i = 1; i < setup_.threads; ++i) threads_.emplace_back([this] { work(); });
  }

  void check() override {
    if (setup_.debugger != nullptr) setup_.debugger->look();
  }
  void stop() override {
    turns_.end(helped_);
    end();
  }

  bool can_be_saved() const override { return true; }
  void hold() override;
  void let_go() override;
  PeRegisters save(unsigned pe) override;
  std::optional<StackRegisters> stack_registers(unsigned pe) override;
  void restore(unsigned pe, const PeRegisters& registers) override {
    restored_.resize(setup_.pes.size());
    restored_[pe] = registers;
  }

  ProcessorWaker* waker(unsigned /*pe*/) override { return this; }
  bool help(unsigned pe, std::uint64_t wanted) override;
  bool takes_turns(unsigned pe) const override { return setup_.holds(pe); }
  /// Not where a log of turns is kept: it says when each could have gone on.
  bool runs_only_helped(unsigned pe) const override {
    return setup_.threads == 1 && setup_.turns == nullptr && setup_.runs(pe) && !setup_.holds(pe);
  }
  void fetch_ahead(unsigned pe) const override { processors_[pe].fetch_ahead(); }
  double help_seconds() const override { return std::chrono::duration<double>(helped_).count(); }

 private:
  void wake(unsigned pe) override {
    turns_.woken(pe, helped_);
    queue_.wake(pe);
  }
  void lend_to_debugger();
  void work();
  bool run(unsigned pe, const Goal* goal);
  bool claim_standing(unsigned pe);
  template <class Look>
  auto while_it_stands(unsigned pe, Look look);
  void end();

  EngineSetup setup_;
  bool interprets_;
  std::deque<TranslatedImage> codes_;  // of each image
  RunQueue queue_;
  std::vector<std::optional<PeRegisters>> restored_;  // by PE, until the start
  std::deque<Processor> processors_;
  std::vector<unsigned> held_;  // PEs, from `hold` to `let_go`
  bool is_held_ = false;
  std::vector<std::thread> threads_;
  std::atomic<bool> ending_ = false;
  Clock::duration helped_{};
  TurnKeeper turns_;
};

/// Runs a PE that is the calling thread's until it is not any more. True: it could go on at once.
bool TranslatedEngine::run(unsigned pe, const Goal* goal) {
  for (;;) {
    switch (processors_[pe].run(goal)) {
      case Processor::Stop::waits:
        if (queue_.park(pe)) return false;
        break;  // woken: the HINT is tried again
      case Processor::Stop::enough:
      case Processor::Stop::slice:
        queue_.put_back(pe);
        return true;
      case Processor::Stop::finished:
        queue_.finish(pe);
        return false;
    }
  }
}

void TranslatedEngine::work() {
  while (!ending_.load(std::memory_order_relaxed)) {
    if (const auto pe = queue_.wait_and_take()) run(*pe, nullptr);
  }
}

void TranslatedEngine::lend_to_debugger() {
  if (setup_.debugger == nullptr) return;
  std::vector<std::unique_ptr<DebuggedPe>> lent(setup_.pes.size());
  for (unsigned pe = 0; pe < lent.size(); ++pe) {
    if (!setup_.holds(pe)) continue;
    processors_[pe].take_turns();
    lent[pe] = translated::lend(processors_[pe]);
  }
  setup_.debugger->begin(std::move(lent));
}

bool TranslatedEngine::help(unsigned pe, std::uint64_t wanted) {
  if (setup_.holds(pe)) {
    setup_.debugger->turn(pe, wanted);
    return true;
  }
  const News news(processors_[pe].channel(), wanted, queue_);
  if (!queue_.claim(pe)) {
    std::optional<unsigned> other = queue_.take();
    for (int i = 0; i < kLooks && !other; ++i) {
      if (news.there()) return true;
      torolux::pause();
      other = queue_.take();
    }
    if (!other) return false;
    pe = *other;
  }
  const Clock::time_point begin = Clock::now();
  queue_.scheduler_runs_pe(true);
  const bool goes_on = run(pe, threads_.empty() ? nullptr : &news);
  queue_.scheduler_runs_pe(false);
  const Clock::time_point end = Clock::now();
  turns_.ran(pe, begin, end, helped_, goes_on);
  helped_ += end - begin;
  return true;
}

/// Makes it the caller's as soon as nobody runs it: a thread that has just seen that it waits may not have let go of it
/// yet; one that runs it lets go at the end of its slice. False: it has finished.
bool TranslatedEngine::claim_standing(unsigned pe) {
  while (!queue_.claim(pe)) {
    if (queue_.has_finished(pe)) return false;
    torolux::pause();
  }
  return true;
}

void TranslatedEngine::hold() {
  for (unsigned pe = 0; pe < processors_.size(); ++pe) {
    if (claim_standing(pe)) held_.push_back(pe);
  }
  is_held_ = true;
}

void TranslatedEngine::let_go() {
  is_held_ = false;
  for (const unsigned pe : held_) queue_.put_back(pe);
  held_.clear();
}

/// What `look` returns of the PE, while nobody runs it.
template <class Look>
auto TranslatedEngine::while_it_stands(unsigned pe, Look look) {
  const bool claimed = !is_held_ && claim_standing(pe);
  const auto seen = look(processors_[pe]);
  if (claimed) queue_.put_back(pe);
  return seen;
}

PeRegisters TranslatedEngine::save(unsigned pe) {
  return while_it_stands(pe, [](const Processor& processor) { return processor.save(); });
}

std::optional<StackRegisters> TranslatedEngine::stack_registers(unsigned pe) {
  if (pe >= processors_.size()) return std::nullopt;
  return while_it_stands(pe, [](const Processor& processor) { return processor.stack_registers(); });
}

void TranslatedEngine::end() {
  ending_ = true;
  if (setup_.debugger != nullptr) setup_.debugger->end();
  queue_.close();
  for (std::thread& thread : threads_) {
    if (thread.joinable()) thread.join();
  }
}

}  // namespace

std::unique_ptr<Engine> make_translated_engine(const EngineSetup& setup,
                                               const translated::TranslationOptions& options) {
  return std::make_unique<TranslatedEngine>(setup, options);
}

}  // namespace torolux
