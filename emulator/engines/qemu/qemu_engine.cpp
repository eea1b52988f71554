// SPDX-License-Identifier: MIT
// Starts, watches and ends all its PEs.
#include "emulator/engines/qemu/qemu_engine.hpp"

#include <sched.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

#include "emulator/engines/engine/gdb_socket.hpp"
#include "emulator/engines/qemu/qemu_pe.hpp"
#include "emulator/errors.hpp"
#include "emulator/installed_file.hpp"

namespace torolux {
namespace {

using Clock = std::chrono::steady_clock;

/// For a PE to tell its registers; a thousand processes may share one core.
constexpr std::chrono::seconds kLongestLook{5};

std::filesystem::path plugin_file() {
  auto file = installed_file("lib/torolux/torolux_qemu_plugin.so", "../lib/torolux_qemu_plugin.so");
  std::error_code error;
  if (!std::filesystem::exists(file, error)) {
    throw MachineFailure("the QEMU plugin is missing at " + file.string() + ": build all targets");
  }
  return file;
}

/// In QEMU's options a comma separates, and two are one that does not.
std::string escape_commas(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    escaped.append(c == ',' ? 2 : 1, c);
  }
  return escaped;
}

/// The first `threads` cores of those that we may use; empty where that is all of them.
std::vector<int> cores_for(unsigned threads) {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  std::vector<int> cores;
  if (sched_getaffinity(0, sizeof(allowed), &allowed) != 0) {
    return cores;
  }
  for (int core = 0; core < CPU_SETSIZE; ++core) {
    if (CPU_ISSET(static_cast<std::size_t>(core), &allowed)) {
      cores.push_back(core);
    }
  }
  if (threads == 0 || threads >= cores.size()) {
    cores.clear();
  }
  cores.resize(std::min<std::size_t>(cores.size(), threads));
  return cores;
}

class QemuEngine final : public Engine {
 public:
  QemuEngine(const EngineSetup& setup, const QemuOptions& options)
      : launch_{setup, options.logs, options.meetings, {}, {}, false, {}},
        listens_(options.listens),
        most_cycles_between_hints_(setup.machine.processor.most_cycles_between_hints) {
    for (const GdbEndpoint& endpoint : options.gdb) debugged_.emplace_back(endpoint);
  }

  std::string_view name() const override { return kQemuEngine; }

  void start() override {
    launch_.plugin = escape_commas(plugin_file().string());
    launch_.cores = cores_for(launch_.setup.threads);
    pes_.reserve(launch_.setup.pes.size());
    for (std::size_t pe = 0; pe < launch_.setup.pes.size(); ++pe) {
      if (launch_.setup.runs(pe)) pes_.emplace_back(pe, launch_, debugger_of(pe));
    }
    last_check_ = Clock::now();
    for (GdbSocket& debugger : debugged_) {
      if (listens_) listens_(debugger.endpoint());
      debugger.leave_to_qemu();
    }
  }

  void check() override {
    // Time in which nobody looked (we were stopped, too) does not count as a PE's silence.
    const Clock::time_point now = Clock::now();
    const Clock::duration tick = std::min<Clock::duration>(now - last_check_, std::chrono::seconds(1));
    last_check_ = now;
    for (QemuPe& pe : pes_) {
      pe.check(most_cycles_between_hints_, tick);
    }
  }

  void stop() override {
    for (QemuPe& pe : pes_) {
      pe.kill();
    }
  }

  /// Whoever debugs a PE has its debugger stub.
  bool can_be_saved() const override { return debugged_.empty() && !launch_.logs && launch_.meetings == nullptr; }
  void will_be_saved() override { launch_.to_be_saved = true; }
  PeRegisters save(unsigned pe) override { return of(pe).save(); }
  std::optional<StackRegisters> stack_registers(unsigned pe) override {
    if (pes_.empty()) return std::nullopt;
    const Clock::time_point begin = Clock::now();
    const auto registers = of(pe).stack_registers(looks_ ? Clock::duration(kLongestLook) : Clock::duration::zero());
    looks_ = looks_ && Clock::now() - begin < kLongestLook;
    return registers;
  }
  void restore(unsigned pe, const PeRegisters& registers) override {
    launch_.restored.resize(launch_.setup.pes.size());
    launch_.restored[pe] = registers;
  }

  double cpu_seconds() const override {
    double sum = 0;
    for (const QemuPe& pe : pes_) {
      sum += pe.cpu_seconds();
    }
    return sum;
  }

 private:
  QemuPe& of(std::size_t number) {
    return *std::ranges::find(pes_, number, [](const QemuPe& pe) { return pe.number(); });
  }
  const GdbSocket* debugger_of(std::size_t pe) const {
    const auto found = std::ranges::find(debugged_, pe, [](const GdbSocket& socket) { return socket.endpoint().pe; });
    return found == debugged_.end() ? nullptr : &*found;
  }

  QemuLaunch launch_;
  std::vector<GdbSocket> debugged_;
  std::function<void(const GdbEndpoint&)> listens_;
  std::uint64_t most_cycles_between_hints_;
  std::vector<QemuPe> pes_;
  bool looks_ = true;  // PEs have told their registers in time, so far
  Clock::time_point last_check_;
};

}  // namespace

std::unique_ptr<Engine> make_qemu_engine(const EngineSetup& setup, const QemuOptions& options) {
  return std::make_unique<QemuEngine>(setup, options);
}

std::unique_ptr<Engine> make_qemu_engine(const EngineSetup& setup, const QemuHintLogs& logs) {
  return make_qemu_engine(setup, QemuOptions{.logs = logs});
}

}  // namespace torolux
