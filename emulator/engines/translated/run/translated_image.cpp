// SPDX-License-Identifier: MIT
// From an image to code in memory, and the loop that runs it.
#include "emulator/engines/translated/run/translated_image.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <iostream>

#include "emulator/engines/isa/instruction_class.hpp"
#include "emulator/engines/translated/analysis/blocks.hpp"
#include "emulator/engines/translated/analysis/liveness.hpp"
#include "emulator/engines/translated/compile/cache.hpp"
#include "emulator/engines/translated/compile/host_compiler.hpp"
#include "emulator/engines/translated/generate/generator.hpp"
#include "emulator/errors.hpp"
#include "firmware/protocol/hints.hpp"

namespace torolux::translated {

/// A loaded shared object. An open file that it came from stays open: the loader takes another one that gets the same
/// descriptor, and so the same name, for this one.
struct TranslatedImage::Library {
  explicit Library(const std::string& file, std::optional<OpenFile> open_file = std::nullopt)
      : kept(std::move(open_file)), handle(dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL)) {
    if (handle == nullptr) throw MachineFailure(std::string("translated code cannot be loaded: ") + dlerror());
  }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
  ~Library() { dlclose(handle); }

  template <class Symbol>
  Symbol symbol(const char* name) const {
    void* found = dlsym(handle, name);
    if (found == nullptr) throw MachineFailure(std::string("translated code lacks ") + name);
    return reinterpret_cast<Symbol>(found);
  }

  std::optional<OpenFile> kept;
  void* handle;
};

namespace {

std::string key_of(const HostCompiler& compiler, std::span<const SourceText> headers,
                   std::span<const SourceText> units) {
  std::string all = compiler.identity();
  for (const auto& texts : {headers, units}) {
    for (const SourceText& text : texts) {
      all += text.name + '\0' + std::to_string(text.text.size()) + '\0' + text.text;
    }
  }
  return digest(all);
}

std::string path_of(const OpenFile& file) {
  return "/proc/self/fd/" + std::to_string(file.descriptor());
}

void tell_interpreted(const std::string& why) {
  std::cerr << "torolux: note: the firmware is interpreted, which is slow: " + why + "\n" << std::flush;
}

/// False: the HINT at which the PE stands is no phase marker, or nobody wants to be called at those.
bool call_marker(TranslatedPe& pe) {
  if (pe.marker == nullptr || !protocol::is_phase_marker(pe.hint_immediate)) {
    return false;
  }
  pe.marker(pe.context, pe.hint_immediate, pe.cycles, pe.instructions);
  return true;
}

}  // namespace

TranslatedImage::TranslatedImage(const Image& image, const LatencyTable& latency, const TranslationOptions& options)
    : code_(image, latency), interpreter_(code_), interpret_(options.interpret) {
  if (!interpret_) load(image, options);
}

TranslatedImage::~TranslatedImage() = default;

struct TranslatedImage::Source {
  HostCompiler compiler;
  Cache cache;
  std::vector<SourceText> headers, units;
  std::string key;
};

/// Nothing: there is no compiler, and it can be done without.
std::optional<TranslatedImage::Source> TranslatedImage::source_of(const Image& image,
                                                                  const TranslationOptions& options) {
  Blocks blocks(image, code_);
  const std::vector<GuestFunction> functions = make_functions(code_, blocks);
  ways_.resize((code_.end() - code_.begin()) / 2);
  for (std::size_t number = 0; number < functions.size(); ++number) {
    for (const std::uint32_t address : functions[number].blocks) {
      const Block& block = blocks.all().at(address);
      find_ways(block, number, address == functions[number].begin);
    }
  }
  const Liveness liveness(code_, blocks);
  trap_handlers_ = liveness.trap_handlers();
  try {
    Source source{HostCompiler(), Cache(options.cache_folder), semantics_texts(),
                  generate(code_, blocks, liveness, functions), ""};
    source.key = key_of(source.compiler, source.headers, source.units);
    return source;
  } catch (const MachineFailure& failure) {
    if (!options.in_background) throw;
    tell_interpreted(failure.what());
    return std::nullopt;
  }
}

