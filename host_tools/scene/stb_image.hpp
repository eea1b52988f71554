// SPDX-License-Identifier: MIT
// stb_image for the kinds of picture that libpng and libjpeg-turbo do not read; every file that uses it must agree.
#pragma once

#define STBI_ONLY_TGA
#define STBI_ONLY_BMP
#define STBI_NO_STDIO
#define STBI_NO_LINEAR
#define STBI_NO_HDR
#define STBI_MAX_DIMENSIONS 16384
#include <stb/stb_image.h>
