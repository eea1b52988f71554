// SPDX-License-Identifier: MIT
// Values as they are written on the command line and in scene.toml: text enters, checked values leave.
// What has the wrong form throws UsageError; what has the right form and a value that is not allowed, InputError.
// The messages do not name the option; the caller puts that in front.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "emulator/engines/engine/debugging.hpp"
#include "host_tools/picture/layers.hpp"
#include "host_tools/scene/gltf_units.hpp"
#include "host_tools/scene/missing_materials.hpp"
#include "host_tools/settings/presets.hpp"
#include "host_tools/trace/follow_target.hpp"

namespace torolux {

/// "WxH", e.g. "640x480". Each least..most.
std::array<std::uint32_t, 2> parse_pair(const std::string& text, std::uint32_t least, std::uint32_t most);

/// "PxQ": at most kMostPes in all.
std::array<std::uint32_t, 2> parse_pes(const std::string& text);

/// "GxHxK", or "auto" (absent). Each 1..kMostSubspacesPerAxis.
inline constexpr std::uint32_t kMostSubspacesPerAxis = 1024;
std::optional<std::array<std::uint32_t, 3>> parse_subspaces(const std::string& text);

/// Bytes, with K (2^10) or M (2^20): "512K", "64M", "262144". kSmallestLocalMemory..kLargestLocalMemory, whole pages.
std::uint32_t parse_memory(const std::string& text);

/// "X,Y,Z", finite.
std::array<double, 3> parse_vector(const std::string& text);

/// A length > 0 in scene units, or "auto" (absent).
std::optional<double> parse_length(const std::string& text);

/// A finite number within least..most.
double parse_number(const std::string& text, double least, double most);

/// A whole number within least..most.
std::uint64_t parse_count(const std::string& text, std::uint64_t least, std::uint64_t most);

/// Numbers of PEs, and ranges of them: "3", "0-3,7". Ascending, none twice. Whether the machine has them is not
/// checked.
std::vector<unsigned> parse_pe_list(const std::string& text);

/// "FROM:TO", cycles, or one of the two alone with its colon: from the beginning, to the end. FROM < TO.
std::array<std::uint64_t, 2> parse_window(const std::string& text);

/// "X,Y", "X,Y:SAMPLE"; "SHOT:POINT", "SHOT:POINT:DIRECTION".
FollowTarget parse_follow(const std::string& text);

/// A file's size: bytes, with K (2^10), M or G: "64M". least..most.
std::uint64_t parse_file_size(const std::string& text, std::uint64_t least, std::uint64_t most);

/// "PE:PORT", each within its range of all machines, or "PE:PATH": what has a slash is a path.
GdbEndpoint parse_gdb_endpoint(const std::string& text);
/// The same without a PE: a port, or a path with a slash.
GdbEndpoint parse_gdb_place(const std::string& text);

/// "link:P": the chance P, 0 to 0.5, that a packet is spoilt on a link.
double parse_link_fault(const std::string& text);

/// "R" or "R,R,...": flits per node and cycle, each above 0 and up to 1.
std::vector<double> parse_rates(const std::string& text);

/// "refuse" or "white".
MissingMaterials parse_missing_materials(const std::string& text);
GltfUnits parse_gltf_units(const std::string& text);

/// The number of the name among `names`. kind: of another one, as in "no filter".
std::size_t parse_name(const std::string& text, std::span<const std::string_view> names, std::string_view kind);
/// A fraction 0..1, or "auto" (absent).
std::optional<double> parse_fraction(const std::string& text);

/// "off", "auto", or a temperature in kelvin.
WhiteBalance parse_white_balance(const std::string& text);

/// The name of a quality preset.
Preset parse_preset(const std::string& text);
/// Names of layers with commas between them, or "all".
LayerSet parse_layers(const std::string& text);

}  // namespace torolux
