// SPDX-License-Identifier: MIT
// An image that does not fit into a PE's memory: what is told names a memory that suffices, also for what it takes when
// it runs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "emulator/errors.hpp"
#include "firmware/kit/packet.hpp"
#include "host_tools/run/run.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/translated/assembler.hpp"
#include "tests/unit/emulator/engines/elf_builder.hpp"

namespace torolux {
namespace {

using testing::HasSubstr;

std::string refusal_of(std::uint32_t data_bytes, unsigned columns) {
  test::ElfPlan plan;
  plan.code = {test::hint(protocol::Hint::halt)};
  plan.data_bytes = data_bytes;
  MachineSetup setup;
  setup.columns = columns;
  setup.rows = 1;
  setup.engine = kInterpretedEngine;
  setup.local_memory_bytes = protocol::kSmallestLocalMemory;
  const Image image = parse_image(test::build_elf(plan), "large.elf");
  return testing_support::message_of<InputError>([&] { run_image(setup, image, [](const PeText&) {}, {}); });
}

TEST(ImageMemory, WhatIsToldSufficesForTheHeapToo) {
  constexpr std::uint32_t data = 300 * 1024;
  const std::string told = refusal_of(data, 1);
  EXPECT_THAT(told, HasSubstr("large.elf: needs 311296 bytes of local memory for itself, a PE has 262144: give it "
                              "--pe-memory 448K or more"));
  // As firmware/kit shares out what is behind the image.
  constexpr std::uint32_t begin = protocol::kLocalMemoryBase;
  constexpr std::uint32_t image_end = begin + 311296;
  EXPECT_GT(kit::slot_layout(begin, begin + 448 * 1024).staging, image_end + 16 * 1024);
  // A table of PEs on the heap.
  EXPECT_THAT(refusal_of(data, 16384), HasSubstr("--pe-memory 1024K or more"));
  EXPECT_THAT(refusal_of(60U << 20U, 1), HasSubstr("no PE may have what it takes (64M)"));
}

}  // namespace
}  // namespace torolux
