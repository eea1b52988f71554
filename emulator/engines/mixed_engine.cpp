// SPDX-License-Identifier: MIT
// Two engines, each with its own PEs; what is asked of a PE goes to its own engine.
#include "emulator/engines/mixed_engine.hpp"

#include <algorithm>
#include <string>

#include "emulator/engines/qemu/qemu_engine.hpp"
#include "emulator/errors.hpp"

namespace torolux {
namespace {

class MixedEngine final : public Engine {
 public:
  MixedEngine(std::unique_ptr<Engine> most, std::unique_ptr<Engine> qemu, std::vector<bool> on_qemu)
      : most_(std::move(most)), qemu_(std::move(qemu)), on_qemu_(std::move(on_qemu)) {}

  std::string_view name() const override { return most_->name(); }
  void start() override {
    qemu_->start();
    most_->start();
  }
  void check() override {
    qemu_->check();
    most_->check();
  }
  void stop() override {
    qemu_->stop();
    most_->stop();
  }
  bool can_be_saved() const override { return qemu_->can_be_saved() && most_->can_be_saved(); }
  void will_be_saved() override {
    qemu_->will_be_saved();
    most_->will_be_saved();
  }
  void hold() override { most_->hold(); }
  void let_go() override { most_->let_go(); }
  PeRegisters save(unsigned pe) override { return of(pe).save(pe); }
  void restore(unsigned pe, const PeRegisters& registers) override { of(pe).restore(pe, registers); }
  std::optional<StackRegisters> stack_registers(unsigned pe) override { return of(pe).stack_registers(pe); }
  double cpu_seconds() const override { return qemu_->cpu_seconds() + most_->cpu_seconds(); }
  ProcessorWaker* waker(unsigned pe) override { return of(pe).waker(pe); }
  /// While QEMU runs the PE in question, others may run here.
  bool help(unsigned pe, std::uint64_t wanted) override { return most_->help(pe, wanted); }
  bool takes_turns(unsigned pe) const override { return most_->takes_turns(pe); }
  void fetch_ahead(unsigned pe) const override { most_->fetch_ahead(pe); }
  double help_seconds() const override { return most_->help_seconds(); }

 private:
  Engine& of(unsigned pe) const { return on_qemu_[pe] ? *qemu_ : *most_; }

  std::unique_ptr<Engine> most_, qemu_;
  std::vector<bool> on_qemu_;
};

void check_pe(unsigned pe, std::size_t pes) {
  if (pe >= pes) {
    throw InputError("there is no PE " + std::to_string(pe) + " to run on QEMU; the machine has 0 to " +
                     std::to_string(pes - 1));
  }
}

/// A profile is told of each instruction.
void check_profiled(std::string_view name, const std::vector<bool>& on_qemu) {
  const bool all_here = std::find(on_qemu.begin(), on_qemu.end(), true) == on_qemu.end();
  if (name == kInterpretedEngine && all_here) return;
  throw UsageError("a profile needs the engine `" + std::string(kInterpretedEngine) + "` for all PEs, but " +
                   (all_here ? "the engine is `" + std::string(name) + "`" : "some are to run on QEMU"));
}

void check_debugger(std::string_view engine, const EngineSetup& setup, const Debugging& debugging) {
  if (setup.debugger == nullptr) return;
  if (!engine_runs_here(engine)) {
    throw UsageError("the engine " + std::string(engine) +
                     " lends no PEs to the emulator's own debugger (--gdb PORT): take the engine translated or "
                     "interpreted, or QEMU's debugger for one PE (--gdb PE:PORT)");
  }
  if (setup.profile != nullptr)
    throw UsageError("a profile is not made of PEs that a debugger holds: leave out either");
  const std::vector<bool> on_qemu = debugging.on_qemu(setup.pes.size());
  for (unsigned pe = 0; pe < on_qemu.size(); ++pe) {
    if (on_qemu[pe] && setup.holds(pe)) {
      throw UsageError("PE " + std::to_string(pe) +
                       " cannot both run on QEMU and be held by the emulator's own debugger: name others in --gdb-pes");
    }
  }
}

}  // namespace

std::vector<bool> Debugging::on_qemu(std::size_t pes) const {
  std::vector<bool> result(pes);
  for (const unsigned pe : qemu_pes) {
    check_pe(pe, pes);
    result[pe] = true;
  }
  for (auto port = gdb.begin(); port != gdb.end(); ++port) {
    check_pe(port->pe, pes);
    result[port->pe] = true;
    const auto same = [port](const GdbEndpoint& other) { return other.pe == port->pe; };
    if (std::any_of(gdb.begin(), port, same)) {
      throw UsageError("PE " + std::to_string(port->pe) + " is to have two debuggers: one is allowed");
    }
  }
  return result;
}

std::unique_ptr<Engine> make_engine(std::string_view name, const EngineSetup& setup, const Debugging& debugging) {
  const EngineFactory& factory = engine_named(name);
  check_debugger(name, setup, debugging);
  std::vector<bool> on_qemu = debugging.on_qemu(setup.pes.size());
  const QemuOptions options{.gdb = debugging.gdb, .listens = debugging.listens};
  if (setup.profile != nullptr) check_profiled(name, on_qemu);
  const bool none = std::find(on_qemu.begin(), on_qemu.end(), true) == on_qemu.end();
  if (none) return factory(setup);
  const bool all = std::find(on_qemu.begin(), on_qemu.end(), false) == on_qemu.end();
  if (all || name == kQemuEngine) {
    return make_qemu_engine(setup, options);
  }
  EngineSetup of_qemu = setup;
  of_qemu.elsewhere = on_qemu;
  of_qemu.elsewhere.flip();
  EngineSetup of_most = setup;
  of_most.elsewhere = on_qemu;
  auto qemu = make_qemu_engine(of_qemu, options);
  return std::make_unique<MixedEngine>(factory(of_most), std::move(qemu), std::move(on_qemu));
}

}  // namespace torolux