void TranslatedImage::load(const Image& image, const TranslationOptions& options) {
  std::optional<Source> source = source_of(image, options);
  if (!source) return;
  if (auto found = source->cache.find(source->key)) {
    from_cache_ = true;
    const std::string path = path_of(*found);
    take(std::make_unique<Library>(path, std::move(found)));
  } else if (options.in_background) {
    compile_in_background(std::move(*source));
  } else {
    compile(*source, options.interrupted);
  }
}

void TranslatedImage::compile(const Source& source, const std::function<bool()>& stop) {
  const TemporaryFolder folder;
  const std::filesystem::path built = source.compiler.build(source.headers, source.units, folder.path(), stop);
  source.cache.store(source.key, built);
  take(std::make_unique<Library>(built.string()));
}

void TranslatedImage::compile_in_background(Source source) {
  background_ = std::jthread([this, source = std::move(source)](const std::stop_token& stop) {
    try {
      compile(source, [&stop] { return stop.stop_requested(); });
    } catch (const MachineFailure& failure) {
      if (!stop.stop_requested()) tell_interpreted(failure.what());
    }
  });
}

void TranslatedImage::take(std::unique_ptr<Library> library) {
  library_ = std::move(library);
  enter_ = library_->symbol<EnterFunction>(kEnter);
  called_ = library_->symbol<const HostFunction*>(kCalledTable);
  resumed_ = library_->symbol<const HostFunction*>(kResumedTable);
  is_translated_.store(true, std::memory_order_release);
}

void TranslatedImage::find_ways(const Block& block, std::size_t function, bool begins_function) {
  const auto way = [&](std::uint32_t pc) -> Way& { return ways_[(pc - code_.begin()) / 2]; };
  if (block.entry) {
    way(block.begin).function = static_cast<std::uint16_t>(function);
    way(block.begin).begins_function = begins_function;
  }
  Cost rest = block.cost;
  for (const std::uint32_t pc : addresses_in(code_, block)) {
    const PlacedInstruction& placed = *code_.at(pc);
    way(pc).rest = rest;
    rest.cycles -= placed.cost.cycles;
    rest.instructions -= placed.cost.instructions;
    has_float_ |= is_float(placed.instruction.op);
  }
}

const TranslatedImage::Way* TranslatedImage::way_at(std::uint32_t address) const {
  const std::uint32_t index = (address - code_.begin()) / 2;
  return address % 2 == 0 && index < ways_.size() ? &ways_[index] : nullptr;
}

void TranslatedImage::start(TranslatedPe& pe, std::span<std::byte> local_memory, std::size_t mapped_bytes) const {
  reset(pe);
  pe.memory = local_memory.data();
  pe.memory_bytes = static_cast<std::uint32_t>(local_memory.size());
  pe.cycle_limit = ~std::uint64_t{0};
  pe.marker = nullptr;
  pe.hint = nullptr;
  pe.context = nullptr;
  pe.interpreted = interpret_;
  set_boot_registers(pe, mapped_bytes);
  refresh(pe);
}

void TranslatedImage::resume(TranslatedPe& pe) const {
  constexpr std::uint32_t kMode = 3;  // bits of mtvec
  pe.interpreted = interpret_ || (trap_handlers_ && pe.mtvec != 0 && !trap_handlers_->contains(pe.mtvec & ~kMode));
  refresh(pe);
}

