// SPDX-License-Identifier: MIT
// Proves: whatever a program writes to the registers of memory protection, locked entries among them, what it reads
// back, which loads, stores and jumps are refused afterwards, and with which trap, is QEMU's.
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <random>
#include <string>

#include "tests/translated/runs.hpp"

namespace torolux::test {
namespace {

constexpr Word kPmpcfg0 = 0x3A0, kPmpaddr0 = 0x3B0;
constexpr Word kEntries = 16, kConfigs = 4;
constexpr Reg kRa = 1, kT0 = 5, kT1 = 6, kT2 = 7, kLog = 20, kValue = 21, kAddress = 22, kTable = 23, kCount = 24;
constexpr Reg kRounds = 25, kKind = 26;

/// Where what: the log, then the table of what to do; memory that may become protected; code that returns at once.
constexpr Word kTableAddress = 0x8003'0000U, kVictim = 0x8003'8000U, kVictimBytes = 0x8000;
constexpr Word kPads = 0x8000'1000U, kPadsBytes = 0x1000;

enum Kind : Word { kLb, kLhu, kLw, kSb, kSh, kSw, kCall, kKinds };
constexpr std::uint32_t kRoundsEach = 4, kAccesses = 32;

/// What a round reads: all registers of memory protection, then accesses.
struct Round {
  std::array<Word, kEntries> addresses;
  std::array<Word, kConfigs> configs;
  struct Access {
    Word kind, address;
  };
  std::array<Access, kAccesses> accesses;
};

Word access_of(Word kind) {
  constexpr std::array<Word, kKinds> kWords = {i_type(0x03, 0, kValue, kAddress, 0),
                                               i_type(0x03, 5, kValue, kAddress, 0),
                                               lw(kValue, kAddress, 0),
                                               s_type(0x23, 0, kAddress, kValue, 0),
                                               s_type(0x23, 1, kAddress, kValue, 0),
                                               sw(kValue, kAddress, 0),
                                               jalr(kRa, kAddress, 0)};
  return kWords[kind];
}

/// Logs mcause, mepc and mtval, and goes on behind the instruction, or at ra where it cannot be fetched.
void add_handler(Code& code) {
  const std::int32_t handler = code.here() + 16;
  code.li(kT0, 0x8000'0000U + static_cast<Word>(handler)) << csrrw(0, csr::kMtvec, kT0);
  const std::size_t skip = code.words().size();
  code << 0;
  std::int32_t offset = 0;
  for (const Word number : {csr::kMcause, csr::kMepc, csr::kMtval}) {
    code << csrrs(kT1, number, 0) << sw(kT1, kLog, offset);
    offset += 4;
  }
  code << addi(kLog, kLog, offset);
  code << csrrs(kT1, csr::kMepc, 0) << csrrs(kT2, csr::kMcause, 0) << addi(kT1, kT1, 4) << addi(kT2, kT2, -1);
  code << bne(kT2, 0, 8) << addi(kT1, kRa, 0);
  code << csrrw(0, csr::kMepc, kT1) << 0x3020'0073U;  // mret
  code[skip] = j_type(0, code.here() - static_cast<std::int32_t>(4 * skip));
}

/// Takes a round's registers from the table, and logs what they have become.
void add_registers(Code& code) {
  const auto number = [](Word i) { return i < kEntries ? kPmpaddr0 + i : kPmpcfg0 + i - kEntries; };
  for (Word i = 0; i < kEntries + kConfigs; ++i) {
    code << lw(kT0, kTable, static_cast<std::int32_t>(4 * i)) << csrrw(0, number(i), kT0);
  }
  for (Word i = 0; i < kEntries + kConfigs; ++i) {
    code << csrrs(kT0, number(i), 0) << sw(kT0, kLog, static_cast<std::int32_t>(4 * i));
  }
  constexpr std::int32_t kBytes = 4 * (kEntries + kConfigs);
  code << addi(kLog, kLog, kBytes) << addi(kTable, kTable, kBytes);
}

/// The same program every time: what it does stands in the table.
Code program() {
  Code code;
  code.li(kLog, kData).li(kTable, kTableAddress).li(kRounds, kRoundsEach);
  add_handler(code);
  const std::int32_t round = code.here();
  add_registers(code);
  code.li(kCount, kAccesses);
  const std::int32_t access = code.here();
  code << lw(kKind, kTable, 0) << lw(kAddress, kTable, 4) << addi(kTable, kTable, 8);
  code.li(kValue, 0x1234'5678U);
  for (Word kind = 0; kind < kKinds; ++kind) {
    code << addi(kT1, 0, static_cast<std::int32_t>(kind)) << bne(kKind, kT1, 8) << access_of(kind);
  }
  code << sw(kValue, kLog, 0) << addi(kLog, kLog, 4);
  code << addi(kCount, kCount, -1) << bne(kCount, 0, access - code.here());
  code << addi(kRounds, kRounds, -1) << bne(kRounds, 0, round - code.here());
  code << hint(protocol::Hint::halt);
  while (code.here() < static_cast<std::int32_t>(kPads - 0x8000'0000U)) code << 0;
  while (code.here() < static_cast<std::int32_t>(kPads + kPadsBytes - 0x8000'0000U)) code << jalr(0, kRa, 0);
  return code;
}

class RoundDrawer {
 public:
  explicit RoundDrawer(std::uint64_t seed) : random_(seed) {}

  Round draw() {
    Round round{};
    for (Word i = 0; i < kEntries; ++i) {
      round.addresses[i] = is_of_pads(i) ? range(kPads, kPadsBytes) : range(kVictim, kVictimBytes);
      round.configs[i / 4] |= config(i) << (8 * (i % 4));
    }
    for (Round::Access& access : round.accesses) access = draw_access(round);
    return round;
  }

 private:
  static bool is_of_pads(Word entry) { return entry < kEntries / 2; }
  Word below(Word end) { return static_cast<Word>(random_() % end); }

  /// pmpaddr of a range inside, whether it is read as an address or as a power of two.
  Word range(Word begin, Word bytes) {
    const Word address = (begin + below(bytes)) >> 2U;
    if (below(3) == 0) return address & ~(bytes / 16);  // by chance all ones, it would reach out
    // 8 bytes to a half of all: so many ones at the end.
    Word ones = 0;
    for (Word size = 8; size < bytes / 2 && below(6) != 0; size *= 2) ones = ones << 1U | 1U;
    return (address | ones) & ~(ones + 1U);
  }

  /// The first entry of each half has no lower end of its own: as "top of range" it would reach into what the program
  /// needs.
  Word config(Word entry) {
    const Word match = below(4);
    const bool reaches_out = match == 1 && entry % (kEntries / 2) == 0;
    const Word locked = below(5) == 0 ? 0x80 : 0;
    return locked | (reaches_out ? 0 : match << 3U) | below(8) | (below(16) == 0 ? 0x60 : 0);
  }

  /// Mostly near an end of a range.
  Round::Access draw_access(const Round& round) {
    const Word entry = below(kEntries);
    const bool near = below(4) != 0;
    const Word kind = is_of_pads(entry) ? (below(2) == 0 ? kCall : below(3)) : below(kCall);
    const Word begin = is_of_pads(entry) ? kPads : kVictim;
    const Word bytes = is_of_pads(entry) ? kPadsBytes : kVictimBytes;
    Word offset = near ? (round.addresses[entry] << 2U) + below(24) - 12 - begin : below(bytes);
    const Word alignment = kind == kCall || below(3) != 0 ? 4 : 1;
    offset = offset % bytes / alignment * alignment;
    // Across pages QEMU's mtval depends on what it has cached: see emulator/engines/translated/README.md.
    if (offset % 4096 > 4092) offset -= 4;
    return {kind, begin + offset};
  }

  std::mt19937_64 random_;
};

void fill(std::span<std::byte> memory, std::uint64_t seed) {
  RoundDrawer drawer(seed);
  for (std::uint32_t i = 0; i < kRoundsEach; ++i) {
    const Round round = drawer.draw();
    std::memcpy(&memory[kTableAddress - 0x8000'0000U + i * sizeof round], &round, sizeof round);
  }
}

TEST(TranslatedProtection, RandomSettingsRefuseWhatQemuRefuses) {
  const Image image = image_of(program());
  Word traps = 0;
  constexpr std::uint64_t kPrograms = 100;
  for (std::uint64_t seed = 1; seed <= kPrograms && !testing::Test::HasFailure(); ++seed) {
    const auto filled = [seed](std::span<std::byte> memory) { fill(memory, seed); };
    const Outcome outcome = run_on_all(image, "seed " + std::to_string(seed), filled, Counts::ignored);
    EXPECT_TRUE(outcome.halted);
    // The first words behind a round's registers are a trap's cause, or the value of an access.
    constexpr Word kFirst = kData + 4 * (kEntries + kConfigs);
    const Word cause = outcome.word(kFirst);
    traps += cause == 1 || cause == 5 || cause == 7 ? 1 : 0;
  }
  EXPECT_GT(traps, kPrograms / 20) << "a test in which nothing is refused proves nothing";
  EXPECT_LT(traps, kPrograms * 19 / 20);
}

}  // namespace
}  // namespace torolux::test
