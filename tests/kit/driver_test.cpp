// SPDX-License-Identifier: MIT
// Proves: `torolux cc` is a compiler's driver. From an empty folder it makes images that run alike on every engine, all
// of GCC's options do what they do, and what goes wrong is said with what to do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "tests/kit/shell.hpp"

namespace torolux::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

constexpr std::string_view kHello = R"(
#include "firmware/boot/boot.hpp"
#include "firmware/examples/text.hpp"
extern "C" int twice(int number);
extern "C" int thrice(int number);
void torolux::pe::pe_main(Niu& niu) {
  examples::Text line;
  line << "six is " << twice(3) << ", nine is " << thrice(3);
  line.send(niu);
}
)";
constexpr std::string_view kTwice = "int twice(int number) { return 2 * number; }\n";
constexpr std::string_view kThrice =
    ".globl thrice\nthrice:\n#ifdef __riscv\n  slli a1, a0, 1\n  add a0, a0, a1\n#endif\n  ret\n";

TEST(TheCompilersDriver, MakesAnImageOfCAndCplusplusAndAssemblerInOneCall) {
  const UserFolder folder;
  folder.write("hello.cpp", kHello);
  folder.write("twice.c", kTwice);
  folder.write("thrice.S", kThrice);
  EXPECT_THAT(folder.succeed("torolux cc hello.cpp twice.c thrice.S -o hello.elf"), IsEmpty());
  EXPECT_EQ(texts_of(said_on_all_engines(folder, "hello.elf", "--pes 2x1")),
            "six is 6, nine is 9\nsix is 6, nine is 9\n");
}

TEST(TheCompilersDriver, NamesTheImageAElfWhereNobodyDoes) {
  const UserFolder folder;
  folder.write("hello.cpp", kHello);
  folder.write("twice.c", kTwice);
  folder.write("thrice.S", kThrice);
  folder.succeed("torolux cc *.cpp *.c *.S && test -f a.elf && test ! -e a.out");
  folder.succeed("rm a.elf; torolux cc -c twice.c && test -f twice.o && test ! -e a.elf");
}

TEST(TheCompilersDriver, TakesObjectsAndArchivesAndLinkTimeOptimisation) {
  const UserFolder folder;
  folder.write("hello.cpp", kHello);
  folder.write("twice.c", kTwice);
  folder.write("thrice.S", kThrice);
  folder.succeed(
      "torolux cc -flto -O3 -c hello.cpp twice.c && torolux cc -c thrice.S && "
      "riscv64-unknown-elf-gcc-ar rcs libnumbers.a twice.o thrice.o && "
      "torolux cc -flto -O3 hello.o -L. -lnumbers -o lto.elf");
  EXPECT_EQ(texts_of(folder.succeed("torolux run lto.elf --pes 1x1 --quiet")), "six is 6, nine is 9\n");
}

TEST(TheCompilersDriver, LeavesGccsOptionsWhatTheyAre) {
  const UserFolder folder;
  folder.write("inc/name.h", "#define NUMBER 7\n");
  folder.write("main.c", "#include \"name.h\"\nint number = NUMBER + MORE;\n");
  EXPECT_THAT(folder.succeed("torolux cc -Iinc -D MORE=2 -E main.c"), HasSubstr("int number = 7 + 2;"));
  EXPECT_THAT(folder.succeed("torolux cc -Iinc -DMORE=2 -S main.c -o -"), HasSubstr(".globl\tnumber"));
  folder.succeed("torolux cc -Iinc -DMORE=2 -MD -MF main.d -MT goal -c main.c -o there.o");
  EXPECT_THAT(folder.succeed("cat main.d"), AllOf(StartsWith("goal:"), HasSubstr("inc/name.h")));
  EXPECT_THAT(folder.succeed("torolux cc -dumpmachine"), HasSubstr("riscv64-unknown-elf"));
  EXPECT_THAT(folder.succeed("echo 'int x = __OPTIMIZE__;' | torolux cc -x c -E -"), HasSubstr("int x = 1;"));
  EXPECT_THAT(folder.succeed("echo 'long v = __cplusplus;' | torolux cc -x c++ -E -"), HasSubstr("long v = 202002L;"));
  EXPECT_THAT(folder.succeed("echo 'long v = __cplusplus;' | torolux cc -std=c++17 -x c++ -E -"),
              HasSubstr("long v = 201703L;"));
  EXPECT_THAT(folder.succeed("echo 'long v = __STDC_VERSION__;' | torolux cc -x c -E -"), HasSubstr("201710L"));
  EXPECT_THAT(folder.succeed("torolux cc -Xlinker --print -Xlinker --version -### -c main.c 2>&1"), HasSubstr("cc1"));
  EXPECT_EQ(
      folder.succeed(
          "torolux cc -O0 -Q --help=optimizers -x c /dev/null -c | grep -c 'finline-functions .*enabled' || true"),
      "0\n");
}

