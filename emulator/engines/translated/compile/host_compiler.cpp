// SPDX-License-Identifier: MIT
// Runs the compiler.
#include "emulator/engines/translated/compile/host_compiler.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <fstream>
#include <functional>
#include <optional>
#include <sstream>
#include <string_view>
#include <thread>

#include "emulator/errors.hpp"
#include "emulator/exec_pointers.hpp"

namespace torolux::translated {
namespace {

/// No contraction, no errno: the operations are the ones written down. Signalling, flags and traps of the host's
/// floating point are seen by nobody.
constexpr std::array kOptions = {"-std=c++20",
                                 "-O2",
                                 "-fPIC",
                                 "-ffp-contract=off",
                                 "-fno-math-errno",
                                 "-fno-trapping-math",
                                 "-w",
                                 "-fno-rtti",
                                 "-fno-exceptions",
                                 "-fno-plt",
                                 "-fvisibility=hidden",
                                 "-g0",
                                 "-fno-strict-aliasing",
                                 "-fno-tree-vectorize",
                                 "-fno-tree-slp-vectorize"};

/// Only GCC knows these. Registers are saved on many ways out that are never taken: none of that may be made ready on
/// the ways that are. Ranges of values tell nothing that speeds up the code, and cost half of the time to compile a
/// long row of checked loads.
constexpr std::array kOptionsOfGcc = {"-fno-code-hoisting", "-fno-tree-pre", "-fno-tree-vrp"};

std::string contents_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

void write_file(const std::filesystem::path& file, const std::string& text) {
  std::error_code error;
  std::filesystem::create_directories(file.parent_path(), error);
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  if (!stream.flush()) throw MachineFailure("cannot write " + file.string() + ": " + std::strerror(errno));
}

std::optional<std::string> on_path(const std::string& name) {
  const char* path = std::getenv("PATH");  // NOLINT(concurrency-mt-unsafe): nothing here changes it
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string file = folder + "/" + name;
    if (!folder.empty() && access(file.c_str(), X_OK) == 0) return file;
  }
  return std::nullopt;
}

/// A running program; its output goes to a file. It ends, with all that it has started, when it is to stop.
class Process {
 public:
  Process(const std::vector<std::string>& arguments, const std::filesystem::path& output,
          std::function<bool()> stop = {})
      : output_(output), stop_(std::move(stop)) {
    const std::vector<char*> pointers = exec_pointers(arguments);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    if (stop_) posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);  // a group of its own
    // Compilers that are ended leave their own temporary files behind: they are to lie beside the output.
    std::string temporary = "TMPDIR=" + output.parent_path().string();
    std::vector<char*> environment{temporary.data()};
    for (char** entry = environ; *entry != nullptr; ++entry) {
      if (!std::string_view(*entry).starts_with("TMPDIR=")) environment.push_back(*entry);
    }
    environment.push_back(nullptr);
    const int error = posix_spawn(&process_, pointers[0], &actions, &attributes, pointers.data(), environment.data());
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) throw MachineFailure("cannot start " + arguments[0] + ": " + std::strerror(error));
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process() { wait(); }

  bool succeeds() {
    wait();
    return WIFEXITED(status_) && WEXITSTATUS(status_) == 0;
  }
  std::string output() const { return contents_of(output_); }

 private:
  void wait() {
    if (process_ > 0 && stop_) wait_or_stop();
    while (process_ > 0 && waitpid(process_, &status_, 0) < 0 && errno == EINTR) {
    }
    process_ = -1;
  }
  void wait_or_stop() {
    constexpr std::chrono::milliseconds kBetweenLooks{5};
    while (waitpid(process_, &status_, WNOHANG) == 0) {
      if (stop_()) {
        kill(-process_, SIGKILL);
        return;
      }
      std::this_thread::sleep_for(kBetweenLooks);
    }
    process_ = -1;
  }

  std::filesystem::path output_;
  std::function<bool()> stop_;
  pid_t process_ = -1;
  int status_ = 0;
};

