// SPDX-License-Identifier: MIT
// fork, exec, wait; output into memory files.
#include "tests/machine/process.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <iterator>
#include <thread>

namespace torolux::test {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono_literals::operator""ms;

std::filesystem::path torolux_file() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / "torolux";
}

std::string contents_of(int descriptor) {
  struct stat status {};
  fstat(descriptor, &status);
  std::string text(static_cast<std::size_t>(status.st_size), '\0');
  const ssize_t bytes = pread(descriptor, text.data(), text.size(), 0);
  text.resize(bytes > 0 ? static_cast<std::size_t>(bytes) : 0);
  return text;
}

/// Whether it does something of its own about this signal.
bool catches(pid_t process, int number) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  const std::string name = "SigCgt:";
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(name)) return (std::stoull(line.substr(name.size()), nullptr, 16) >> (number - 1) & 1U) != 0;
  }
  return false;
}

}  // namespace

ToroluxProcess::ToroluxProcess(const std::vector<std::string>& arguments)
    : output_(memfd_create("output", MFD_CLOEXEC)), errors_(memfd_create("errors", MFD_CLOEXEC)), begin_(Clock::now()) {
  std::vector<std::string> words = {torolux_file().string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  process_ = fork();
  if (process_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    dup2(output_, STDOUT_FILENO);
    dup2(errors_, STDERR_FILENO);
    execv(pointers[0], pointers.data());
    _exit(127);
  }
}

ToroluxProcess::~ToroluxProcess() {
  if (process_ > 0) {
    ::kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  close(output_);
  close(errors_);
}

void ToroluxProcess::signal(int number) const {
  const auto deadline = Clock::now() + 60'000ms;
  while (number == SIGINT && runs(process_) && !catches(process_, number) && Clock::now() < deadline) {
    std::this_thread::sleep_for(1ms);
  }
  ::kill(process_, number);
}

std::vector<pid_t> ToroluxProcess::children(std::size_t count) const {
  const auto deadline = Clock::now() + 10'000ms;
  std::vector<pid_t> found;
  while (found.size() < count && Clock::now() < deadline) {
    std::this_thread::sleep_for(5ms);
    found.clear();
    std::error_code error;
    for (const auto& task : std::filesystem::directory_iterator("/proc/" + std::to_string(process_) + "/task", error)) {
      std::ifstream stream(task.path() / "children");
      for (pid_t child = 0; stream >> child;) found.push_back(child);
    }
  }
  return found;
}

std::string ToroluxProcess::errors_so_far() const {
  return contents_of(errors_);
}

Finished ToroluxProcess::wait() {
  int status = 0;
  waitpid(process_, &status, 0);
  process_ = -1;
  const double seconds = std::chrono::duration<double>(Clock::now() - begin_).count();
  const int code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  return {code, contents_of(output_), contents_of(errors_), seconds};
}

Finished run_torolux(const std::vector<std::string>& arguments) {
  return ToroluxProcess(arguments).wait();
}

std::vector<std::string> small_render_options() {
  return {"--pes",
          "2x2",
          "--subspaces",
          "4x4x4",
          "--size",
          "16x12",
          "--samples",
          "1",
          "--hemicube",
          "4",
          "--max-shots",
          "6",
          "--emission-records",
          "20000",
          "--shot-points",
          "1"};
}

bool runs(pid_t process) {
  std::ifstream stream("/proc/" + std::to_string(process) + "/stat");
  std::string text;
  std::getline(stream, text);
  const std::size_t at = text.rfind(')');
  return at != std::string::npos && at + 2 < text.size() && text[at + 2] != 'Z' && text[at + 2] != 'X';
}

bool all_gone(const std::vector<pid_t>& processes) {
  const auto deadline = Clock::now() + 30'000ms;
  while (std::any_of(processes.begin(), processes.end(), runs)) {
    if (Clock::now() > deadline) return false;
    std::this_thread::sleep_for(5ms);
  }
  return true;
}

std::string contents(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  EXPECT_TRUE(stream) << file;
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

nlohmann::json statistics(const std::filesystem::path& file) {
  nlohmann::json json = nlohmann::json::parse(contents(file));
  json.erase("engine");
  for (const char* key : {"engine", "qemu_pes"}) json["settings"].erase(key);
  json.erase("command_line");
  json.erase("wall_seconds");
  json.erase("host");
  return json;
}

}  // namespace torolux::test
