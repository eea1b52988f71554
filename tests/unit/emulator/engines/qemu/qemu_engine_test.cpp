// SPDX-License-Identifier: MIT
// The QEMU engine alone: what a PE's program does reaches the channel, with exact clocks; what ends, is noticed, and
// nothing is left behind.
#include "emulator/engines/qemu/qemu_engine.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstring>
#include <fstream>
#include <thread>

#include "emulator/engines/qemu/hint_log.hpp"
#include "emulator/errors.hpp"
#include "firmware/protocol/hints.hpp"
#include "firmware/protocol/niu_window.hpp"
#include "tests/unit/emulator/engines/elf_builder.hpp"
#include "tests/unit/emulator/engines/engine_support.hpp"

namespace torolux::test {
namespace {

using protocol::Hint;
using protocol::hint_instruction;
using std::chrono_literals::operator""ms;
using Clock = std::chrono::steady_clock;

constexpr std::uint32_t kNop = 0x0000'0013;
constexpr std::uint32_t kTwoCompressedNops = 0x0001'0001;
constexpr std::uint32_t kMul = 0x02C5'8533;          // mul a0,a1,a2
constexpr std::uint32_t kDiv = 0x02C5'C533;          // div a0,a1,a2
constexpr std::uint32_t kJumpToSelf = 0x0000'006F;   // jal x0,.
constexpr std::uint32_t kJumpOverOne = 0x0080'006F;  // jal x0,.+8

std::uint32_t hint(Hint operation) {
  return hint_instruction(static_cast<std::int32_t>(operation));
}

Image image_of(const std::vector<std::uint32_t>& code) {
  ElfPlan plan;
  plan.code = code;
  const TemporaryFile file("code.elf", build_elf(plan));
  return load_image(file.path());
}

/// The children of this process, without those that tests made on purpose for other things.
std::vector<pid_t> children() {
  std::vector<pid_t> found;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    std::ifstream stream(task.path() / "children");
    for (pid_t child = 0; stream >> child;) found.push_back(child);
  }
  return found;
}

/// check() until it throws; the message, or nothing after `limit`.
std::string failure(Engine& engine, std::chrono::milliseconds limit) {
  const auto deadline = Clock::now() + limit;
  while (Clock::now() < deadline) {
    try {
      engine.check();
    } catch (const MachineFailure& error) {
      return error.what();
    }
    std::this_thread::sleep_for(10ms);
  }
  return "";
}

struct HaltFigures {
  std::uint64_t clock;  ///< at the end of the HINT
  std::uint64_t instructions;
};

/// Runs code that ends in Hint::halt.
HaltFigures run_to_halt(const std::vector<std::uint32_t>& code, const MachineDescription& machine = {}) {
  BarePes pes(image_of(code), 1, machine);
  pes.engine().start();
  const auto end = pes.next_command(0);
  if (!end || end->head.kind != CommandKind::halt) {
    ADD_FAILURE() << "the code did not halt";
    return {0, 0};
  }
  return {end->head.time - kCommandCycles, pes.channel(0).instructions.load()};
}

TEST(QemuEngine, HelloSendsOneLineAndHalts) {
  BarePes pes(load_image(example_image("hello")), 1);
  pes.engine().start();
  const auto text = pes.next_command(0);
  ASSERT_TRUE(text);
  EXPECT_EQ(text->head.kind, CommandKind::send_message);
  const std::string line(reinterpret_cast<const char*>(text->payload.data()), text->payload.size());
  EXPECT_EQ(line, "Hello from PE 0 of 1");
  const auto end = pes.next_command(0);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->head.kind, CommandKind::halt);
  EXPECT_GT(end->head.time, text->head.time);
}

// Each sum is made by hand from the table of latencies: integer 1, multiply 3, divide 20, jump 2, hint 2.
TEST(QemuEngine, CountsEveryCycleUpToTheHint) {
  const HaltFigures plain = run_to_halt({kNop, kNop, kNop, hint(Hint::halt), kDiv, kDiv});
  EXPECT_EQ(plain.clock, 5U) << "what stands behind the HINT in its block does not count";
  EXPECT_EQ(plain.instructions, 4U);

  const HaltFigures mixed = run_to_halt({kNop, kTwoCompressedNops, kMul, kDiv, kJumpOverOne, kDiv, hint(Hint::halt)});
  EXPECT_EQ(mixed.clock, 1U + 2U + 3U + 20U + 2U + 2U);
  EXPECT_EQ(mixed.instructions, 7U);
}

