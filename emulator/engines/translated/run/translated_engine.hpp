// SPDX-License-Identifier: MIT
// The engine `translated`: PEs are objects of this process, their code is code of this computer. Enters: an image and
// the PEs' memories; leaves: the PEs, run by the threads that the setup allows, the scheduler's own among them.
#pragma once

#include <memory>

#include "emulator/engines/engine/engine.hpp"
#include "emulator/engines/translated/run/translated_image.hpp"

namespace torolux {

/// Translates the images, or takes them from the cache: throws as TranslatedImage does. setup.pes and setup.images must
/// outlive the engine.
std::unique_ptr<Engine> make_translated_engine(const EngineSetup& setup,
                                               const translated::TranslationOptions& options = {});

}  // namespace torolux
