// SPDX-License-Identifier: MIT
// tinyobjloader's code, compiled here once, in double precision and under our sanitizers.
#define TINYOBJLOADER_IMPLEMENTATION
#include "host_tools/scene/tinyobj.hpp"
