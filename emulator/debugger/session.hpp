// SPDX-License-Identifier: MIT
// One debugger that holds PEs of a machine: GDB's remote protocol on one side, PEs of an engine on the other. It
// outlives machines: to go back, one ends and an equal one begins.
#pragma once

#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "emulator/debugger/connection.hpp"
#include "emulator/debugger/execution.hpp"
#include "emulator/debugger/history.hpp"
#include "emulator/debugger/replay.hpp"
#include "emulator/engines/engine/pe_debugger.hpp"
#include "emulator/snapshot/archive.hpp"

namespace torolux::debugger {

/// Thrown out of the machine's run where the debugger goes back: to be run again, from Session::from().
class GoesBack : public std::exception {};

struct SessionOptions {
  GdbEndpoint place{};                                            ///< where it listens; pe: not looked at
  std::vector<unsigned> pes;                                      ///< that it holds, ascending; at least one
  unsigned columns = 1;                                           ///< of the torus, to tell places
  std::function<std::filesystem::path(unsigned pe)> image_of_pe;  ///< the file that a PE runs
  bool goes_back = false;              ///< whoever runs the machine does so again when GoesBack is thrown
  std::function<bool()> goes_on = {};  ///< asked while PEs are held; false: the run is to end
  /// Likewise; what it says ends the run as a failure. "": nothing does.
  std::function<std::string()> gives_up = {};
};

class Session final : public PeDebugger {
 public:
  /// Listens. Throws InputError where that cannot be.
  explicit Session(SessionOptions options);

  const GdbEndpoint& place() const { return connection_.place(); }  ///< with the port that it has got

  // ---- For whoever runs the machine ----

  /// Of the state from which the next machine goes on; null: from the beginning. Until the next call.
  SnapshotReader* from();
  /// A PE has said something: whether nobody has heard it yet.
  bool is_new();
  /// The run has ended: with this exit code; text: why, if something failed.
  void finish(int exit_code, const std::string& text);

  // ---- PeDebugger ----
  bool holds(unsigned pe) const override { return execution_.holds(pe); }
  void begin(std::vector<std::unique_ptr<DebuggedPe>> by_number) override;
  void turn(unsigned pe, std::uint64_t until) override;
  void look() override;
  void end() override { execution_.end(); }
  void may_save(Save save) override { save_ = std::move(save); }

 private:
  std::string gives_up() const { return options_.gives_up ? options_.gives_up() : ""; }
  using Reply = std::optional<std::string>;  // nothing: it comes later

  // Life (session.cpp)
  void hold_all();
  void serve(std::chrono::milliseconds longest);
  void tell(const Stop& stop);
  void keep_state_if_due();
  void replay(unsigned pe, std::uint64_t until);
  [[noreturn]] void search_before(const Position& end);
  [[noreturn]] void go_back(std::shared_ptr<const SavedState> state, Goal goal);
  void let_go();
  void tell_end(HeldPe& held);
  Position now() const { return position_of(execution_.pes()); }

  // Packets (session_packets.cpp)
  Reply answer(const std::string& packet);
  Reply answer_query(std::string_view packet);
  Reply answer_multi_letter(std::string_view packet);
  std::string features(std::string_view theirs);
  static std::string part_of(const std::string& whole, std::string_view range);
  std::string transfer(std::string_view what);
  std::string choose_thread(std::string_view text);
  Reply resume(const std::optional<std::vector<ResumeAction>>& actions);
  Reply step_back();
  Reply search_back();
  std::string detach(std::string_view process);
  std::string thread_list(bool xml) const;

  // Registers, memory, points (session_state.cpp)
  HeldPe* chosen();
  std::string read_registers();
  std::string read_one(std::string_view number);
  std::string write_registers(std::string_view text);
  std::string write_one(std::string_view text);
  std::string set_registers(HeldPe& held, const PeRegisters& registers);
  std::string read_memory(std::string_view range);
  std::string write_memory(std::string_view text, bool in_hexadecimal);
  std::string set_point(std::string_view text, bool is_set);
  void add_edit(HeldPe& held, Edit edit);

  // `monitor` (session_monitor.cpp)
  std::string monitor(std::string_view command);
  std::string tell_clock();
  std::string tell_pes() const;

  SessionOptions options_;
  Connection connection_;
  Execution execution_;
  History history_;
  Save save_;
  bool held_ = true;  // nothing goes on
  bool in_turn_ = false;
  bool knows_swbreak_ = false;
  bool knows_processes_ = false;
  unsigned chosen_;                                 // PE that register and memory packets mean
  ThreadChoice to_go_on_{ThreadChoice::Kind::any};  // of packets that name none
  Stop last_;
  std::optional<Replay> replay_;
  std::shared_ptr<const SavedState> from_;
  std::optional<SnapshotReader> reader_;
  std::size_t read_ = 0;                // bytes of the state
  std::uint64_t said_ = 0, heard_ = 0;  // texts: of this machine; of all, the most
  std::optional<int> exit_code_;        // the run has ended
};

}  // namespace torolux::debugger
