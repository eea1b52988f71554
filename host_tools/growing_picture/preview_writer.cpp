// SPDX-License-Identifier: MIT
// Writes what is newest.
#include "host_tools/growing_picture/preview_writer.hpp"

#include <utility>

#include "emulator/errors.hpp"

namespace torolux {
namespace {

constexpr std::chrono::hours kLong{1};

}  // namespace

void write_preview(const PictureState& state, const std::vector<std::filesystem::path>& outputs,
                   const ToneMapping& tone) {
  for (const auto& file : outputs)
    if (!holds_radiance(file)) write_layers(state.picture, state.layers, file, tone);
}

PreviewWriter::PreviewWriter(std::vector<std::filesystem::path> outputs, const ToneMapping& tone)
    : outputs_(std::move(outputs)), tone_(tone), thread_([this] { work(); }) {}

PreviewWriter::~PreviewWriter() {
  stop();
}

std::string PreviewWriter::stop() {
  states_.close();
  if (thread_.joinable()) thread_.join();
  return failure_;
}

void PreviewWriter::work() {
  while (!states_.closed()) {
    const auto state = states_.take(kLong);
    if (state == nullptr || states_.closed()) continue;
    try {
      write_preview(*state, outputs_, tone_);
    } catch (const std::exception& error) {
      failure_ = error.what();
    }
  }
}

}  // namespace torolux
