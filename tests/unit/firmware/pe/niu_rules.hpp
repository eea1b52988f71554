// SPDX-License-Identifier: MIT
// What firmware owes the NIU and the host, checked by what stands in for them.
#pragma once

#include <stdexcept>
#include <string>

namespace torolux::test {

/// Throws std::logic_error that names the rule where it does not hold.
inline void require(bool holds, const char* what) {
  if (!holds) throw std::logic_error(std::string("firmware broke the NIU's rules: ") + what);
}

}  // namespace torolux::test
