// SPDX-License-Identifier: MIT
// Draws instructions so that programs stay inside their memory and come to an end.
#include "tests/translated/random_program.hpp"

#include <array>
#include <cstring>
#include <random>

namespace torolux::test {
namespace {

// Registers with a task; all others are drawn freely, x0 among them.
constexpr Reg kBase = 2, kLoops = 3, kAddress = 4;
constexpr std::int32_t kHalfWindow = 2048;
constexpr Word kMiddle = kData + 0x4000;    // what loads and stores reach lies around it
constexpr Word kRegisters = kData + 0x100;  // where the registers are written at the end

class Drawer {
 public:
  Drawer(std::uint64_t seed, bool sees_flags) : random_(seed), sees_flags_(sees_flags) {}

  Code draw(std::uint64_t instructions);

 private:
  Word below(Word end) { return static_cast<Word>(random_() % end); }
  Reg any() { return below(32); }
  /// A register that may be written.
  Reg target() {
    for (;;) {
      const Reg r = any();
      if (r != kBase && r != kLoops && r != kAddress) return r;
    }
  }
  std::int32_t immediate() { return static_cast<std::int32_t>(below(4096)) - 2048; }
  std::int32_t offset(Word bytes) {
    return static_cast<std::int32_t>(below(4096 - bytes)) - kHalfWindow;  // misaligned, too
  }

  void add_one(Code& code);
  Word integer();
  Word memory();
  Word floating();
  Word rounding();
  void add_atomic(Code& code);
  void add_jump(Code& code);
  void add_wild_jump(Code& code);
  void add_compressed(Code& code);
  void add_csr(Code& code);