TEST(TheCompilersDriver, WorksAsMakesCompiler) {
  const UserFolder folder;
  folder.write("hello.cpp", kHello);
  folder.write("twice.c", kTwice);
  folder.write("thrice.S", kThrice);
  // make's own rules; the first object names the program.
  folder.succeed("make -s CC='torolux cc' hello.o CXX='torolux cc' twice.o thrice.o");
  folder.succeed(
      "make -s CC='torolux cc' hello: && test -f hello || make -s CC='torolux cc' LDLIBS='twice.o thrice.o' hello");
  EXPECT_EQ(texts_of(folder.succeed("torolux run hello --pes 1x1 --quiet")), "six is 6, nine is 9\n");
}

TEST(TheCompilersDriver, ShowsItsCommandForAShellAndRunsNothing) {
  const UserFolder folder;
  folder.write("a name.cpp", kHello);
  folder.write("twice.c", kTwice);
  folder.write("thrice.S", kThrice);
  const std::string line = folder.succeed("torolux cc --print 'a name.cpp' twice.c thrice.S -o shown.elf");
  EXPECT_THAT(line, AllOf(StartsWith("riscv64-unknown-elf-gcc "), HasSubstr("'a name.cpp'"), HasSubstr(" -O2 -g ")));
  folder.succeed("test ! -e shown.elf");
  folder.succeed(line);
  // Names of temporary objects are in its symbol table alone.
  folder.succeed(
      "torolux cc 'a name.cpp' twice.c thrice.S -o made.elf && "
      "for one in shown made; do riscv64-unknown-elf-objcopy -O binary $one.elf $one.bin; done && cmp made.bin "
      "shown.bin");
}

TEST(TheCompilersDriver, GivesTheStackTheSizeThatIsAskedFor) {
  const UserFolder folder;
  folder.write("deep.cpp",
               "#include \"firmware/boot/boot.hpp\"\n"
               "void torolux::pe::pe_main(Niu&) {\n"
               "  volatile char deep[30000];\n"
               "  for (volatile char& c : deep) c = 1;\n"
               "}\n");
  EXPECT_THAT(folder.succeed("torolux cc deep.cpp -o deep.elf --stack 32K --regions"),
              testing::ContainsRegex("stack +0x[0-9a-f]+ +32768"));
  folder.succeed("torolux run deep.elf --pes 1x1 --quiet");
  folder.succeed("torolux cc deep.cpp -o deep.elf");
  EXPECT_THAT(folder.run("torolux run deep.elf --pes 1x1 --quiet").errors, HasSubstr("trap: store"));
  EXPECT_EQ(folder.run("torolux cc deep.cpp --stack 5000").exit_code, 2);
  EXPECT_EQ(folder.run("torolux cc deep.cpp --stack").exit_code, 1);
  EXPECT_EQ(folder.run("torolux cc deep.cpp --stack much").exit_code, 1);
}

