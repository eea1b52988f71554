// SPDX-License-Identifier: MIT
// What a picture shows of a solution: the flux that has come to the elements, and an estimate of what is still unshot.
#pragma once

#include <vector>

#include "host_tools/solution/solution.hpp"

namespace torolux {

/// Incident flux by global element, as incident_flux, with what would come if the radiosity stage went on to its end.
/// In each channel the rest, of what is unshot and of what that would give off in its turn (by the part that came of
/// all light so far that was reflected), is taken to come where reflected light has come, in proportion. (The ambient
/// term of Cohen, Chen, Wallace & Greenberg 1988 comes everywhere alike; so it would light closed rooms that no light
/// enters.) Only pictures are made of it: the balance, saved radiosities and meshes have what came.
/// without_direct: as incident_flux.
std::vector<protocol::Flux> foreseen_flux(const Mesh& mesh, const Solution& solution, bool without_direct);

/// What a picture shows of the elements, by global element, and what a record (or a ray) brought of it in the mean,
/// by which its noise is known.
struct PictureLight {
  std::vector<protocol::Flux> flux;
  std::vector<double> of_record;  ///< [quanta], of the channels; empty: not known
};

/// without_direct: shadow rays bring what comes straight from emitters. Of elements that have gathered, what their
/// points found, and what was kept apart; else foreseen_flux. emission_found: their rays found what emitters emit, too.
PictureLight picture_light(const Mesh& mesh, const Solution& solution, bool without_direct, bool emission_found);

}  // namespace torolux
