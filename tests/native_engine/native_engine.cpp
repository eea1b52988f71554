// SPDX-License-Identifier: MIT
// The engine `native`: one thread per PE.
#include "tests/native_engine/native_engine.hpp"

#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "emulator/engines/engine_names.hpp"
#include "emulator/errors.hpp"
#include "emulator/niu/processor_side.hpp"

namespace torolux::test {

namespace {

/// Thrown through a program that is to execute nothing more.
struct Stopped {};

/// The emulator's NIU as native firmware sees it.
class NativeNiu final : public pe::HintTarget {
 public:
  NativeNiu(NiuProcessorSide side, unsigned pe, const NativeOptions& options, NativeClock& clock)
      : side_(side), pe_(pe), options_(options), clock_(clock) {}

  void hint(std::int32_t immediate) override {
    const bool marker = immediate >= static_cast<std::int32_t>(protocol::Hint::enter_phase);
    if (!marker) clock_.hint(options_.cycles_per_hint);
    if (options_.before_hint) options_.before_hint(pe_);
    for (;;) {
      const auto result = side_.hint(immediate, clock_.cycles(), clock_.spent());
      if (result.outcome == NiuProcessorSide::Outcome::retry) continue;
      // Markers come from destructors, too, on the way out: those must not throw.
      if (result.outcome == NiuProcessorSide::Outcome::stop && marker) return;
      if (result.outcome == NiuProcessorSide::Outcome::stop) throw Stopped();
      clock_.set(result.clock);
      return;
    }
  }

 private:
  NiuProcessorSide side_;
  unsigned pe_;
  const NativeOptions& options_;
  NativeClock& clock_;
};

class NativeEngine final : public Engine {
 public:
  NativeEngine(const EngineSetup& setup, NativeProgram program, NativeOptions options)
      : image_(setup.images.of(0)), pes_(setup.pes), program_(std::move(program)), options_(std::move(options)) {}
  ~NativeEngine() override { join(); }

  std::string_view name() const override { return "native"; }
  void start() override {
    for (unsigned pe = 0; pe < pes_.size(); ++pe) threads_.emplace_back([this, pe] { work(pe); });
  }
  void check() override {
    const std::lock_guard lock(mutex_);
    if (!failure_.empty()) throw MachineFailure(failure_);
  }
  void stop() override { join(); }

 private:
  void work(unsigned pe) {
    const auto memory = pes_[pe].local.bytes().first(pes_[pe].local_memory_bytes);
    const std::uint32_t offset = image_.niu_window - protocol::kLocalMemoryBase;
    NativeClock clock;
    NativeNiu target(NiuProcessorSide(*niu_channel_at(pes_[pe].channel.bytes().data()), memory, offset), pe, options_,
                     clock);
    auto& page = *reinterpret_cast<pe::NiuPage*>(memory.data() + offset);
    pe::Niu niu(page, pe::Memory(pe::LocalBase(memory.data(), image_.stores_begin)), pe::HintGate(target));
    try {
      program_(niu, clock);
      niu.halt();
    } catch (const Stopped&) {
    } catch (const std::exception& error) {
      const std::lock_guard lock(mutex_);
      if (failure_.empty()) failure_ = "PE " + std::to_string(pe) + ": " + error.what();
    }
  }
  void join() {
    for (std::thread& thread : threads_) {
      if (thread.joinable()) thread.join();
    }
  }

  const Image& image_;
  std::vector<PeMemory>& pes_;
  NativeProgram program_;
  NativeOptions options_;
  std::vector<std::thread> threads_;
  std::mutex mutex_;
  std::string failure_;
};

}  // namespace

void register_native_engine(NativeProgram program, NativeOptions options) {
  register_engine("native", [program = std::move(program), options = std::move(options)](const EngineSetup& setup) {
    return std::make_unique<NativeEngine>(setup, program, options);
  });
}

Image empty_image() {
  Image image;
  image.file = "empty image";
  image.entry = protocol::kLocalMemoryBase;
  image.niu_window = protocol::kLocalMemoryBase + protocol::kPageBytes;
  image.stores_begin = image.niu_window + protocol::kPageBytes;
  return image;
}

}  // namespace torolux::test
