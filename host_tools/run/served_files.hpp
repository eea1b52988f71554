// SPDX-License-Identifier: MIT
// Files that PEs open by names which the user has given. Enters: requests of PEs, checked here; leaves: answers, bytes,
// and the user's output files, which are there once the run has ended well.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "emulator/host/host_program.hpp"
#include "firmware/protocol/host_services.hpp"
#include "host_tools/files/digest.hpp"
#include "host_tools/files/write_file.hpp"

namespace torolux {

/// --input NAME=FILE or --output NAME=FILE.
struct GivenFile {
  std::string name;  ///< by which programs open it, 1..kMostFileName bytes
  std::filesystem::path file;
};

/// An input with what it holds: read once, as it may be a pipe.
struct Input {
  GivenFile given;
  std::vector<std::byte> contents;
};
/// Of one input [bytes].
inline constexpr std::size_t kMostInputBytes = std::size_t{1} << 30U;
/// Throws InputError.
std::vector<Input> read_inputs(const std::vector<GivenFile>& files);
/// For the run's settings.
std::vector<InputFile> digests_of(const std::vector<Input>& inputs);

class ServedFiles {
 public:
  /// The output that takes what PEs send to TOROLUX_HOST.
  static constexpr const char* kHostFile = "host";

  /// Opens the outputs under other names. Throws InputError.
  ServedFiles(std::vector<Input> inputs, const std::vector<GivenFile>& outputs);

  /// Programs have no files.
  bool are_none() const { return inputs_.empty() && outputs_.empty(); }
  /// Requests of a PE. A request that no program of the kit makes throws MachineFailure.
  protocol::FileAnswer open(PeNumber pe, std::uint32_t access, const std::string& name);
  /// Valid until the next call.
  std::span<const std::byte> read(PeNumber pe, const protocol::FileRead& request);
  void write(PeNumber pe, std::uint32_t file, std::span<const std::byte> bytes);
  protocol::FileAnswer seek(PeNumber pe, const protocol::FileSeek& request);
  void close(PeNumber pe, std::uint32_t file);
  void append_to_host_file(PeNumber pe, std::span<const std::byte> bytes);

  /// The outputs get their names. Returns those that no program has opened: their files stay as they were. Throws
  /// InputError.
  std::vector<std::string> finish();

 private:
  struct Output {
    std::string name;
    std::unique_ptr<FileWriter> writer;
    std::uint64_t bytes = 0;
    std::set<PeNumber> opened_by;
  };
  /// A PE's open file: one of the two.
  struct Open {
    const Input* input = nullptr;
    Output* output = nullptr;
    std::uint64_t position = 0;
    bool appends = false;
  };
  using OpenFiles = std::array<std::optional<Open>, protocol::kMostOpenFiles>;

  Open& open_file(PeNumber pe, std::uint32_t file);
  Output* output_named(const std::string& name);
  static void put(Output& output, std::uint64_t position, std::span<const std::byte> bytes);

  std::vector<Input> inputs_;
  std::vector<Output> outputs_;
  std::unordered_map<PeNumber, OpenFiles> open_;
};

}  // namespace torolux