TEST(TheCompilersDriver, EndsWithOneForUsageAndTwoForWhatTheCompilerRefuses) {
  const UserFolder folder;
  folder.write("bad.c", "int x(\n");
  const Said nothing = folder.run("torolux cc");
  EXPECT_EQ(nothing.exit_code, 1);
  EXPECT_THAT(nothing.errors, HasSubstr("torolux cc SOURCES... -o IMAGE.elf"));
  const Said bad = folder.run("torolux cc bad.c");
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_THAT(bad.errors, AllOf(StartsWith("bad.c:1:1: error:"), Not(HasSubstr("torolux:"))));
  const Said alone = folder.run("torolux=$(command -v torolux); PATH=/nowhere; $torolux cc bad.c");
  EXPECT_EQ(alone.exit_code, 2);
  EXPECT_THAT(alone.errors, HasSubstr("apt-get install gcc-riscv64-unknown-elf"));
}

/// A link that fails, and what is said behind the linker's own words.
std::string said_of_link(const UserFolder& folder, const std::string& words) {
  const Said said = folder.run("torolux cc " + words);
  EXPECT_EQ(said.exit_code, 2) << words;
  const std::size_t own = said.errors.find("torolux: ");
  EXPECT_NE(own, std::string::npos) << said.errors;
  return said.errors.substr(std::min(own, said.errors.size()));
}

TEST(TheCompilersDriver, SaysWhatALinkersErrorsMean) {
  const UserFolder folder;
  folder.write("empty.c", "int nothing;\n");
  EXPECT_THAT(said_of_link(folder, "empty.c"), HasSubstr("the image has no beginning: define `int main(void)`"));
  folder.write(
      "throws.cpp",
      "#include \"firmware/boot/boot.hpp\"\nvoid torolux::pe::pe_main(Niu& niu) { if (niu.pe() > 5) throw 1; }\n");
  EXPECT_THAT(folder.run("torolux cc throws.cpp").errors, HasSubstr("exception handling disabled"));
  EXPECT_THAT(said_of_link(folder, "-fexceptions throws.cpp"), HasSubstr("there are no exceptions on a PE"));
  folder.write("pe.cpp",
               "#include \"firmware/boot/boot.hpp\"\nextern \"C\" int other();\n"
               "void torolux::pe::pe_main(Niu&) { other(); }\n");
  folder.write("other.c", "int other(void) { return 1; }\n");
  folder.succeed("torolux cc -c pe.cpp && torolux cc -march=rv32imac -mabi=ilp32 -c other.c");
  EXPECT_THAT(said_of_link(folder, "pe.o other.o"), HasSubstr("The kit's is ilp32f"));
  folder.succeed("riscv64-unknown-elf-gcc -c other.c");
  EXPECT_THAT(said_of_link(folder, "pe.o other.o"), HasSubstr("objects of different ABIs"));
  folder.write("large.cpp",
               "#include \"firmware/boot/boot.hpp\"\nchar large[70 << 20];\n"
               "void torolux::pe::pe_main(Niu& niu) { large[niu.pe()] = 1; }\n");
  EXPECT_THAT(said_of_link(folder, "large.cpp"), testing::ContainsRegex("the image is [0-9]+ bytes larger than"));
  folder.write("made.cpp",
               "#include \"firmware/boot/boot.hpp\"\nint first();\nint made = first();\n"
               "int first() { return 2; }\nvolatile int n = 1;\nstruct Made { Made() { n = 5; } } object;\n"
               "void torolux::pe::pe_main(Niu&) {}\n");
  EXPECT_THAT(said_of_link(folder, "made.cpp"), HasSubstr("a pe_main of its own runs no constructors"));
  folder.write("thread.c", "_Thread_local int of_thread = 5;\nint main(void) { return of_thread; }\n");
  EXPECT_THAT(said_of_link(folder, "thread.c"), HasSubstr("a PE has one thread"));
  folder.write("threads.cpp",
               "struct Made { ~Made() {} int n; };\nint main() { thread_local Made made{1}; return made.n; }\n");
  EXPECT_THAT(said_of_link(folder, "threads.cpp"), HasSubstr("a PE has one thread"));
  folder.write("stream.cpp", "#include <fstream>\nint main() { std::ifstream in(\"a\"); return in.get(); }\n");
  EXPECT_THAT(said_of_link(folder, "stream.cpp"), HasSubstr("streams and locales are not in the kit"));
}

}  // namespace
}  // namespace torolux::test
