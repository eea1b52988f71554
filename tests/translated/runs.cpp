// SPDX-License-Identifier: MIT
// Starts a PE on one of the ways and waits for its halt.
#include "tests/translated/runs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <sstream>

#include "emulator/engines/translated/run/translated_engine.hpp"
#include "emulator/errors.hpp"
#include "tests/unit/emulator/engines/elf_builder.hpp"
#include "tests/unit/emulator/engines/engine_support.hpp"

namespace torolux::test {
namespace {

EngineFactory factory_for(Way way) {
  if (way == Way::qemu) return engine_named("qemu");
  return [way](const EngineSetup& setup) {
    translated::TranslationOptions options;
    options.interpret = way == Way::interpreted;
    return make_translated_engine(setup, options);
  };
}

void compare(const Outcome& expected, const Outcome& actual, Counts counts, const std::string& label) {
  EXPECT_EQ(expected.halted, actual.halted) << label << ": " << expected.failure << " | " << actual.failure;
  if (counts == Counts::compared) {
    EXPECT_EQ(expected.clock, actual.clock) << label;
    EXPECT_EQ(expected.instructions, actual.instructions) << label;
  }
  const auto [left, right] = std::mismatch(expected.memory.begin(), expected.memory.end(), actual.memory.begin());
  if (left == expected.memory.end()) return;
  const auto address = static_cast<Word>(0x8000'0000U + static_cast<Word>(left - expected.memory.begin()) / 4 * 4);
  std::ostringstream text;
  text << label << ": memory differs at 0x" << std::hex << address << ": 0x" << expected.word(address) << " and 0x"
       << actual.word(address);
  ADD_FAILURE() << text.str();
}

}  // namespace

std::string name_of(Way way) {
  switch (way) {
    case Way::qemu:
      return "qemu";
    case Way::interpreted:
      return "interpreted";
    case Way::translated:
      return "translated";
  }
  return "";
}

Image image_of(const Code& code) {
  ElfPlan plan;
  plan.code = code.words();
  plan.data_address = kData - protocol::kPageBytes;
  plan.data_bytes = kDataEnd - plan.data_address;
  const std::vector<std::byte> elf = build_elf(plan);
  return parse_image(elf, "test program");
}

std::uint32_t Outcome::word(Word address) const {
  Word value = 0;
  std::memcpy(&value, memory.data() + (address - protocol::kLocalMemoryBase), sizeof value);
  return value;
}

Outcome run_to_halt(const Image& image, Way way, const Fill& fill) {
  BarePes pes(image, 1, {}, factory_for(way));
  const auto memory = pes.local_memory(0).first(protocol::kSmallestLocalMemory);
  if (fill) fill(memory);
  Outcome outcome;
  try {
    pes.engine().start();
    while (!outcome.halted) {
      const auto command = pes.next_command(0);
      if (!command) {
        outcome.failure = "does not halt";
        break;
      }
      outcome.halted = command->head.kind == CommandKind::halt || command->head.kind == CommandKind::fail;
      outcome.clock = command->head.time - kCommandCycles;
    }
  } catch (const MachineFailure& failure) {
    outcome.failure = failure.what();
  }
  pes.channel(0).stopping.store(1);
  pes.engine().stop();
  outcome.instructions = pes.channel(0).instructions.load();
  outcome.memory.assign(memory.begin(), memory.end());
  return outcome;
}

Outcome run_on_all(const Image& image, const std::string& label, const Fill& fill, Counts counts) {
  const Outcome qemu = run_to_halt(image, Way::qemu, fill);
  for (const Way way : {Way::interpreted, Way::translated}) {
    compare(qemu, run_to_halt(image, way, fill), counts, label + ", " + name_of(way));
  }
  return qemu;
}

}  // namespace torolux::test
