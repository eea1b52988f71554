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
std::vector<protocol::Flux> foreseen_flux(const Mesh& mesh, const Solution& solution, bool without_direct);

}  // namespace torolux
