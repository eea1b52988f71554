// SPDX-License-Identifier: MIT
// Proves: projects of one's own find an installed Torolux, wherever it has been moved to: by CMake (Ninja and make),
// and by the rules for make. What has changed is made anew, and nothing else. Handlers are tested natively.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host_tools/files/shell_line.hpp"
#include "tests/kit/shell.hpp"

namespace torolux::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// `cmake --install`, then moved: installed once for all of these tests.
class OwnProject : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    place_ = new testing_support::TemporaryFolder();
    const UserFolder folder;
    const std::string first = (place_->path() / "first").string(), moved = prefix().string();
    folder.succeed(shell_line({"cmake", "--install", TOROLUX_BUILD_DIR, "--prefix", first}) + " >/dev/null && " +
                   shell_line({"mv", first, moved}));
  }
  static void TearDownTestSuite() {
    delete place_;
    place_ = nullptr;
  }
  static std::filesystem::path prefix() { return place_->path() / "moved here"; }

  OwnProject() : folder(prefix() / "bin") {
    folder.write("number.hpp", "#define NUMBER 3\n");
    folder.write("main.cpp", R"(
#include "firmware/boot/boot.hpp"
#include "firmware/examples/text.hpp"
#include "number.hpp"
extern "C" int more(int number);
void torolux::pe::pe_main(Niu& niu) { (examples::Text() << "number " << more(NUMBER)).send(niu); }
)");
    folder.write("part/more.c", "int more(int number) { return number + ONE; }\n");
  }

  UserFolder folder;

 private:
  static testing_support::TemporaryFolder* place_;
};
testing_support::TemporaryFolder* OwnProject::place_ = nullptr;

constexpr const char* kProject = R"(
cmake_minimum_required(VERSION 3.20)
project(own LANGUAGES CXX)
find_package(Torolux 0.1 REQUIRED)
enable_testing()
torolux_image(own SOURCES main.cpp part/more.c OPTIONS -DONE=1 -Os)
torolux_run(run_own own --pes 2x1 --quiet)
add_test(NAME own_runs COMMAND Torolux::torolux run $<TARGET_PROPERTY:own,TOROLUX_IMAGE> --pes 1x1 --quiet)
set_tests_properties(own_runs PROPERTIES PASS_REGULAR_EXPRESSION "number [45]")
)";

class OwnCMakeProject : public OwnProject, public testing::WithParamInterface<const char*> {};

TEST_P(OwnCMakeProject, IsBuiltAndRunAndTested) {
  folder.write("CMakeLists.txt", kProject);
  // Found by PATH alone, which has the prefix's bin.
  folder.succeed(std::string("cmake -G '") + GetParam() + "' -S . -B build && cmake --build build");
  EXPECT_EQ(texts_of(folder.succeed("torolux run build/own.elf --pes 1x1 --quiet")), "number 4\n");
  EXPECT_THAT(folder.succeed("cmake --build build --target run_own"), HasSubstr("number 4"));
  folder.succeed("ctest --test-dir build --no-tests=error");
  EXPECT_THAT(folder.succeed("cmake --build build"), Not(HasSubstr("torolux cc")));
  folder.write("number.hpp", "#define NUMBER 4\n");
  EXPECT_THAT(folder.succeed("cmake --build build"),
              AllOf(HasSubstr("torolux cc main.cpp"), Not(HasSubstr("torolux cc more.c"))));
  EXPECT_EQ(texts_of(folder.succeed("torolux run build/own.elf --pes 1x1 --quiet")), "number 5\n");
}
INSTANTIATE_TEST_SUITE_P(Generators, OwnCMakeProject, testing::Values("Ninja", "Unix Makefiles"),
                         [](const auto& one) { return std::string(one.param).substr(0, 4); });

