// SPDX-License-Identifier: MIT
// tinyobjloader with double precision: every file that uses it must agree.
#pragma once

#define TINYOBJLOADER_USE_DOUBLE
#include <tiny_obj_loader.h>
