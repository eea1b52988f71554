// SPDX-License-Identifier: MIT
// Reads `addi sp, sp, -N` and `sw register, N(sp)`, also compressed, in the order in which they stand. What raises the
// stack pointer is the end of some way out, behind which the code goes on as before.
#include "emulator/engines/image/prologue.hpp"

#include <cstring>

namespace torolux {
namespace {

constexpr unsigned kStackPointer = 2;

/// What one instruction does to stack pointer and frame.
struct Effect {
  unsigned bytes = 4;             // of the instruction
  std::int32_t moves = 0;         // the stack pointer, by so much
  std::optional<unsigned> saves;  // this register
  std::int32_t offset = 0;        // there, from the stack pointer
  bool unclear = false;
};

constexpr std::uint32_t field(std::uint32_t bits, unsigned low, unsigned count) {
  return bits >> low & ((1U << count) - 1U);
}

constexpr std::int32_t sign_extended(std::uint32_t value, unsigned bits) {
  const std::uint32_t sign = 1U << (bits - 1U);
  return static_cast<std::int32_t>((value ^ sign) - sign);
}

/// RISC-V unprivileged architecture, "C": c.addi, c.addi16sp, c.swsp, and what else may write the stack pointer.
Effect effect_of_compressed(std::uint32_t bits) {
  Effect effect;
  effect.bytes = 2;
  const std::uint32_t kind = field(bits, 13, 3) << 2U | field(bits, 0, 2);
  const bool to_stack_pointer = field(bits, 7, 5) == kStackPointer;
  constexpr std::uint32_t kAddi = 0b00001, kAddi16 = 0b01101, kMoveOrAdd = 0b10010, kStore = 0b11010;
  if (kind == kAddi && to_stack_pointer) {
    effect.moves = sign_extended(field(bits, 12, 1) << 5U | field(bits, 2, 5), 6);
  } else if (kind == kAddi16 && to_stack_pointer) {
    effect.moves = sign_extended(field(bits, 12, 1) << 9U | field(bits, 3, 2) << 7U | field(bits, 5, 1) << 6U |
                                     field(bits, 2, 1) << 5U | field(bits, 6, 1) << 4U,
                                 10);
  } else if (kind == kStore) {
    effect.saves = field(bits, 2, 5);
    effect.offset = static_cast<std::int32_t>(field(bits, 7, 2) << 6U | field(bits, 9, 4) << 2U);
  } else if (kind == kMoveOrAdd && to_stack_pointer && field(bits, 2, 5) != 0) {
    effect.unclear = true;
  }
  return effect;
}

Effect effect_of(std::uint32_t bits) {
  if (field(bits, 0, 2) != 3) return effect_of_compressed(bits);
  Effect effect;
  const std::uint32_t opcode = field(bits, 0, 7);
  const std::uint32_t kind = field(bits, 12, 3);
  const bool from_stack_pointer = field(bits, 15, 5) == kStackPointer;
  constexpr std::uint32_t kImmediate = 0x13, kStore = 0x23, kRegisters = 0x33, kUpper = 0x37, kUpperPc = 0x17;
  constexpr std::uint32_t kWord = 2;
  if (opcode == kStore && kind == kWord && from_stack_pointer) {
    effect.saves = field(bits, 20, 5);
    effect.offset = sign_extended(field(bits, 25, 7) << 5U | field(bits, 7, 5), 12);
  } else if (field(bits, 7, 5) == kStackPointer) {
    const bool adds = opcode == kImmediate && kind == 0 && from_stack_pointer;
    if (adds) effect.moves = sign_extended(field(bits, 20, 12), 12);
    effect.unclear = !adds && (opcode == kImmediate || opcode == kRegisters || opcode == kUpper || opcode == kUpperPc);
  }
  return effect;
}

/// The instruction's bits; those of a short one below those of the next.
std::optional<std::uint32_t> instruction_at(const Image& image, std::uint32_t address) {
  for (const ImageSegment& segment : image.segments) {
    if (!segment.executable || address < segment.address) continue;
    const std::size_t offset = address - segment.address;
    if (offset + 2 > segment.contents.size()) continue;
    std::uint32_t bits = 0;
    std::memcpy(&bits, segment.contents.data() + offset, offset + 4 <= segment.contents.size() ? 4 : 2);
    return bits;
  }
  return std::nullopt;
}

}  // namespace

std::optional<FrameLayout> frame_layout(const Image& image, std::uint32_t begin, std::uint32_t end) {
  FrameLayout layout;
  for (std::uint32_t address = begin; address < end;) {
    const auto bits = instruction_at(image, address);
    if (!bits) return std::nullopt;
    const Effect effect = effect_of(*bits);
    if (effect.unclear) return std::nullopt;
    if (effect.moves < 0) layout.bytes += static_cast<std::uint32_t>(-effect.moves);
    if (effect.saves && !layout.saved[*effect.saves])
      layout.saved[*effect.saves] = effect.offset - static_cast<std::int32_t>(layout.bytes);
    address += effect.bytes;
  }
  return layout;
}

}  // namespace torolux
