// SPDX-License-Identifier: MIT
// A render whose PEs run on other ranks, which are threads of this process: a case and where it runs enter, what it
// leaves in the end leaves.
#pragma once

#include <exception>
#include <functional>
#include <string>

#include "emulator/ranks/thread_ranks.hpp"
#include "emulator/remote/pe_ranks.hpp"
#include "emulator/remote/serve_pes.hpp"
#include "tests/support/faulty_ranks.hpp"
#include "tests/support/render_support.hpp"

namespace torolux::test {

struct OnRanks {
  unsigned ranks, threads;
  remote::Placing placing;
  ranks::Delays delays;
};

/// Throws what the render throws, once all ranks have ended; each must end well. tap: sees what rank 0 is sent.
inline RenderResult render_on(
    const OnRanks& on, RenderCase render_case,
    const std::function<bool(ranks::Message&)>& tap = [](ranks::Message&) { return true; }) {
  render_case.machine.threads = on.threads;
  RenderResult result;
  std::exception_ptr thrown;
  const auto ends = ranks::run_as_threads(on.ranks, on.delays, [&](ranks::Transport& transport) {
    if (transport.ranks().own != 0) return remote::serve_pes(transport, "the same");
    TappedTransport tapped(transport, tap);
    remote::PeRanks others(tapped, on.placing, "the same");
    render_case.machine.ranks = &others;
    try {
      result = run_case(render_case);
    } catch (...) {
      thrown = std::current_exception();
    }
    others.end(0);
  });
  for (const std::string& end : ends) EXPECT_EQ(end, "");
  if (thrown) std::rethrow_exception(thrown);
  return result;
}

}  // namespace torolux::test
