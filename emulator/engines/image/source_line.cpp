// SPDX-License-Identifier: MIT
// Runs addr2line, and reads what it says.
#include "emulator/engines/image/source_line.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <sstream>

#include "emulator/hexadecimal.hpp"

namespace torolux {
namespace {

constexpr const char* kProgram = "riscv64-unknown-elf-addr2line";
/// Of what it says [bytes]; more has no place in a message.
constexpr std::size_t kMostAnswer = 16384;

/// Its standard output; "" where it cannot be run or fails.
std::string answer_of(const std::filesystem::path& image, std::uint32_t address) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) return "";
  std::array<std::string, 5> words = {kProgram, "-i", "-e", image.string(), hexadecimal(address)};
  std::array<char*, 6> arguments{};
  for (std::size_t i = 0; i < words.size(); ++i) arguments[i] = words[i].data();
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  pid_t process = -1;
  const bool started = posix_spawnp(&process, kProgram, &actions, nullptr, arguments.data(), environ) == 0;
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  std::string answer;
  std::array<char, 1024> part{};
  while (started && answer.size() < kMostAnswer) {
    const ssize_t bytes = read(ends[0], part.data(), part.size());
    if (bytes < 0 && errno == EINTR) continue;
    if (bytes <= 0) break;
    answer.append(part.data(), static_cast<std::size_t>(bytes));
  }
  close(ends[0]);
  int status = -1;
  while (started && waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? answer : "";
}

}  // namespace

std::string source_line(const std::filesystem::path& image, std::uint32_t address) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(image, error)) return "";
  std::istringstream lines(answer_of(image, address));
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("??") || line.ends_with(":?") || line.ends_with(":0")) break;
    // Compilers name sources from the folder in which they ran.
    const std::filesystem::path place(line.substr(0, line.find(" (discriminator")));
    text += (text.empty() ? "" : ", inlined at ") + place.lexically_normal().string();
  }
  return text;
}

}  // namespace torolux
