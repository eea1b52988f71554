// SPDX-License-Identifier: MIT
// Gives `torolux bench engine` what pe.elf and triangles.elf do as code of this computer: to link this file is enough.

#include <memory>

#include "firmware/pe/pe.hpp"
#include "host_tools/bench/replay.hpp"
#include "tests/images/triangles.hpp"

namespace torolux::test {
namespace {

struct Stopped {};

/// The log's HINTs as native firmware sees them.
class ReplayedNiu final : public pe::HintTarget {
 public:
  explicit ReplayedNiu(const NativeHint& hint) : hint_(hint) {}
  void hint(std::int32_t immediate) override {
    if (!hint_(immediate)) throw Stopped();
  }

 private:
  const NativeHint& hint_;
};

NativeProgram native(const std::function<void(pe::Niu&)>& program) {
  return [program](const Image& image, std::span<std::byte> local_memory, const NativeHint& hint) {
    ReplayedNiu target(hint);
    auto& page = *reinterpret_cast<pe::NiuPage*>(&local_memory[image.niu_window - protocol::kLocalMemoryBase]);
    pe::Niu niu(page, pe::Memory(pe::LocalBase(local_memory.data(), image.stores_begin)), pe::HintGate(target));
    try {
      program(niu);
      niu.halt();
    } catch (const Stopped&) {
    }
  };
}

const bool registered = [] {
  register_native_program("pe", native([](pe::Niu& niu) {
                            const auto state = std::make_unique<pe::Pe>();
                            pe::run_pe(*state, niu);
                          }));
  register_native_program("triangles",
                          native([](pe::Niu& niu) { niu.window().fault.detail[2] = cross_triangles(kBenchRays); }));
  return true;
}();

}  // namespace
}  // namespace torolux::test
