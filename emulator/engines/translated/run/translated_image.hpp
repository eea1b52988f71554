// SPDX-License-Identifier: MIT
// An image as code of this computer, shared by all PEs that run it. Enters: image and latency table; leaves: a PE's
// state, advanced to its next HINT. Everything here is const once made: any number of threads may run their PEs.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "emulator/description/description.hpp"
#include "emulator/engines/image/image.hpp"
#include "emulator/engines/translated/analysis/blocks.hpp"
#include "emulator/engines/translated/decode/code_map.hpp"
#include "emulator/engines/translated/run/interpreter.hpp"
#include "emulator/engines/translated/semantics/pe_state.hpp"

namespace torolux::profile {
class PeProfile;
}

namespace torolux::translated {

struct TranslationOptions {
  std::filesystem::path cache_folder;  ///< empty: the user's; see Cache
  bool interpret = false;              ///< translate nothing: slow, needs no compiler
  bool in_background = false;          ///< what the cache does not have is interpreted until it has been compiled, and
                                       ///< to the end where that cannot be
  std::function<bool()> interrupted = {};  ///< asked while it is compiled, else; null: never
};

class TranslatedImage {
 public:
  /// Takes the code from the cache, or translates and compiles it (seconds). Throws MachineFailure where no compiler
  /// is found, it fails or is interrupted.
  TranslatedImage(const Image& image, const LatencyTable& latency, const TranslationOptions& options = {});
  ~TranslatedImage();
  TranslatedImage(const TranslatedImage&) = delete;
  TranslatedImage& operator=(const TranslatedImage&) = delete;

  /// Whether the cache had it.
  bool from_cache() const { return from_cache_; }
  /// Whether translated code runs from now on; before, and without, instructions are interpreted.
  bool is_translated() const { return is_translated_.load(std::memory_order_acquire); }

  /// Puts a PE to the beginning of `_start`, without calls at HINTs and cycle limit. local_memory: the image is loaded
  /// and the NIU window filled in; it outlives the PE. mapped_bytes: as mapped_bytes_for, what QEMU would be given.
  void start(TranslatedPe& pe, std::span<std::byte> local_memory, std::size_t mapped_bytes) const;

  /// After the start: the registers have been set from outside, to where a PE stood behind a HINT.
  void resume(TranslatedPe& pe) const;

  enum class Stop : std::uint8_t {
    hint,         ///< executed and counted, pc behind it; hint_immediate says which. pe.hint has been asked, if the
                  ///< code is translated. Set pe.cycles if it waits
    cycle_limit,  ///< pe.cycles >= pe.cycle_limit
    stuck,        ///< it will never execute anything again: a trap while mtvec points to nothing (mcause, mepc and
                  ///< mtval tell of the last trap)
    waits,        ///< nor after this: wfi, counted, at pc
  };
  /// Goes on from where the PE stands. Call it again after each HINT.
  Stop run(TranslatedPe& pe) const;
  /// The same, one instruction after the other, each told to the profile, which has begun.
  Stop run_profiled(TranslatedPe& pe, profile::PeProfile& profile) const;
  /// Executes one instruction, whatever the cycle limit. Nothing: it may go on.
  std::optional<Stop> step(TranslatedPe& pe) const;
  const CodeMap& code() const { return code_; }

 private:
  struct Library;
  static constexpr std::uint16_t kNone = 0xFFFF;
  struct Way {
    std::uint16_t function = kNone;  ///< kNone: not an entry
    bool begins_function = false;
    Cost rest{0, 0};  ///< of its block from this instruction on
  };

  struct Source;  ///< all that the compiler needs

  void load(const Image& image, const TranslationOptions& options);
  std::optional<Source> source_of(const Image& image, const TranslationOptions& options);
  void compile(const Source& source, const std::function<bool()>& stop);
  void compile_in_background(Source source);
  void take(std::unique_ptr<Library> library);
  bool may_run_translated(const TranslatedPe& pe) const;
  void refresh(TranslatedPe& pe) const;
  Interpreter::Step interpret(TranslatedPe& pe) const;
  void give_back_rest(TranslatedPe& pe) const;
  const Way* way_at(std::uint32_t address) const;
  void find_ways(const Block& block, std::size_t function, bool begins_function);
  Exit run_translated(TranslatedPe& pe, const Way& way) const;
  static std::optional<Stop> stop_of(Interpreter::Step step, TranslatedPe& pe);

  CodeMap code_;
  Interpreter interpreter_;
  std::vector<Way> ways_;
  std::optional<std::set<std::uint32_t>> trap_handlers_;  // of Liveness
  EnterFunction enter_ = nullptr;
  const HostFunction* called_ = nullptr;   // by number of the function
  const HostFunction* resumed_ = nullptr;  // likewise
  std::unique_ptr<Library> library_;
  bool from_cache_ = false;
  bool has_float_ = false;
  bool interpret_ = false;
  std::atomic<bool> is_translated_ = false;  // what stands above, from the library on, is there
  std::jthread background_;                  // ends first
};

}  // namespace torolux::translated
