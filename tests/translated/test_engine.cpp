// SPDX-License-Identifier: MIT
// The smallest engine that runs translated code: one thread for each PE.
#include <atomic>
#include <mutex>
#include <optional>
#include <thread>

#include "emulator/errors.hpp"
#include "emulator/niu/processor_side.hpp"
#include "tests/translated/runs.hpp"

namespace torolux::test {
namespace {

using translated::TranslatedImage;
using translated::TranslatedPe;

class TestEngine final : public Engine {
 public:
  TestEngine(const EngineSetup& setup, const translated::TranslationOptions& options)
      : setup_(setup), image_(setup.image, setup.machine.processor.latency, options) {}
  TestEngine(const TestEngine&) = delete;
  TestEngine& operator=(const TestEngine&) = delete;
  ~TestEngine() override { end(); }

  std::string_view name() const override { return "translated, in a test"; }
  void start() override {
    for (std::size_t pe = 0; pe < setup_.pes.size(); ++pe) threads_.emplace_back([this, pe] { work(pe); });
  }
  void check() override {
    const std::lock_guard lock(mutex_);
    if (!failure_.empty()) throw MachineFailure(failure_);
  }
  void stop() override { end(); }

 private:
  void work(std::size_t number) {
    PeMemory& memory = setup_.pes[number];
    const auto local = memory.local.bytes().first(memory.local_memory_bytes);
    NiuProcessorSide niu(*niu_channel_at(memory.channel.bytes().data()), local,
                         setup_.image.niu_window - protocol::kLocalMemoryBase);
    TranslatedPe pe{};
    image_.start(pe, local, memory.local.bytes().size());
    constexpr std::uint64_t kSlice = 10'000'000;
    while (!ending_) {
      pe.cycle_limit = pe.cycles + kSlice;
      const TranslatedImage::Stop why = image_.run(pe);
      if (why == TranslatedImage::Stop::stuck) return fail(number, pe);
      if (why == TranslatedImage::Stop::hint && !hint(niu, pe)) return;
    }
  }

  bool hint(NiuProcessorSide& niu, TranslatedPe& pe) {
    while (!ending_) {
      const auto result = niu.hint(pe.hint_immediate, pe.cycles, pe.instructions);
      if (result.outcome == NiuProcessorSide::Outcome::stop) return false;
      pe.cycles = result.clock;
      if (result.outcome == NiuProcessorSide::Outcome::done) return true;
    }
    return false;
  }

  void fail(std::size_t number, const TranslatedPe& pe) {
    const std::lock_guard lock(mutex_);
    failure_ = "PE " + std::to_string(number) + " is stuck at " + std::to_string(pe.pc);
  }
  void end() {
    ending_ = true;
    for (std::thread& thread : threads_) {
      if (thread.joinable()) thread.join();
    }
  }

  EngineSetup setup_;
  TranslatedImage image_;
  std::vector<std::thread> threads_;
  std::atomic<bool> ending_ = false;
  std::mutex mutex_;
  std::string failure_;
};

}  // namespace

std::unique_ptr<Engine> make_test_engine(const EngineSetup& setup, const translated::TranslationOptions& options) {
  return std::make_unique<TestEngine>(setup, options);
}

}  // namespace torolux::test
