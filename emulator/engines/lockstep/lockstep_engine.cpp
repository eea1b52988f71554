// SPDX-License-Identifier: MIT
// QEMU's engine, whose plugin leaves HINTs to us, and a Pair for each PE.
#include "emulator/engines/lockstep/lockstep_engine.hpp"

#include <deque>

#include "emulator/engines/lockstep/pair.hpp"
#include "emulator/engines/qemu/qemu_engine.hpp"
#include "emulator/errors.hpp"

namespace torolux::lockstep {
namespace {

std::vector<SharedMemory> make_meetings(std::size_t pes) {
  std::vector<SharedMemory> meetings;
  for (std::size_t pe = 0; pe < pes; ++pe) meetings.emplace_back("torolux-meeting", sizeof(HintMeeting));
  return meetings;
}

class LockstepEngine final : public Engine {
 public:
  LockstepEngine(const EngineSetup& setup, const Options& options)
      : meetings_(make_meetings(setup.pes.size())),
        qemu_(make_qemu_engine(setup, {.meetings = &meetings_})),
        ended_(options.ended) {
    const LatencyTable& latency = setup.machine.processor.latency;
    for (const Image& image : setup.images.images()) {
      codes_.emplace_back(options.other_image != nullptr ? *options.other_image : image,
                          options.other_latency != nullptr ? *options.other_latency : latency, options.translation);
      maps_.emplace_back(image, latency);
      common_.push_back({setup, codes_.back(), maps_.back()});
    }
    for (unsigned pe = 0; pe < setup.pes.size(); ++pe) {
      pairs_.emplace_back(common_[setup.images.number_of(pe)], pe, meetings_[pe]);
    }
  }

  std::string_view name() const override { return "lockstep"; }

  void start() override {
    qemu_->start();
    for (Pair& pair : pairs_) pair.start();
  }

  void check() override {
    for (const Pair& pair : pairs_) {
      if (const auto difference = pair.difference()) throw MachineFailure(*difference);
    }
    qemu_->check();
  }

  void stop() override {
    for (Pair& pair : pairs_) pair.end();
    qemu_->stop();
    if (!ended_) return;
    Totals sum;
    for (const Pair& pair : pairs_) {
      sum.hints += pair.totals().hints;
      sum.markers += pair.totals().markers;
      sum.instructions += pair.totals().instructions;
      sum.bytes += pair.totals().bytes;
    }
    ended_(sum);
  }

  double cpu_seconds() const override { return qemu_->cpu_seconds(); }

 private:
  // Of each image.
  std::deque<translated::TranslatedImage> codes_;
  std::deque<translated::CodeMap> maps_;
  std::deque<Common> common_;
  std::vector<SharedMemory> meetings_;
  std::unique_ptr<Engine> qemu_;
  std::deque<Pair> pairs_;
  std::function<void(const Totals&)> ended_;
};

}  // namespace

std::unique_ptr<Engine> make_engine(const EngineSetup& setup, const Options& options) {
  return std::make_unique<LockstepEngine>(setup, options);
}

}  // namespace torolux::lockstep