[[noreturn]] void fail(const std::string& what, const std::string& output) {
  constexpr std::size_t kMost = 2000;
  throw MachineFailure("translating the firmware: " + what +
                       " failed; --engine interpreted works without it, but is slow.\n" + output.substr(0, kMost));
}

/// What the compiler may use of this computer's processor.
std::string machine_option() {
#if defined(__x86_64__)
  // What x86-64-v3 has; clang does not know that name here. The rest of it came with these.
  const bool v3 = __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("bmi") != 0 &&
                  __builtin_cpu_supports("bmi2") != 0 && __builtin_cpu_supports("fma") != 0;
  // What x86-64-v4 has: above all 32 registers for floating point, as many as RISC-V.
  const bool v4 = v3 && __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512bw") != 0 &&
                  __builtin_cpu_supports("avx512cd") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
                  __builtin_cpu_supports("avx512vl") != 0;
  return v4 ? "-march=x86-64-v4" : v3 ? "-march=x86-64-v3" : "-march=x86-64";
#else
  return "-O2";
#endif
}

}  // namespace

HostCompiler::HostCompiler() {
  for (const char* name : {"g++", "clang++", "c++"}) {
    if (const auto found = on_path(name)) {
      program_ = *found;
      break;
    }
  }
  if (program_.empty()) {
    throw MachineFailure(
        "no C++ compiler on PATH (g++ or clang++): the translated engine needs one; --engine interpreted does without, "
        "but is slow");
  }
  std::string name = (std::filesystem::temp_directory_path() / "torolux-compiler-XXXXXX").string();
  const int descriptor = mkstemp(name.data());
  if (descriptor < 0) throw MachineFailure("cannot write to " + name + ": " + std::strerror(errno));
  close(descriptor);
  Process process({program_, "--version"}, name);
  const bool works = process.succeeds();
  identity_ = process.output();
  std::error_code ignored;
  std::filesystem::remove(name, ignored);
  if (!works) fail(program_ + " --version", identity_);
  is_gcc_ = identity_.find("Free Software Foundation") != std::string::npos;
  for (const std::string& word : command({})) identity_ += word + "\n";
}

std::vector<std::string> HostCompiler::command(const std::filesystem::path& folder) const {
  std::vector<std::string> arguments = {program_};
  arguments.insert(arguments.end(), kOptions.begin(), kOptions.end());
  if (is_gcc_) arguments.insert(arguments.end(), kOptionsOfGcc.begin(), kOptionsOfGcc.end());
  arguments.push_back(machine_option());
  if (!folder.empty()) arguments.push_back("-I" + folder.string());
  return arguments;
}

std::filesystem::path HostCompiler::build(std::span<const SourceText> headers, std::span<const SourceText> units,
                                          const std::filesystem::path& folder,
                                          const std::function<bool()>& stop) const {
  for (const SourceText& header : headers) write_file(folder / header.name, header.text);
  const std::size_t most = std::max(1U, std::thread::hardware_concurrency());
  std::filesystem::path result = folder / "translated.so";
  std::vector<std::string> link = command(folder);
  link.insert(link.end(), {"-shared", "-o", result.string()});
  std::deque<Process> running;
  const auto finish_first = [&] {
    if (!running.front().succeeds()) fail("the compiler", running.front().output());
    running.pop_front();
  };
  for (const SourceText& unit : units) {
    const std::filesystem::path source = folder / unit.name;
    const std::string object = source.string() + ".o";
    write_file(source, unit.text);
    if (running.size() == most) finish_first();
    if (stop && stop()) throw MachineFailure("translating the firmware was stopped");
    std::vector<std::string> compile = command(folder);
    compile.insert(compile.end(), {"-c", source.string(), "-o", object});
    running.emplace_back(compile, source.string() + ".log", stop);
    link.push_back(object);
  }
  while (!running.empty()) finish_first();
  link.emplace_back("-lm");
  Process linker(link, folder / "link.log", stop);
  if (!linker.succeeds()) fail("the linker", linker.output());
  return result;
}

}  // namespace torolux::translated
