// SPDX-License-Identifier: MIT
// From an image to code in memory, and the loop that runs it.
#include "emulator/engines/translated/translated_image.hpp"

#include <dlfcn.h>

#include <algorithm>

#include "emulator/engines/isa/instruction_class.hpp"
#include "emulator/engines/translated/blocks.hpp"
#include "emulator/engines/translated/cache.hpp"
#include "emulator/engines/translated/generator.hpp"
#include "emulator/engines/translated/host_compiler.hpp"
#include "emulator/engines/translated/regions.hpp"
#include "emulator/errors.hpp"
#include "firmware/protocol/hints.hpp"

namespace torolux::translated {

/// A loaded shared object.
struct TranslatedImage::Library {
  explicit Library(const std::string& file) : handle(dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL)) {
    if (handle == nullptr) throw MachineFailure(std::string("translated code cannot be loaded: ") + dlerror());
  }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
  ~Library() { dlclose(handle); }

  RegionFunction region(std::size_t number) const {
    void* found = dlsym(handle, region_name(number).c_str());
    if (found == nullptr) throw MachineFailure("translated code lacks " + region_name(number));
    return reinterpret_cast<RegionFunction>(found);
  }

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

/// False: the HINT at which the PE stands is no phase marker, or nobody wants to be called at those.
bool call_marker(TranslatedPe& pe) {
  if (pe.marker == nullptr ||
      !is_phase_marker(static_cast<std::uint32_t>(protocol::hint_instruction(pe.hint_immediate)))) {
    return false;
  }
  pe.marker(pe.marker_context, pe.hint_immediate, pe.cycles, pe.instructions);
  return true;
}

}  // namespace

TranslatedImage::TranslatedImage(const Image& image, const LatencyTable& latency, const TranslationOptions& options)
    : code_(image, latency), interpreter_(code_), interpret_(options.interpret) {
  if (!interpret_) load(image, options);
}

TranslatedImage::~TranslatedImage() = default;

void TranslatedImage::load(const Image& image, const TranslationOptions& options) {
  Blocks blocks(image, code_);
  const std::vector<Region> regions = make_regions(blocks);
  ways_.resize((code_.end() - code_.begin()) / 2, Way{kNone, {0, 0}});
  std::vector<SourceText> units;
  for (std::size_t number = 0; number < regions.size(); ++number) {
    units.push_back({region_name(number) + ".cpp", generate_region(code_, blocks, regions[number], number)});
    for (const std::uint32_t address : regions[number]) {
      const Block& block = blocks.all().at(address);
      if (block.entry) ways_[(address - code_.begin()) / 2].region = static_cast<std::uint16_t>(number);
      Cost rest = block.cost;
      for (std::uint32_t pc = block.begin; pc < block.end;) {
        const PlacedInstruction& placed = *code_.at(pc);
        ways_[(pc - code_.begin()) / 2].rest = rest;
        rest.cycles -= placed.cost.cycles;
        rest.instructions -= placed.cost.instructions;
        has_float_ |= is_float(placed.instruction.op);
        pc += placed.instruction.bytes;
      }
    }
  }
  const std::vector<SourceText> headers = semantics_texts();
  const HostCompiler compiler;
  const Cache cache(options.cache_folder);
  const std::string key = key_of(compiler, headers, units);
  if (const auto found = cache.find(key)) {
    from_cache_ = true;
    library_ = std::make_unique<Library>(path_of(*found));
  } else {
    const TemporaryFolder folder;
    const std::filesystem::path built = compiler.build(headers, units, folder.path());
    cache.store(key, built);
    library_ = std::make_unique<Library>(built.string());
  }
  for (std::size_t number = 0; number < regions.size(); ++number) regions_.push_back(library_->region(number));
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
  pe.marker_context = nullptr;
  set_boot_registers(pe, mapped_bytes);
  refresh(pe);
}

/// What follows from the memory's rights.
void TranslatedImage::refresh(TranslatedPe& pe) const {
  constexpr std::uint32_t kWidest = 4;
  const std::uint32_t end = kMemoryBase + pe.memory_bytes;
  const auto limit = [&](std::uint32_t begin, Access access) {
    const std::uint32_t bytes = begin < end ? freely_accessible(pe, begin, end, access) : 0;
    return bytes >= kWidest ? bytes - (kWidest - 1) : 0;
  };
  pe.load_limit = limit(kMemoryBase, Access::load);
  pe.store_limit = limit(code_.store_base(), Access::store);
  pe.may_fetch = freely_accessible(pe, code_.begin(), code_.end(), Access::fetch) == code_.end() - code_.begin();
}

bool TranslatedImage::may_run_translated(const TranslatedPe& pe) const {
  return pe.may_fetch && pe.frm == 0 && (!has_float_ || !float_is_off(pe));
}

Interpreter::Step TranslatedImage::interpret(TranslatedPe& pe) const {
  const PlacedInstruction* placed = code_.at(pe.pc);
  constexpr std::uint32_t kFcsr = 3;  // fflags, frm and this give no rights
  const bool may_change_rights =
      placed != nullptr &&
      ((is_csr(placed->instruction.op) && placed->instruction.immediate > kFcsr) || placed->instruction.op == Op::mret);
  const Interpreter::Step step = interpreter_.step(pe);
  if (may_change_rights) refresh(pe);
  return step;
}

/// The block has been counted whole, but it was left at pe.pc.
void TranslatedImage::give_back_rest(TranslatedPe& pe) const {
  const Cost rest = way_at(pe.pc)->rest;
  pe.cycles -= rest.cycles;
  pe.instructions -= rest.instructions;
}

TranslatedImage::Stop TranslatedImage::run(TranslatedPe& pe) const {
  const bool translated = !interpret_;
  while (pe.cycles < pe.cycle_limit) {
    const Way* way = translated && may_run_translated(pe) ? way_at(pe.pc) : nullptr;
    if (way != nullptr && way->region != kNone) {
      pe.slice = static_cast<std::uint32_t>(std::min<std::uint64_t>(pe.cycle_limit - pe.cycles, kMostSlice));
      const auto why = static_cast<Exit>(regions_[way->region](&pe));
      pe.cycles += static_cast<std::uint32_t>(pe.count);
      pe.instructions += pe.count >> 32U;
      if (why == Exit::hint) return Stop::hint;
      if (why != Exit::look) continue;
      give_back_rest(pe);
    }
    const Interpreter::Step step = interpret(pe);
    if (step == Interpreter::Step::stuck) return Stop::stuck;
    if (step != Interpreter::Step::hint) continue;
    if (!call_marker(pe)) return Stop::hint;
  }
  return Stop::cycle_limit;
}

}  // namespace torolux::translated