TEST_F(OwnProject, FindsThePackageByItsRootAndInTheBuild) {
  folder.write("CMakeLists.txt", kProject);
  const std::string away = "export PATH=/usr/bin:/bin; ";
  EXPECT_NE(folder.run(away + "cmake -S . -B none").exit_code, 0);
  folder.succeed(away + "cmake -S . -B one -DTorolux_ROOT=" + shell_line({prefix().string()}));
  folder.succeed(away + "cmake -S . -B two -DCMAKE_PREFIX_PATH=" + shell_line({TOROLUX_BUILD_DIR}));
  folder.succeed("rm main.cpp; ! cmake --build two");
}

TEST_F(OwnProject, TestsItsHandlersNatively) {
  folder.write("CMakeLists.txt", R"(
cmake_minimum_required(VERSION 3.20)
project(own LANGUAGES CXX)
find_package(Torolux REQUIRED)
enable_testing()
add_executable(handlers_test main.cpp handlers_test.cpp)
target_link_libraries(handlers_test PRIVATE Torolux::native)
add_test(NAME handlers COMMAND handlers_test)
)");
  // The image's own source, but for the part in C.
  folder.write("handlers_test.cpp", R"(
#include "firmware/boot/boot.hpp"
#include "firmware/niu/native/fake_torus.hpp"
extern "C" int more(int number) { return 10 * number; }
int main() {
  torolux::native::FakeTorus torus(2, 2);
  torus.run([](torolux::native::FakeNode& node) { torolux::pe::pe_main(node.niu()); });
  if (torus.sent().size() != 4) return 1;
  for (const auto& message : torus.sent()) {
    if (message.text() != "number 30") return 2;
  }
}
)");
  folder.succeed("cmake -S . -B build && cmake --build build && ctest --test-dir build --no-tests=error");
}

TEST_F(OwnProject, IsBuiltByMakeWithTheRulesOfTheKit) {
  // make takes no blanks in names of files: a prefix without.
  folder.succeed(shell_line({"cp", "-r", prefix().string(), "torolux"}));
  folder.write("Makefile",
               "TOROLUX = torolux/bin/torolux\ninclude $(shell $(TOROLUX) cc --makefile)\n"
               "CPPFLAGS = -DONE=1\nall: own.elf single.elf named.elf\n"
               "own.elf: main.o part/more.o\nnamed.elf: named.o part.o\n");
  folder.write("part.c", "int number(void) { return 1; }\n");
  folder.write("named.c", "int number(void);\nint main(void) { return number() - 1; }\n");
  folder.write("single.cpp", "#include \"firmware/boot/boot.hpp\"\nvoid torolux::pe::pe_main(Niu&) {}\n");
  folder.succeed("make");
  EXPECT_EQ(texts_of(folder.succeed("torolux run own.elf --pes 1x1 --quiet")), "number 4\n");
  folder.succeed("torolux run single.elf --pes 1x1 --quiet");
  folder.succeed("torolux run named.elf --pes 1x1 --quiet");  // of an object whose source has the image's name
  EXPECT_THAT(folder.succeed("make"), HasSubstr("Nothing to be done"));
  folder.write("number.hpp", "#define NUMBER 4\n");
  EXPECT_THAT(folder.succeed("make"), AllOf(HasSubstr("main.o"), Not(HasSubstr("more.c")), Not(HasSubstr("single"))));
  EXPECT_EQ(texts_of(folder.succeed("torolux run own.elf --pes 1x1 --quiet")), "number 5\n");
  EXPECT_THAT(folder.succeed("touch torolux/share/torolux/kit/torolux.specs && make"), HasSubstr("more.c"));
}

TEST_F(OwnProject, FindsNoPathOfTheBuildMachineInTheKit) {
  const std::string kit = folder.succeed("torolux cc --kit");
  EXPECT_THAT(kit, HasSubstr("moved here"));
  folder.succeed("! grep -rlF -e " + shell_line({TOROLUX_SOURCE_DIR}) + " -e /tmp/torolux-sysroot " +
                 shell_line({(prefix() / "share/torolux/kit").string()}));
}

}  // namespace
}  // namespace torolux::test
