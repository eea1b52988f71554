// SPDX-License-Identifier: MIT
// Registers from the trap handler or from the engine, then frame by frame.
#include "emulator/machine/call_stacks.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>

#include "emulator/errors.hpp"
#include "emulator/hexadecimal.hpp"
#include "firmware/protocol/machine.hpp"

namespace torolux {
namespace {

/// Of start.S: mepc, then x1 to x31, of which those in kStackRegisters are written.
constexpr std::string_view kTrapRegisters = "__trap_registers";
constexpr std::uint32_t kWord = 4;

FrameRegisters frame_of(std::uint32_t pc) {
  FrameRegisters frame;
  frame.pc = pc;
  return frame;
}

template <class Value>
void fill_in(FrameRegisters& frame, Value value) {
  for (std::uint32_t number = 1; number < frame.x.size(); ++number) {
    if ((kStackRegisters >> number & 1U) != 0) frame.x[number] = value(number);
  }
}

/// Of the driver or the library, not of the program. The driver's headers may have been installed anywhere.
bool is_the_machines_own(const SourcePlace& place) {
  return place.file.starts_with("firmware/niu/") || place.file.find("/firmware/niu/") != std::string::npos ||
         place.file.starts_with("firmware/kit/");
}

/// "torolux::pe::Niu::receive()" -> "receive".
std::string plain_name(const std::string& function) {
  std::string name = function.substr(0, function.find_first_of("(<"));
  if (const std::size_t scope = name.rfind("::"); scope != std::string::npos) name = name.substr(scope + 2);
  return name.empty() ? function : name;
}

std::string words_of(const CallStack& stack) {
  const auto& frames = stack.frames;
  auto own = std::ranges::find_if_not(frames, is_the_machines_own, &CallFrame::place);
  const std::string function = plain_name((own == frames.begin() ? own : own - 1)->place.function);
  own = std::find_if(own, frames.end(), [](const CallFrame& frame) { return !frame.place.file.empty(); });
  const std::string place = own == frames.end() ? "" : " at " + own->place.file + ":" + std::to_string(own->place.line);
  return function + place + ", pc " + hexadecimal(frames.front().pc);
}

}  // namespace

CallStacks::CallStacks(const ImageSet& images, const std::vector<PeMemory>& pes, Engine& engine)
    : images_(images), pes_(pes), engine_(engine), debug_infos_(images.images().size()) {}

std::span<const std::byte> CallStacks::memory_of(unsigned pe) const {
  engine_.bring(pe, 0, pes_[pe].local_memory_bytes);
  return pes_[pe].local.bytes().first(pes_[pe].local_memory_bytes);
}

const DebugInfo& CallStacks::debug_info_of(unsigned pe) {
  std::unique_ptr<DebugInfo>& info = debug_infos_[images_.number_of(pe)];
  if (info == nullptr) {
    std::vector<std::byte> contents;
    try {
      contents = read_image_file(images_.of(pe).file);
    } catch (const InputError&) {  // gone since: the message has names all the same
    }
    info = std::make_unique<DebugInfo>(std::move(contents));
  }
  return *info;
}

std::optional<std::uint32_t> CallStacks::word(unsigned pe, std::uint32_t address) const {
  const std::uint64_t offset = std::uint64_t{address} - protocol::kLocalMemoryBase;
  if (address < protocol::kLocalMemoryBase || offset + kWord > pes_[pe].local_memory_bytes) return std::nullopt;
  engine_.bring(pe, static_cast<std::uint32_t>(offset), kWord);
  std::uint32_t value = 0;
  std::memcpy(&value, pes_[pe].local.bytes().data() + offset, sizeof value);
  return value;
}

CallStack CallStacks::stack(unsigned pe, const FrameRegisters& innermost) {
  return call_stack(images_.of(pe), debug_info_of(pe), innermost,
                    [this, pe](std::uint32_t address) { return word(pe, address); });
}

std::optional<FrameRegisters> CallStacks::registers_of(unsigned pe) {
  const auto registers = engine_.stack_registers(pe);
  if (!registers) return std::nullopt;
  FrameRegisters frame = frame_of(registers->pc);
  fill_in(frame, [&](std::uint32_t number) { return registers->x[number]; });
  return frame;
}

std::string CallStacks::of_trap(unsigned pe, std::uint32_t mepc) {
  const auto& symbols = images_.of(pe).symbols;
  const auto place = std::ranges::find(symbols, kTrapRegisters, &ImageSymbol::name);
  if (place == symbols.end() || word(pe, place->address) != mepc) return "";
  FrameRegisters frame = frame_of(mepc);
  fill_in(frame, [&](std::uint32_t number) { return word(pe, place->address + kWord * number); });
  return in_words(stack(pe, frame));
}

std::string CallStacks::of_pe(unsigned pe, std::optional<std::uint32_t> pc) {
  auto frame = registers_of(pe);
  if (!frame) return "";
  frame->pc = pc.value_or(frame->pc);
  return in_words(stack(pe, *frame));
}

CallStacks::Place CallStacks::place_of(unsigned pe) {
  const auto frame = registers_of(pe);
  if (!frame) return {};
  const CallStack calls = stack(pe, *frame);
  return {words_of(calls), in_words(calls)};
}

}  // namespace torolux
