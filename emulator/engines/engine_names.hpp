// SPDX-License-Identifier: MIT
// The engines by name: a name and a setup enter, an engine leaves.
#pragma once

#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "emulator/engines/engine/engine.hpp"

namespace torolux {

using EngineFactory = std::function<std::unique_ptr<Engine>(const EngineSetup&)>;

/// Where the user names none, for a render.
inline constexpr const char* kDefaultEngine = "translated";
/// And for images of one's own, which change often: interprets what is not translated yet, and translates meanwhile.
inline constexpr const char* kAutomaticEngine = "auto";
/// Knows each instruction as it executes it: slow, but at once, and without a compiler.
inline constexpr const char* kInterpretedEngine = "interpreted";

/// Engines by name. `qemu`, `translated`, `interpreted` and `auto` are always there; others register before main's work
/// (tests add `native`).
void register_engine(std::string_view name, EngineFactory factory);
/// Whether its PEs need no memory that other processes can map. Throws as engine_named.
bool engine_runs_here(std::string_view name);
/// Throws UsageError with the known names.
const EngineFactory& engine_named(std::string_view name);
std::vector<std::string_view> engine_names();

}  // namespace torolux
