// SPDX-License-Identifier: MIT
// A host program that listens; a machine of 4x2 PEs, again for each time that the debugger goes back.
#include "tests/machine/debugged_machine.hpp"

#include <sstream>

#include "emulator/errors.hpp"

namespace torolux::test {
namespace {

std::filesystem::path image_file(const std::string& name) {
  return std::filesystem::path(TOROLUX_FIRMWARE_DIR) / (name + ".elf");
}

class Listener final : public HostProgram {
 public:
  explicit Listener(std::function<void(const std::string&)> hears) : hears_(std::move(hears)) {}
  void start(HostPort& /*port*/) override {}
  void on_message(HostPort& port, PeNumber source, std::uint16_t /*kind*/,
                  std::span<const std::byte> contents) override {
    std::string text = std::to_string(source) + " @ " + std::to_string(port.now()) + ": ";
    for (const std::byte byte : contents) text += static_cast<char>(byte);
    hears_(text);
  }
  bool finished() const override { return true; }
  const char* waiting_for() const override { return "text"; }
  bool can_be_saved() const override { return true; }

 private:
  std::function<void(const std::string&)> hears_;
};

std::string exact(const MachineFigures& figures) {
  std::ostringstream text;
  text << figures.now << " " << figures.trace_hash << " " << figures.bus.transfers << "\n";
  for (const PeFigures& pe : figures.pes) {
    text << pe.busy_cycles << " " << pe.idle_cycles() << " " << pe.instructions << " " << pe.packets_sent << " "
         << pe.packets_delivered << " " << pe.halted;
    for (const Cycles cycles : pe.phase_cycles) text << " " << cycles;
    text << "\n";
  }
  return text.str();
}

}  // namespace

DebuggedMachine::DebuggedMachine(Options options)
    : options_(std::move(options)), image_(load_image(image_file(options_.image))) {
  if (!options_.held.empty()) {
    debugger::SessionOptions session;
    session.place.path = socket();
    session.pes = options_.held;
    session.columns = 4;
    session.image_of_pe = [this](unsigned) { return image_.file; };
    session.goes_back = options_.goes_back;
    session.goes_on = [this] { return !ends_.load(); };
    session_.emplace(std::move(session));
  }
  thread_ = std::thread([this] { run(); });
}

DebuggedMachine::~DebuggedMachine() {
  ends_ = true;
  if (thread_.joinable()) thread_.join();
}

std::uint32_t DebuggedMachine::address_of(const std::string& part_of_name) const {
  for (const ImageSymbol& symbol : image_.symbols) {
    if (symbol.function && symbol.name.find(part_of_name) != std::string::npos) return symbol.address;
  }
  ADD_FAILURE() << "no function " << part_of_name;
  return 0;
}

RunResult DebuggedMachine::wait() {
  if (thread_.joinable()) thread_.join();
  return result_;
}

MachineFigures DebuggedMachine::run_once(SnapshotReader* from) {
  MachineSetup setup;
  setup.columns = 4;
  setup.rows = 2;
  setup.engine = options_.engine;
  setup.threads = options_.threads;
  if (session_) setup.debugging.debugger = &*session_;
  Machine machine(setup, image_);
  Listener listener([this](const std::string& text) {
    if (!session_ || session_->is_new()) result_.texts.push_back(text);
  });
  machine.run(
      listener, [this](Cycles) { return !ends_.load(); }, Machine::Then::end, from);
  return machine.figures();
}

void DebuggedMachine::run() {
  try {
    for (;;) {
      try {
        result_.figures = exact(run_once(session_ ? session_->from() : nullptr));
        break;
      } catch (const debugger::GoesBack&) {
        continue;
      }
    }
    if (session_) session_->finish(0, "");
  } catch (const std::exception& error) {
    result_.failure = error.what();
    if (session_ && dynamic_cast<const MachineFailure*>(&error) != nullptr) session_->finish(3, error.what());
  }
  session_.reset();
}

RunResult plain_run(const DebuggedMachine::Options& options) {
  DebuggedMachine::Options plain = options;
  plain.held.clear();
  return DebuggedMachine(plain).wait();
}

}  // namespace torolux::test
