// SPDX-License-Identifier: MIT
// The host program behind `torolux run`: it listens and says nothing.
#include "host_tools/run/run.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "emulator/errors.hpp"
#include "firmware/protocol/niu_window.hpp"
#include "host_tools/report/machine_json.hpp"
#include "host_tools/report/settings_json.hpp"
#include "host_tools/report/text.hpp"
#include "host_tools/report/version.hpp"

namespace torolux {
namespace {

class Listener final : public HostProgram {
 public:
  explicit Listener(const std::function<void(const PeText&)>& on_text) : on_text_(on_text) {}

  void start(HostPort& /*port*/) override {}

  void on_message(HostPort& port, PeNumber source, std::uint16_t kind, std::span<const std::byte> contents) override {
    if (kind != static_cast<std::uint16_t>(protocol::MachineMessage::text)) {
      throw MachineFailure("PE " + std::to_string(source) + " sent the host a message of kind " + std::to_string(kind) +
                           "; `torolux run` understands text (kind 1) alone");
    }
    std::string text(contents.size(), ' ');
    std::transform(contents.begin(), contents.end(), text.begin(), [](std::byte b) {
      const auto c = static_cast<unsigned char>(b);
      return c < 0x20 || c == 0x7F ? '?' : static_cast<char>(c);
    });
    on_text_({port.now(), source, std::move(text)});
  }

  /// It never has anything more to do: what counts is that the PEs have halted.
  bool finished() const override { return true; }
  const char* waiting_for() const override { return "text from the PEs"; }

 private:
  const std::function<void(const PeText&)>& on_text_;
};

/// The machine stops when nothing can happen any more. That is the end only if every program has ended.
void check_halted(const MachineFigures& figures) {
  constexpr std::size_t kMostNamed = 16;
  std::string waiting;
  std::size_t count = 0;
  for (std::size_t pe = 0; pe < figures.pes.size(); ++pe) {
    if (figures.pes[pe].halted) {
      continue;
    }
    if (count++ < kMostNamed) {
      waiting += (waiting.empty() ? "" : ", ") + std::to_string(pe);
    }
  }
  if (count != 0) {
    throw MachineFailure("at cycle " + std::to_string(figures.now) + " nothing is under way any more, and " +
                         std::to_string(count) + " PEs still wait to receive: PE " + waiting +
                         (count > kMostNamed ? ", ..." : ""));
  }
}

}  // namespace

MachineFigures run_image(const MachineSetup& setup, const Image& image,
                         const std::function<void(const PeText&)>& on_text,
                         const std::function<bool(const Machine&, Cycles)>& progress) {
  Machine machine(setup, image);
  Listener listener(on_text);
  machine.run(listener, [&](Cycles now) { return !progress || progress(machine, now); });
  MachineFigures figures = machine.figures();
  check_halted(figures);
  return figures;
}

std::string run_stats_json(const MachineSetup& setup, const InputFile& image, const MachineFigures& figures,
                           double wall_seconds) {
  using Json = nlohmann::ordered_json;
  Json json;
  json["version"] = kVersion;
  json["engine"] = setup.engine;
  json["virtual_cycles"] = {{"total", figures.now}};
  json.update(machine_json(figures));
  json["trace_hash"] = hexadecimal(figures.trace_hash);
  json["settings"] = settings_json(setup, image);
  json["command_line"] = command_line_of(json["settings"]);
  json["stages"] = stages_json(figures, {});
  json["time_line"] = time_line_json(figures.time_line);
  json["links"] = links_json(figures);
  json["pes"] = pes_json(figures.pes);
  json["wall_seconds"] = wall_seconds;
  json["host"] = {{"threads", setup.threads},
                  {"scheduler_seconds", figures.scheduler_seconds},
                  {"engine_seconds", figures.engine_seconds}};
  return json.dump(2) + "\n";
}

}  // namespace torolux