TEST(QemuEngine, CountsBlocksOverPagesAndPastTheLongestBlock) {
  std::vector<std::uint32_t> code(5000, kNop);  // 20,000 bytes
  code.push_back(hint(Hint::halt));
  EXPECT_EQ(run_to_halt(code).clock, 5002U);
  // A HINT across a page boundary: 4094 bytes of compressed instructions, then its 4 bytes, as halves of words.
  std::vector<std::uint32_t> across(1023, kTwoCompressedNops);
  across.push_back((hint(Hint::halt) << 16U) | 0x0001U);
  across.push_back(hint(Hint::halt) >> 16U);
  const HaltFigures figures = run_to_halt(across);
  EXPECT_EQ(figures.clock, 2047U + 2U);
  EXPECT_EQ(figures.instructions, 2047U + 1U);
}

TEST(QemuEngine, TakesLatenciesFromTheMachine) {
  MachineDescription machine;
  machine.processor.latency[static_cast<std::size_t>(InstructionClass::integer)] = 7;
  machine.processor.latency[static_cast<std::size_t>(InstructionClass::hint)] = 11;
  EXPECT_EQ(run_to_halt({kNop, kNop, hint(Hint::halt)}, machine).clock, 25U);
}

TEST(QemuEngine, MarkersCostNothing) {
  const std::uint32_t enter = hint(Hint::enter_phase);
  const std::uint32_t leave = hint(Hint::leave_phase);
  const HaltFigures figures = run_to_halt({kNop, enter, kMul, leave, enter, leave, hint(Hint::halt)});
  EXPECT_EQ(figures.clock, 1U + 3U + 2U);
  EXPECT_EQ(figures.instructions, 3U);
}

// The NIU driver's loop: the HINT, a load of window.retry (offset 20), a branch back. How often it goes round while the
// PE waits depends on the computer; the clock must not.
std::vector<std::uint32_t> receive_and_halt() {
  constexpr std::uint32_t kWindowToA1 = 0x0000'15B7 | 0x8000'0000;  // lui a1,0x80001
  constexpr std::uint32_t kLoadRetry = 0x0145'A503;                 // lw a0,20(a1)
  constexpr std::uint32_t kBranchBack = 0xFE05'1CE3;                // bnez a0,.-8
  return {kWindowToA1, hint(Hint::receive), kLoadRetry, kBranchBack, hint(Hint::halt)};
}

void push_message(BarePes& pes, std::uint64_t time, std::span<const std::byte> contents) {
  pes.channel(0).arrivals.push(
      {time, static_cast<std::uint16_t>(protocol::ArrivalKind::message), protocol::kHost, 0, 16, 0, 0}, contents);
}

TEST(QemuEngine, RetriesLeaveNoTraceInTheClock) {
  for (const auto wait : {0ms, 130ms}) {
    BarePes pes(image_of(receive_and_halt()), 1);
    pes.engine().start();
    while (wait_kind(pes.channel(0).wait.load()) != WaitKind::receive) std::this_thread::sleep_for(1ms);
    std::this_thread::sleep_for(wait);
    push_message(pes, 4, {});  // the PE waits since cycle 3
    const auto received = pes.next_command(0);
    const auto end = pes.next_command(0);
    ASSERT_TRUE(received && end);
    EXPECT_EQ(received->head.kind, CommandKind::received);
    EXPECT_EQ(received->head.time, 4U + kCommandCycles);
    EXPECT_EQ(end->head.kind, CommandKind::halt);
    EXPECT_EQ(end->head.time, 4U + 2U + 2U + 2U + kCommandCycles) << "load, branch and hint, once";
    EXPECT_EQ(pes.channel(0).instructions.load(), 5U);
  }
}

