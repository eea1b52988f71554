// SPDX-License-Identifier: MIT
// Functions enter, one that is all of them leaves: for std::visit.
#pragma once

namespace torolux {

template <class... Function>
struct Overloaded : Function... {
  using Function::operator()...;
};
template <class... Function>
Overloaded(Function...) -> Overloaded<Function...>;

}  // namespace torolux
