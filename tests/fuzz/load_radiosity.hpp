// SPDX-License-Identifier: MIT
// What the fuzzer of radiosity files does with its bytes: read them as they are, and again with length and CRC-32 set
// right, so that damage behind those is met too; add up what was read. Only a refusal that names the file may come out.
#pragma once

#include <zlib.h>

#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "emulator/errors.hpp"
#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/scene/load_scene.hpp"
#include "host_tools/solution/radiosity_file.hpp"
#include "tests/support/memory_files.hpp"

namespace torolux {

/// A closed tetrahedron, one of whose faces is a lamp: what the files belong to.
class RadiosityFuzz {
 public:
  RadiosityFuzz()
      : scene_(load()),
        mesh_(make_mesh(scene_, {quality_.patch_length, quality_.element_length, false})),
        units_(light_units(scene_, mesh_, false)) {}

  /// A file that must be taken: nothing has been shot yet.
  std::vector<std::byte> valid_file() const {
    Solution solution;
    solution.elements.resize(mesh_.elements);
    solution.sides.resize(mesh_.patch_sides);
    for (const MeshPatch& patch : mesh_.patches) {
      for (std::uint32_t s = 0; s < 2; ++s) {
        if (patch.side[s] == protocol::kNoSide) continue;
        solution.sides[patch.side[s]].emission = patch_emission(scene_, patch, s, units_);
      }
    }
    return pack_radiosity(origin_, std::vector<Split>{{0, 1}, {2, 1}}, solution);
  }

  /// True: taken, as it is or with its head set right.
  bool read(std::span<const std::byte> bytes) const {
    const bool taken = unpack(bytes);
    return unpack(with_right_head({bytes.begin(), bytes.end()})) || taken;
  }

 private:
  static Scene load() {
    MemoryFiles files({{"a.obj",
                        "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl white\nf 1 2 3\nf 1 4 2\nf 1 3 4\n"
                        "usemtl lamp\nf 2 4 3\n"},
                       {"a.mtl", "newmtl white\nKd .5 .5 .5\nnewmtl lamp\nKd .2 .2 .2\nKe 3 2 1\n"}});
    return load_scene_from(files, "a.obj", {});
  }

  /// Head: magic and version (8 bytes), CRC-32 of what follows the head, zero (4 bytes each), length of that (8 bytes).
  static std::vector<std::byte> with_right_head(std::vector<std::byte> bytes) {
    constexpr std::size_t kHead = 24;
    if (bytes.size() < kHead) return bytes;
    const std::uint64_t length = bytes.size() - kHead;
    const auto crc = static_cast<std::uint32_t>(
        crc32(0, reinterpret_cast<const Bytef*>(bytes.data() + kHead), static_cast<uInt>(length)));
    std::memcpy(bytes.data() + 8, &crc, sizeof crc);
    std::memset(bytes.data() + 12, 0, 4);
    std::memcpy(bytes.data() + 16, &length, sizeof length);
    return bytes;
  }

  bool unpack(std::span<const std::byte> bytes) const {
    try {
      const Solution solution = unpack_radiosity(parse_radiosity(bytes, "fuzz.rad"), origin_, mesh_);
      if (solution.sides.size() != mesh_.patch_sides || solution.elements.size() != mesh_.elements) __builtin_trap();
      balance(scene_, mesh_, units_, solution);
      return true;
    } catch (const InputError& error) {
      if (!std::string(error.what()).starts_with("fuzz.rad: ")) __builtin_trap();
    } catch (const MachineFailure&) {  // flux that does not add up; the render makes an InputError of it
    }
    return false;
  }

  /// A patch for each face and four elements on it: the file stays below libFuzzer's usual 4096 bytes.
  static Quality coarse() {
    Quality quality;
    quality.patch_length = 2;
    quality.element_length = 1;
    return quality;
  }

  Quality quality_ = coarse();
  Scene scene_;
  Mesh mesh_;
  LightUnits units_;
  RadiosityOrigin origin_ = radiosity_origin(scene_, quality_, mesh_);
};

}  // namespace torolux