// What `torolux bench engine` rests on: a PE with its log does what it did with its NIU.
class HintLog : public testing::Test {
 protected:
  static constexpr std::byte kContents[] = {std::byte{1}, std::byte{2}, std::byte{3}};

  HintLog() {
    logs_.emplace_back("log", 1U << 20U);
    BarePes pes(image_of(receive_and_halt()), 1, {}, with_log(HintLogUse::record));
    pes.engine().start();
    push_message(pes, 1000, kContents);
    EXPECT_TRUE(pes.next_command(0) && pes.next_command(0));
  }
  EngineFactory with_log(HintLogUse use) {
    return [this, use](const EngineSetup& setup) { return make_qemu_engine(setup, QemuHintLogs{use, logs_}); };
  }
  HintLogHead& head() { return *reinterpret_cast<HintLogHead*>(logs_[0].bytes().data()); }

  std::vector<SharedMemory> logs_;
};

TEST_F(HintLog, IsReplayedToItsEnd) {
  EXPECT_EQ(head().cycles, 1000U) << "the HINT that ends the run is not in the log";
  EXPECT_EQ(head().instructions, 2U);
  EXPECT_EQ(head().whole, 1U);
  BarePes pes(image_of(receive_and_halt()), 1, {}, with_log(HintLogUse::replay));
  const std::span<std::byte> memory = pes.local_memory(0);
  std::fill_n(memory.begin() + 0x1000, 4096, std::byte{0xFF});  // the log sets the NIU window up
  pes.engine().start();
  const auto deadline = Clock::now() + 10'000ms;
  while (std::atomic_ref(head().replayed).load() == 0 && Clock::now() < deadline) {
    pes.engine().check();
    std::this_thread::sleep_for(5ms);
  }
  EXPECT_EQ(head().replayed, 1U);
  const auto& window = *reinterpret_cast<const protocol::NiuWindow*>(memory.data() + 0x1000);
  EXPECT_EQ(window.arrival.kind, protocol::ArrivalKind::message);
  EXPECT_EQ(window.message.bytes, 3U);
  EXPECT_EQ(window.message_bytes[2], std::byte{3});
  EXPECT_EQ(window.columns, 1U);
}

TEST_F(HintLog, AnotherProgramIsFoundOut) {
  BarePes pes(image_of({hint(Hint::clock), hint(Hint::halt)}), 1, {}, with_log(HintLogUse::replay));
  pes.engine().start();
  EXPECT_THAT(failure(pes.engine(), 10'000ms), testing::HasSubstr("PE 0: did not repeat"));
}

TEST(QemuEngine, AnEndlessLoopIsNoticed) {
  MachineDescription machine;
  machine.processor.most_cycles_between_hints = 1'000'000;
  BarePes pes(image_of({kNop, kJumpToSelf}), 1, machine);
  pes.engine().start();
  const auto end = pes.next_command(0);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->head.kind, CommandKind::fault);
  EXPECT_EQ(end->head.time, 1'000'001 + kCommandCycles);  // whenever we looked
  NiuFault fault{};
  ASSERT_EQ(end->payload.size(), sizeof fault);
  std::memcpy(&fault, end->payload.data(), sizeof fault);
  EXPECT_EQ(fault.code, NiuFaultCode::too_long_without_hint);
  EXPECT_EQ(fault.detail[0], 1'000'000U);
  EXPECT_EQ(fault.detail[2], protocol::kLocalMemoryBase + 4);  // the jump
}

TEST(QemuEngine, ATrapToNowhereIsNoticed) {
  BarePes pes(image_of({kNop, 0}), 1);  // illegal, and mtvec is 0
  pes.engine().start();
  const auto end = pes.next_command(0);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->head.kind, CommandKind::fault);
  NiuFault fault{};
  ASSERT_EQ(end->payload.size(), sizeof fault);
  std::memcpy(&fault, end->payload.data(), sizeof fault);
  EXPECT_EQ(fault.code, NiuFaultCode::no_trap_handler);
  EXPECT_EQ(fault.detail[0], kUnknownTrap);
}