/// What follows from the memory's rights.
void TranslatedImage::refresh(TranslatedPe& pe) const {
  constexpr std::uint32_t kWidest = 4;
  const std::uint32_t end = kMemoryBase + pe.memory_bytes;
  const auto accessible = [&](std::uint32_t begin, Access access) {
    return begin < end ? freely_accessible(pe, begin, end, access) : 0;
  };
  const auto limit = [](std::uint32_t bytes) { return bytes >= kWidest ? bytes - (kWidest - 1) : 0; };
  const std::uint32_t loads = accessible(kMemoryBase, Access::load);
  const std::uint32_t before_stores = code_.store_base() - kMemoryBase;
  pe.load_limit = limit(loads);
  // Where stores may go, loads may: translated code checks for stores alone.
  pe.store_limit =
      limit(std::min(accessible(code_.store_base(), Access::store), loads - std::min(loads, before_stores)));
  pe.may_fetch = freely_accessible(pe, code_.begin(), code_.end(), Access::fetch) == code_.end() - code_.begin();
}

bool TranslatedImage::may_run_translated(const TranslatedPe& pe) const {
  return is_translated() && !pe.interpreted && pe.may_fetch && pe.frm == 0 && (!has_float_ || !float_is_off(pe));
}

Interpreter::Step TranslatedImage::interpret(TranslatedPe& pe) const {
  const PlacedInstruction* placed = code_.at(pe.pc);
  constexpr std::uint32_t kFcsr = 3;  // fflags, frm and this give no rights
  const bool may_change_rights =
      placed != nullptr &&
      ((is_csr(placed->instruction.op) && placed->instruction.immediate > kFcsr) || placed->instruction.op == Op::mret);
  const bool may_move_handler = placed != nullptr && may_write_mtvec(placed->instruction);
  const Interpreter::Step step = interpreter_.step(pe);
  if (may_change_rights) refresh(pe);
  constexpr std::uint32_t kMode = 3;  // bits of mtvec
  if (may_move_handler && trap_handlers_) pe.interpreted |= !trap_handlers_->contains(pe.mtvec & ~kMode);
  return step;
}

/// The block has been counted whole, but it was left at pe.pc.
void TranslatedImage::give_back_rest(TranslatedPe& pe) const {
  const Cost rest = way_at(pe.pc)->rest;
  pe.cycles -= rest.cycles;
  pe.instructions -= rest.instructions;
}

Exit TranslatedImage::run_translated(TranslatedPe& pe, const Way& way) const {
  pe.slice = pack({static_cast<std::uint32_t>(std::min<std::uint64_t>(pe.cycle_limit - pe.cycles, kMostSlice)), 0});
  const HostFunction function = (way.begins_function ? called_ : resumed_)[way.function];
  const Left left = enter_(&pe, function);
  pe.cycles += cycles_in(left.count);
  pe.instructions += instructions_in(left.count);
  pe.pc = static_cast<std::uint32_t>(left.at);
  return static_cast<Exit>(left.at >> 32U);
}

/// Nothing where the PE goes on.
std::optional<TranslatedImage::Stop> TranslatedImage::stop_of(Interpreter::Step step, TranslatedPe& pe) {
  switch (step) {
    case Interpreter::Step::stuck:
      return Stop::stuck;
    case Interpreter::Step::waits:
      return Stop::waits;
    case Interpreter::Step::hint:
      return call_marker(pe) ? std::nullopt : std::optional(Stop::hint);
    case Interpreter::Step::done:
      break;
  }
  return std::nullopt;
}

std::optional<TranslatedImage::Stop> TranslatedImage::step(TranslatedPe& pe) const {
  return stop_of(interpret(pe), pe);
}

TranslatedImage::Stop TranslatedImage::run(TranslatedPe& pe) const {
  while (pe.cycles < pe.cycle_limit) {
    const Way* way = may_run_translated(pe) ? way_at(pe.pc) : nullptr;
    if (way != nullptr && way->function != kNone) {
      const Exit why = run_translated(pe, *way);
      if (why == Exit::hint) return Stop::hint;
      if (why != Exit::look) continue;
      give_back_rest(pe);
    }
    const Interpreter::Step step = interpret(pe);
    if (step == Interpreter::Step::done) continue;
    if (const auto stop = stop_of(step, pe)) return *stop;
  }
  return Stop::cycle_limit;
}

}  // namespace torolux::translated
