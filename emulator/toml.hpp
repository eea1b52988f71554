// SPDX-License-Identifier: MIT
// toml++ for all of Torolux: include this, never the library itself, so that every file compiles the same code.
// Some of toml++ 3.3's assertions fail on invalid input (`[=` is one); in release builds they would be assumptions that
// the compiler may build on. The parser's own checks behind them give the error: so the assertions are taken out.
#pragma once

#include <toml++/impl/preprocessor.h>

#undef TOML_ASSERT
#undef TOML_ASSERT_ASSUME
#define TOML_ASSERT(expr) static_assert(true)
#define TOML_ASSERT_ASSUME(expr) static_assert(true)

#include <toml++/toml.h>