TEST(QemuEngine, AKilledProcessIsNamedWithinTwoSeconds) {
  const std::size_t before = children().size();
  BarePes pes(image_of({hint(Hint::receive), kJumpToSelf}), 3);
  pes.engine().start();
  const std::vector<pid_t> processes = children();
  ASSERT_EQ(processes.size(), before + 3);
  pes.engine().check();
  const auto begin = Clock::now();
  ASSERT_EQ(kill(processes[1], SIGKILL), 0);
  EXPECT_THAT(failure(pes.engine(), 2000ms), testing::HasSubstr("PE 1: its QEMU process was killed by signal 9"));
  EXPECT_LT(Clock::now() - begin, 2000ms);
}

TEST(QemuEngine, AStoppedProcessIsNamed) {
  BarePes pes(image_of({hint(Hint::receive), kJumpToSelf}), 2);
  pes.engine().start();
  ASSERT_EQ(kill(children().front(), SIGSTOP), 0);
  EXPECT_THAT(failure(pes.engine(), 2000ms), testing::HasSubstr("PE 0: its QEMU process was stopped by signal 19"));
}

TEST(QemuEngine, LeavesNoProcessBehind) {
  const std::size_t before = children().size();
  {
    BarePes pes(image_of({hint(Hint::receive), kJumpToSelf}), 3);
    pes.engine().start();
    EXPECT_EQ(children().size(), before + 3);
  }
  EXPECT_EQ(children().size(), before);
  {
    BarePes pes(image_of({hint(Hint::receive), kJumpToSelf}), 3);
    pes.engine().start();
    pes.engine().stop();
    EXPECT_EQ(children().size(), before);
    EXPECT_GT(pes.engine().cpu_seconds(), 0);
  }
}

// The emulator itself is killed: its QEMUs must go with it.
TEST(QemuEngine, ProcessesEndWithAKilledEmulator) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t emulator = fork();
  if (emulator == 0) {
    BarePes pes(image_of({hint(Hint::receive), kJumpToSelf}), 2);
    pes.engine().start();
    for (const pid_t child : children()) (void)!write(ends[1], &child, sizeof child);
    for (;;) pause();
  }
  pid_t processes[2] = {};
  ASSERT_EQ(read(ends[0], &processes[0], sizeof(pid_t)), static_cast<ssize_t>(sizeof(pid_t)));
  ASSERT_EQ(read(ends[0], &processes[1], sizeof(pid_t)), static_cast<ssize_t>(sizeof(pid_t)));
  close(ends[0]);
  close(ends[1]);
  std::this_thread::sleep_for(100ms);
  kill(emulator, SIGKILL);
  waitpid(emulator, nullptr, 0);
  for (const pid_t process : processes) {
    // Orphans are reaped by init, or remain as zombies where nothing reaps them: neither runs.
    const auto runs = [process] {
      std::ifstream stream("/proc/" + std::to_string(process) + "/stat");
      std::string text;
      std::getline(stream, text);
      const std::size_t at = text.rfind(')');
      return at != std::string::npos && at + 2 < text.size() && text[at + 2] != 'Z';
    };
    const auto deadline = Clock::now() + 2000ms;
    while (runs() && Clock::now() < deadline) std::this_thread::sleep_for(10ms);
    EXPECT_FALSE(runs()) << process;
  }
}

TEST(EngineRegistry, UnknownNamesAreRefusedWithTheKnownOnes) {
  try {
    engine_named("abacus");
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("qemu"));
  }
}

// QEMU's device tree is 1 MiB, 2 MiB-aligned below the end of its RAM (notes on qemu_plugin); it must not lie in local
// memory, whatever the size.
TEST(MappedBytes, KeepQemusDeviceTreeOutOfLocalMemory) {
  constexpr std::size_t kMiB = 1U << 20U;
  for (std::size_t bytes = protocol::kSmallestLocalMemory; bytes <= protocol::kLargestLocalMemory;
       bytes += 256 * 1024) {
    const std::size_t mapped = mapped_bytes_for(static_cast<std::uint32_t>(bytes));
    EXPECT_GE((mapped - kMiB) / (2 * kMiB) * (2 * kMiB), bytes);
    EXPECT_GE(mapped, 4 * kMiB);
    EXPECT_LE(mapped, bytes + 4 * kMiB);
  }
}

}  // namespace
}  // namespace torolux::test
