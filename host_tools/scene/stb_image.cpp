// SPDX-License-Identifier: MIT
// stb_image's code, compiled here once and under our sanitizers: TGA and BMP alone, from memory.
#define STB_IMAGE_IMPLEMENTATION
#include "host_tools/scene/stb_image.hpp"
