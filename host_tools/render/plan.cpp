// SPDX-License-Identifier: MIT
// What a render would need, without running it. See render.hpp.
#include <algorithm>

#include "emulator/errors.hpp"
#include "host_tools/render/predict.hpp"
#include "host_tools/render/render.hpp"
#include "host_tools/setup/advice.hpp"
#include "host_tools/setup/setup.hpp"

namespace torolux {

RenderPlan plan(const Scene& scene, const Camera& camera, const Quality& quality, const MachineChoice& machine,
                const std::filesystem::path& pe_image) {
  RenderPlan plan{};
  try {
    const Image image = load_image(pe_image);
    const RenderSetup setup = make_setup(scene, camera, quality, machine, image);
    plan.triangles = setup.mesh.triangles.size();
    plan.patches = setup.mesh.patches.size();
    for (const MeshPatch& patch : setup.mesh.patches) plan.elements += patch.elements;
    plan.subspaces = setup.placement.grid.cells;
    plan.filled_subspaces = setup.placement.filled_cells;
    plan.radiosity_copies = setup.radiosity_copies;
    plan.ray_tracing_copies = setup.ray_tracing_copies;
    plan.pe_bytes = setup.need.pe_bytes;
    plan.local_memory_needed = static_cast<std::uint32_t>(std::min<std::uint64_t>(setup.need.most(), UINT32_MAX));
    const std::uint32_t available = machine.pe_memory.value_or(protocol::kLargestLocalMemory);
    plan.local_memory_bytes = setup.memory.value_or(available);
    plan.mean_neighbour_hops =
        mean_neighbour_hops(setup.placement.grid, setup.placement.torus, setup.placement.pe_of_cell);
    if (!setup.memory) plan.refusals.push_back(does_not_fit(scene, camera, quality, machine, image, {}, setup));
    plan.notes = setup.notes;
    std::optional<RenderSetup> draft;
    if (quality.refine > 0) {
      draft = make_setup(scene, camera, draft_of(quality), machine, image);
      plan.notes.push_back("the draft of --refine adds up to " +
                           with_commas(static_cast<std::uint64_t>(quality.refine * setup.mesh.elements)) +
                           " elements; where is known only then, so the memory needed is without them");
    }
    plan.prediction = predict(scene, camera, setup, draft ? &*draft : nullptr, quality, machine);
  } catch (const InputError& error) {
    plan.refusals.emplace_back(error.what());
  }
  return plan;
}

}  // namespace torolux
