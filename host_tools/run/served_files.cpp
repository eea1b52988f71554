// SPDX-License-Identifier: MIT
// Names into open files, positions into bytes.
#include "host_tools/run/served_files.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "emulator/errors.hpp"

namespace torolux {
namespace {

using protocol::FileAccess;
using protocol::FileAnswer;
using protocol::FileError;

bool has(std::uint32_t access, FileAccess bit) {
  return (access & static_cast<std::uint32_t>(bit)) != 0;
}

FileAnswer refused(FileError error) {
  return {error, 0, 0};
}

}  // namespace

std::vector<Input> read_inputs(const std::vector<GivenFile>& files) {
  std::vector<Input> inputs;
  inputs.reserve(files.size());
  for (const GivenFile& given : files) inputs.push_back({given, read_file(given.file, kMostInputBytes)});
  return inputs;
}

std::vector<InputFile> digests_of(const std::vector<Input>& inputs) {
  std::vector<InputFile> digests;
  digests.reserve(inputs.size());
  for (const auto& [given, contents] : inputs) {
    digests.push_back({"input " + given.name, given.file.string(),
                       sha256({reinterpret_cast<const char*>(contents.data()), contents.size()})});
  }
  return digests;
}

ServedFiles::ServedFiles(std::vector<Input> inputs, const std::vector<GivenFile>& outputs)
    : inputs_(std::move(inputs)) {
  for (const GivenFile& given : outputs)
    outputs_.push_back({given.name, std::make_unique<FileWriter>(given.file), 0, {}});
}

ServedFiles::Output* ServedFiles::output_named(const std::string& name) {
  const auto found = std::ranges::find(outputs_, name, &Output::name);
  return found != outputs_.end() ? &*found : nullptr;
}

FileAnswer ServedFiles::open(PeNumber pe, std::uint32_t access, const std::string& name) {
  const auto input = std::ranges::find(inputs_, name, [](const Input& each) { return each.given.name; });
  Output* const output = output_named(name);
  const bool is_input = input != inputs_.end();
  if (!is_input && output == nullptr) return refused(FileError::no_such_file);
  const bool writes = has(access, FileAccess::write);
  if (is_input ? writes : has(access, FileAccess::read) || !writes) return refused(FileError::not_allowed);
  OpenFiles& files = open_[pe];
  const auto place = std::ranges::find_if(files, [](const auto& file) { return !file; });
  if (place == files.end()) return refused(FileError::too_many);
  Open& file = place->emplace();
  if (is_input) {
    file.input = &*input;
  } else {
    file.output = output;
    file.appends = has(access, FileAccess::append);
    output->opened_by.insert(pe);
    // As long as nobody else writes it, too.
    if (has(access, FileAccess::empty) && output->opened_by.size() == 1 && output->bytes != 0) {
      output->writer->empty();
      output->bytes = 0;
    }
  }
  return {FileError::none, static_cast<std::uint32_t>(place - files.begin()), 0};
}

ServedFiles::Open& ServedFiles::open_file(PeNumber pe, std::uint32_t file) {
  const auto files = open_.find(pe);
  if (files == open_.end() || file >= protocol::kMostOpenFiles || !files->second[file]) {
    throw MachineFailure("PE " + std::to_string(pe) + " asks the host for file number " + std::to_string(file) +
                         ", which it has not opened");
  }
  return *files->second[file];
}

std::span<const std::byte> ServedFiles::read(PeNumber pe, const protocol::FileRead& request) {
  Open& file = open_file(pe, request.file);
  if (file.input == nullptr || request.bytes > protocol::kMostReadBytes) {
    throw MachineFailure("PE " + std::to_string(pe) + " asks the host to read " + std::to_string(request.bytes) +
                         " bytes of " + (file.input == nullptr ? "an output" : "an input, more than at once"));
  }
  const std::span<const std::byte> all(file.input->contents);
  const std::uint64_t begin = std::min<std::uint64_t>(file.position, all.size());
  const auto bytes = all.subspan(begin, std::min<std::uint64_t>(request.bytes, all.size() - begin));
  file.position = begin + bytes.size();
  return bytes;
}

void ServedFiles::put(Output& output, std::uint64_t position, std::span<const std::byte> bytes) {
  if (position + bytes.size() > protocol::kMostFileBytes) {
    throw MachineFailure("the output " + output.name + " would have more than " +
                         std::to_string(protocol::kMostFileBytes) + " bytes");
  }
  output.writer->write_at(position, bytes);
  output.bytes = std::max(output.bytes, position + bytes.size());
}

void ServedFiles::write(PeNumber pe, std::uint32_t number, std::span<const std::byte> bytes) {
  Open& file = open_file(pe, number);
  if (file.output == nullptr) {
    throw MachineFailure("PE " + std::to_string(pe) + " asks the host to write an input");
  }
  if (file.appends) file.position = file.output->bytes;
  put(*file.output, file.position, bytes);
  file.position += bytes.size();
}

FileAnswer ServedFiles::seek(PeNumber pe, const protocol::FileSeek& request) {
  Open& file = open_file(pe, request.file);
  const std::uint64_t end = file.input != nullptr ? file.input->contents.size() : file.output->bytes;
  std::uint64_t from = 0;
  switch (request.origin) {
    case protocol::FileOrigin::begin:
      break;
    case protocol::FileOrigin::position:
      from = file.position;
      break;
    case protocol::FileOrigin::end:
      from = end;
      break;
    default:
      return refused(FileError::bad_position);
  }
  // Unsigned: an offset before the beginning comes out larger than any position.
  const std::uint64_t position = from + static_cast<std::uint64_t>(request.offset);
  if (position > protocol::kMostFileBytes) return refused(FileError::bad_position);
  file.position = position;
  return {FileError::none, request.file, position};
}

void ServedFiles::close(PeNumber pe, std::uint32_t file) {
  open_file(pe, file);
  open_[pe][file].reset();
}

void ServedFiles::append_to_host_file(PeNumber pe, std::span<const std::byte> bytes) {
  Output* const output = output_named(kHostFile);
  if (output == nullptr) {
    throw MachineFailure("PE " + std::to_string(pe) +
                         " sends bytes to the host (TOROLUX_HOST), and no file has been named for them: --output " +
                         kHostFile + "=FILE");
  }
  put(*output, output->bytes, bytes);
}

std::vector<std::string> ServedFiles::finish() {
  std::vector<std::string> unused;
  for (const Output& output : outputs_) {
    if (output.opened_by.empty() && output.bytes == 0) {
      unused.push_back(output.name);
    } else {
      output.writer->finish();
    }
  }
  return unused;
}

}  // namespace torolux
