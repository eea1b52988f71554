// SPDX-License-Identifier: MIT
// Proves: what other options and other compilers make of a program runs, with the same output and cycles on every
// engine; or is refused with a reason.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host_tools/files/shell_line.hpp"
#include "tests/kit/shell.hpp"

namespace torolux::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class OtherCompilers : public testing::Test {
 protected:
  /// tests/kit/sources, as a word of a shell's.
  static std::string source(const std::string& name) {
    return shell_line({std::string(TOROLUX_SOURCE_DIR) + "/tests/kit/sources/" + name});
  }
  /// Of clang, for an object that the kit's are linked to.
  std::string clang(const std::string& architecture, const std::string& words) const {
    return "kit=$(torolux cc --kit); clang-14 --target=riscv32-unknown-elf " + architecture +
           " -O2 -ffp-contract=off -nostdlibinc -isystem $kit/include -isystem $kit/libc/include " + words;
  }

  UserFolder folder;
};

constexpr const char* kRing = "from 0: 0 0.33333\nfrom 1: 10 0.25000\nfrom 2: 20 0.20000\n";

constexpr const char* kHeaders = "308 41 53 'words 42' -1.414214 1.259921 1.394e+01\n";

class EachWayToCompile : public OtherCompilers, public testing::WithParamInterface<const char*> {};

TEST_P(EachWayToCompile, LeavesTheStandardLibrarysResultsTheSame) {
  folder.succeed("torolux cc " + std::string(GetParam()) + " " + source("standard_headers.cpp") + " -o headers.elf");
  EXPECT_EQ(texts_of(said_on_all_engines(folder, "headers.elf", "--pes 1x1")), kHeaders);
}
INSTANTIATE_TEST_SUITE_P(Options, EachWayToCompile,
                         testing::Values("", "-Os", "-O3 -flto", "-Os -msave-restore", "-march=rv32imaf"),
                         [](const auto& one) { return "Way" + std::to_string(one.index); });

TEST_F(OtherCompilers, CodeThatIsNotOptimisedIsTheSameProgram) {
  folder.succeed("torolux cc -O0 " + source("standard_headers.cpp") + " -o headers.elf");
  EXPECT_EQ(texts_of(folder.succeed("torolux run headers.elf --pes 1x1 --quiet --engine interpreted")), kHeaders);
}

TEST_F(OtherCompilers, AssemblerStandsOnTheConstantsOfToroluxH) {
  folder.succeed("torolux cc -nostdlib " + source("own_start.S") + " -o own.elf -T $(torolux cc --kit)/pe.ld");
  EXPECT_EQ(texts_of(said_on_all_engines(folder, "own.elf", "--pes 2x1")), "answer: ?\nanswer: ?\n");
}

TEST_F(OtherCompilers, AnObjectOfClangIsLinkedToTheKit) {
  folder.succeed(clang("-march=rv32imafc -mabi=ilp32f", "-c " + source("ring.c") + " -o ring.o"));
  folder.succeed("torolux cc ring.o -o clang.elf && torolux cc " + source("ring.c") + " -o gcc.elf");
  EXPECT_EQ(texts_of(said_on_all_engines(folder, "clang.elf", "--pes 3x1")), kRing);
  EXPECT_EQ(texts_of(said_on_all_engines(folder, "gcc.elf", "--pes 3x1")), kRing);
}

TEST_F(OtherCompilers, WithoutFloatingPointItNeedsAStartOfItsOwn) {
  folder.succeed(clang("-march=rv32imac -mabi=ilp32", "-c " + source("answer.c") + " -o answer.o"));
  const std::string own = "torolux cc -march=rv32imac -mabi=ilp32 -nostdlib -DOWN_START_CALLS ";
  folder.succeed(own + source("own_start.S") + " answer.o -o soft.elf -T $(torolux cc --kit)/pe.ld");
  EXPECT_EQ(texts_of(said_on_all_engines(folder, "soft.elf", "--pes 1x1")), "answer: 4\n");
  folder.succeed(clang("-march=rv32imac -mabi=ilp32", "-c " + source("ring.c") + " -o ring.o"));
  const Said mixed = folder.run("torolux cc ring.o");
  EXPECT_EQ(mixed.exit_code, 2);
  EXPECT_THAT(mixed.errors, AllOf(HasSubstr("soft-float"), HasSubstr("torolux: objects of different ABIs")));
}

TEST_F(OtherCompilers, ALargeImageRunsWhereTheMemoryIsLargeEnough) {
  folder.write("large.c",
               "#include <stdio.h>\n#include <torolux.h>\nstatic float large[100000];\n"
               "static const int table[80000] = {1, 2, 3};\n"
               "int main(void) {\n  for (int i = 0; i < 100000; ++i) large[i] = (float)table[i % 3];\n"
               "  printf(\"%.0f of %u KiB\\n\", (double)large[99999], (unsigned)(torolux_memory_bytes() >> 10));\n}\n");
  folder.succeed("torolux cc large.c -o large.elf");
  EXPECT_EQ(texts_of(said_on_all_engines(folder, "large.elf", "--pes 1x1 --pe-memory 2M")), "1 of 2048 KiB\n");
  const Said small = folder.run("torolux run large.elf --pes 1x1 --pe-memory 512K");
  EXPECT_EQ(small.exit_code, 2);
  EXPECT_THAT(small.errors, HasSubstr("large.elf"));
}

TEST_F(OtherCompilers, WhatIsNotOnAPeIsRefusedWithTheReason) {
  const auto advice = [&](const std::string& source_text) {
    folder.write("refused.cpp", source_text);
    const Said said = folder.run("torolux cc refused.cpp -o refused.elf");
    EXPECT_EQ(said.exit_code, 2) << source_text;
    const std::size_t own = said.errors.find("torolux: ");
    return own == std::string::npos ? said.errors : said.errors.substr(own);
  };
  EXPECT_THAT(advice("#include <iostream>\nint main() { std::cout << 1; }\n"), HasSubstr("use printf"));
  EXPECT_THAT(advice("#include <chrono>\nint main() { return "
                     "std::chrono::system_clock::now().time_since_epoch().count() > 0; }\n"),
              HasSubstr("torolux_clock"));
  EXPECT_THAT(advice("#include <random>\nint main() { return std::random_device()() > 3; }\n"),
              HasSubstr("with a seed"));
  EXPECT_THAT(advice("struct A { virtual ~A() = default; };\nstruct B : A {};\n"
                     "int main() { A* a = new B; return dynamic_cast<B*>(a) != nullptr; }\n"),
              HasSubstr("-fno-rtti"));
}

}  // namespace
}  // namespace torolux::test
