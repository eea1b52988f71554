// SPDX-License-Identifier: MIT
// Each draft is solved twice, with other random numbers; where the two tell of light that the mesh is too coarse for,
// elements are cut.
#include "host_tools/render/drafts.hpp"

#include <algorithm>
#include <iterator>

#include "firmware/protocol/random.hpp"
#include "host_tools/render/machines.hpp"

namespace torolux {
namespace {

/// Solves a draft twice. False: stopped by `progress`.
bool solve_draft(const Scene& scene, const Camera& camera, const Quality& full, const MachineChoice& choice,
                 const Image& image, Watch& watch, RenderSetup& setup, Drafts& drafts) {
  const Quality quality = draft_of(full);
  for (; drafts.half < drafts.light.flux.size(); ++drafts.half) {
    setup.parameters.seed = protocol::hash_combine(machine_seed(full.seed), 2 * drafts.round + drafts.half);
    RenderProgram program(job_of(scene, camera, quality, choice, setup, true));
    MachineSetup of_draft = machine_setup(setup, quality, choice);
    of_draft.keeper = watch.keeper();
    Machine torolux(of_draft, image);
    watch.run(torolux, program, setup, true);
    if (!program.finished()) return false;
    drafts.cycles += program.times().read;
    drafts.records += program.solution()->tally.rays;
    drafts.light.flux[drafts.half] = incident_flux(*program.solution(), full.shadow_rays);
    drafts.light.of_record = flux_of_record(*program.solution());
  }
  drafts.half = 0;
  return true;
}

}  // namespace

bool solve_drafts(const Scene& scene, const Camera& camera, const Quality& full, const MachineChoice& choice,
                  const Image& image, Watch& watch, Drafts& drafts) {
  for (; drafts.round < kDraftRounds; ++drafts.round) {
    RenderSetup setup = watch.next_setup(scene, camera, draft_of(full), choice, image);
    if (!solve_draft(scene, camera, full, choice, image, watch, setup, drafts)) return false;
    if (drafts.round == 0) drafts.more = static_cast<std::uint64_t>(full.refine * setup.mesh.elements) / kDraftRounds;
    std::vector<Split> chosen = choose_splits(setup.mesh, scene, drafts.light, drafts.more);
    std::vector<Split> all;
    std::set_union(drafts.splits.begin(), drafts.splits.end(), chosen.begin(), chosen.end(), std::back_inserter(all));
    drafts.splits = std::move(all);
  }
  drafts.over = true;
  return true;
}

}  // namespace torolux