  std::mt19937_64 random_;
  bool sees_flags_;
};

Word Drawer::integer() {
  switch (below(4)) {
    case 0: {
      const Word f3 = below(8);
      const bool shifts = f3 == 1 || f3 == 5;
      const auto shift = static_cast<std::int32_t>(below(32) | (f3 == 5 ? below(2) << 10U : 0U));
      // slti x0, x0 would be a HINT.
      const Reg rd = f3 == 2 ? 5 + below(27) : target();
      return i_type(0x13, f3, rd, any(), shifts ? shift : immediate());
    }
    case 1:
      return r_type(0x33, below(8), 0x01, target(), any(), any());
    case 2:
      return below(8) == 0 ? static_cast<Word>(random_()) << 12U | target() << 7U | 0x37U | below(2) << 5U
                           : r_type(0x33, below(2) * 5, 0x20, target(), any(), any());
    default:
      return r_type(0x33, below(8), 0x00, target(), any(), any());
  }
}

Word Drawer::memory() {
  constexpr std::array<Word, 5> kLoads = {0, 1, 2, 4, 5};
  switch (below(4)) {
    case 0:
      return s_type(0x23, below(3), kBase, any(), offset(4));
    case 1:
      return flw(any(), kBase, offset(4));
    case 2:
      return fsw(any(), kBase, offset(4));
    default:
      return i_type(0x03, kLoads[below(5)], target(), kBase, offset(4));
  }
}

/// Mostly as frm says or to nearest, seldom another.
Word Drawer::rounding() {
  return below(8) == 0 ? below(5) : below(2) * 7;
}

Word Drawer::floating() {
  constexpr std::array<Word, 5> kArithmetic = {0x00, 0x04, 0x08, 0x0C, 0x2C};
  switch (below(8)) {
    case 0:
      return r_type(0x53, below(3), 0x10, any(), any(), any());
    case 1:
      return r_type(0x53, below(3), 0x50, target(), any(), any());
    case 2:
      return r_type(0x53, below(2), 0x14, any(), any(), any());
    case 3:
      return below(2) == 0 ? r_type(0x53, below(2) == 0 ? 1 : rounding(), 0x60, target(), any(), below(2))
                           : r_type(0x53, rounding(), 0x68, any(), any(), below(2));
    case 4:
      return below(2) == 0 ? r_type(0x53, below(2), 0x70, target(), any(), 0) : r_type(0x53, 0, 0x78, any(), any(), 0);
    case 5:
      return any() << 27U | r_type(0x43 + 4 * below(4), rounding(), 0, any(), any(), any());
    default: {
      const Word f7 = kArithmetic[below(5)];
      return r_type(0x53, rounding(), f7, any(), any(), f7 == 0x2C ? 0 : any());
    }
  }
}

void Drawer::add_atomic(Code& code) {
  constexpr std::array<Word, 11> kOps = {0x02, 0x03, 0x01, 0x00, 0x04, 0x0C, 0x08, 0x10, 0x14, 0x18, 0x1C};
  code << addi(kAddress, kBase, (static_cast<std::int32_t>(below(16)) - 8) * 4);
  const Word which = kOps[below(11)];
  const auto add = [&](Word op) {
    code << r_type(0x2F, 2, op << 2U | below(4), target(), kAddress, op == 0x02 ? 0 : any());
  };
  add(which);
  if (which == 0x02 && below(2) == 0) code << sw(any(), kAddress, 0);
  if (which == 0x02) add(0x03);
}

/// Forwards over a few instructions, now and then by a register.
void Drawer::add_jump(Code& code) {
  const auto skipped = static_cast<std::int32_t>(1 + below(4));
  const std::int32_t over = 4 * (skipped + 1);
  constexpr std::array<Word, 6> kConditions = {0, 1, 4, 5, 6, 7};
  switch (below(4)) {
    case 0:
      code << j_type(target(), over);
      break;
    case 1:
      code << i_type(0x17, 0, kAddress, 0, 0) << jalr(target(), kAddress, 8 + over - 4);
      code[code.words().size() - 2] = kAddress << 7U | 0x17U;  // auipc kAddress, 0
      break;
    default:
      code << b_type(kConditions[below(6)], any(), any(), over);
      break;
  }
  for (std::int32_t i = 0; i < skipped; ++i) code << (below(2) == 0 ? integer() : floating());
}

/// To one of the four instructions behind it, as a register says that nobody can foresee: by `ret` or otherwise.
void Drawer::add_wild_jump(Code& code) {
  const bool returns = below(2) == 0;
  constexpr Reg kRa = 1;
  const Reg to = returns ? kRa : kAddress;
  const Reg which = 5 + below(27);
  code << i_type(0x13, 7, which, any(), 12);                            // andi which, any, 12
  code << (to << 7U | 0x17U) << r_type(0x33, 0, 0, to, to, which);      // auipc to, 0; add to, to, which
  code << addi(to, to, 16) << jalr(returns ? 0 : below(2) * 5, to, 0);  // to the instruction behind this, or later
  for (int i = 0; i < 4; ++i) code << (below(2) == 0 ? integer() : floating());
}

/// Two compressed instructions that any operands suit: c.addi, c.li, c.slli, c.mv, c.add, or arithmetic.
void Drawer::add_compressed(Code& code) {
  const auto one = [&]() -> Word {
    const Reg rd = target() | 0;
    switch (below(5)) {
      case 0:
        return 0x0001U | rd << 7U | below(32) << 2U | below(2) << 12U;
      case 1:
        return 0x4001U | rd << 7U | below(32) << 2U | below(2) << 12U;
      case 2:
        return 0x0002U | rd << 7U | below(32) << 2U;
      case 3:
        return (rd == 0 ? 0x8002U | 6U << 7U : 0x8002U | rd << 7U) | (1 + below(31)) << 2U | below(2) << 12U;
      default:
        return 0x8C01U | below(8) << 7U | below(4) << 5U | below(8) << 2U;
    }
  };
  const Word first = one();
  code << (first | one() << 16U);
}

void Drawer::add_csr(Code& code) {
  switch (below(sees_flags_ ? 4 : 2)) {
    case 0:
      code << csrrwi(0, csr::kFrm, below(4) == 0 ? below(5) : 0);
      break;
    case 1:
      code << csrrs(target(), csr::kFrm, 0);
      break;
    case 2:
      code << csrrs(target(), csr::kFcsr, 0);
      break;
    default:
      code << csrrw(target(), csr::kFflags, any());
      break;
  }
}

void Drawer::add_one(Code& code) {
  const Word kind = below(100);
  if (kind < 36) {
    code << integer();
  } else if (kind < 56) {
    code << memory();
  } else if (kind < 86) {
    code << floating();
  } else if (kind < 90) {
    add_jump(code);
  } else if (kind < 91) {
    add_wild_jump(code);
  } else if (kind < 97) {
    add_compressed(code);
  } else if (kind < 98) {
    add_csr(code);
  } else {
    add_atomic(code);
  }
}

Code Drawer::draw(std::uint64_t instructions) {
  constexpr std::int32_t kLongestJump = 1 << 18;  // bytes that the jump back reaches, with room to spare
  const std::int32_t body = std::min<std::int32_t>(static_cast<std::int32_t>(400 + below(1600)) * 4, kLongestJump);
  Code code;
  code.li(5, 0x2000) << csrrs(0, csr::kMstatus, 5);
  code.li(kBase, kMiddle).li(kLoops, static_cast<Word>(instructions / static_cast<std::uint64_t>(body / 4)) + 1);
  code.li(kAddress, kMiddle);
  for (Reg r = 0; r < 32; ++r) code << flw(r, kBase, static_cast<std::int32_t>(4 * r));
  const std::int32_t begin = code.here();
  while (code.here() - begin < body) add_one(code);
  // The body is too long for a branch back.
  code << addi(kLoops, kLoops, -1) << b_type(0, kLoops, 0, 8);
  code << j_type(0, begin - code.here());
  code << csrrwi(0, csr::kFrm, 0) << addi(kBase, kBase, 0);
  code << lui(kAddress, kRegisters) << addi(kAddress, kAddress, static_cast<std::int32_t>(kRegisters & 0xFFFU));
  for (Reg r = 0; r < 32; ++r) {
    code << sw(r, kAddress, static_cast<std::int32_t>(4 * r))
         << fsw(r, kAddress, static_cast<std::int32_t>(128 + 4 * r));
  }
  if (sees_flags_) code << csrrs(5, csr::kFcsr, 0) << sw(5, kAddress, 256);
  code << hint(protocol::Hint::halt);
  return code;
}

void fill_data(std::span<std::byte> memory, std::uint64_t seed) {
  constexpr std::array<Word, 24> kSpecial = {0x00000000, 0x80000000, 0x3F800000, 0xBF800000, 0x7F800000, 0xFF800000,
                                             0x7FC00000, 0xFFC00001, 0x7F800001, 0xFF800001, 0x00000001, 0x807FFFFF,
                                             0x00800000, 0x7F7FFFFF, 0xFF7FFFFF, 0x4B000000, 0x4F000000, 0xCF000000,
                                             0x33800000, 0x3F7FFFFF, 0x7FFFFFFF, 0xFFFFFFFF, 0x40490FDB, 0x00000002};
  std::mt19937_64 random(seed);
  for (std::size_t at = kData - protocol::kLocalMemoryBase; at < kDataEnd - protocol::kLocalMemoryBase; at += 4) {
    const std::uint64_t bits = random();
    const Word word = bits % 2 == 0 ? kSpecial[(bits >> 1U) % kSpecial.size()] : static_cast<Word>(bits >> 32U);
    std::memcpy(&memory[at], &word, sizeof word);
  }
}

}  // namespace

RandomProgram make_random_program(std::uint64_t seed, std::uint64_t instructions, bool sees_flags) {
  Drawer drawer(seed, sees_flags);
  return {image_of(drawer.draw(instructions)), [seed](std::span<std::byte> memory) { fill_data(memory, seed); }};
}

}  // namespace torolux::test
