// SPDX-License-Identifier: MIT
// QEMU has loaded the plugin: looks whether both fit, maps what the emulator shares, and lets the plugin run.
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "emulator/engines/qemu/plugin.hpp"

extern "C" {
__attribute__((visibility("default"))) extern const int qemu_plugin_version;
const int qemu_plugin_version = 1;
__attribute__((visibility("default"))) int qemu_plugin_install(qemu_plugin_id_t id, const qemu_info_t* info, int argc,
                                                               char** argv);
}

namespace torolux {
namespace {

std::optional<std::span<std::byte>> map_descriptor(int descriptor) {
  struct stat status {};
  if (fstat(descriptor, &status) != 0 || status.st_size <= 0) {
    return std::nullopt;
  }
  const auto bytes = static_cast<std::size_t>(status.st_size);
  void* mapped = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  if (mapped == MAP_FAILED) {
    return std::nullopt;
  }
  return std::span(static_cast<std::byte*>(mapped), bytes);
}

/// Nothing on success, else what is wrong.
const char* install(qemu_plugin_id_t id, const qemu_info_t& info, std::string_view argument) {
  if (info.version.min > qemu_plugin_version || info.version.cur < qemu_plugin_version) {
    return "this QEMU does not speak version 1 of the plugin interface";
  }
  if (std::string_view(info.target_name) != "riscv32" || !info.system_emulation || info.system.max_vcpus != 1) {
    return "needed: qemu-system-riscv32 with one hart";
  }
  constexpr std::string_view kShare = "share=";
  if (!argument.starts_with(kShare)) {
    return "expected the argument share=DESCRIPTOR";
  }
  const auto share_memory = map_descriptor(std::atoi(argument.substr(kShare.size()).data()));
  if (!share_memory || share_memory->size() < sizeof(PluginShare)) {
    return "the shared memory cannot be mapped";
  }
  auto& share = *reinterpret_cast<PluginShare*>(share_memory->data());
  if (share.version != kPluginShareVersion || share.channel_layout != niu_channel_layout()) {
    return "plugin and emulator are not from the same build";
  }
  const auto channel = map_descriptor(share.channel_descriptor);
  const auto local = map_descriptor(share.local_descriptor);
  if (!channel || !local || channel->size() < niu_channel_bytes() || local->size() < share.local_memory_bytes) {
    return "channel or local memory cannot be mapped";
  }
  const std::span<std::byte> memory = local->first(share.local_memory_bytes);
  auto plugin =
      std::make_unique<Plugin>(share, *niu_channel_at(channel->data()), memory,
                               NiuProcessorSide(*niu_channel_at(channel->data()), memory, share.window_offset));
  if (share.log_use != HintLogUse::none) {
    const auto log = map_descriptor(share.log_descriptor);
    if (!log || log->size() < sizeof(HintLogHead)) {
      return "the log of HINTs cannot be mapped";
    }
    if (share.log_use == HintLogUse::record) {
      plugin->recorder.emplace(*log, memory, share.window_offset);
    } else {
      plugin->replayer.emplace(*log, memory);
    }
  }
  if (share.meeting_descriptor >= 0) {
    const auto meeting = map_descriptor(share.meeting_descriptor);
    if (!meeting || meeting->size() < sizeof(HintMeeting)) {
      return "the meeting place for HINTs cannot be mapped";
    }
    plugin->meeting = reinterpret_cast<HintMeeting*>(meeting->data());
  }
  run_plugin(id, std::move(plugin));
  return nullptr;
}

}  // namespace
}  // namespace torolux

int qemu_plugin_install(qemu_plugin_id_t id, const qemu_info_t* info, int argc, char** argv) {
  const char* problem = torolux::install(id, *info, argc == 1 ? argv[0] : "");
  if (problem != nullptr) {
    const std::string_view prefix = "torolux plugin: ";
    const std::string_view text = problem;
    (void)!write(STDERR_FILENO, prefix.data(), prefix.size());
    (void)!write(STDERR_FILENO, text.data(), text.size());
    return 1;
  }
  return 0;
}
