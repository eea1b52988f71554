// SPDX-License-Identifier: MIT
// What the fuzzer of `torolux run`'s messages does with its bytes: cut them into messages of PEs to the host, and let
// only the refusals pass that it may make.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "emulator/errors.hpp"
#include "host_tools/run/listener.hpp"
#include "tests/fuzz/send_messages.hpp"

namespace torolux {

/// Each message: source, kind, a length of 16 bits, contents. True: all were taken; false: one has failed the run.
inline bool send_to_listener(std::span<const std::byte> bytes) {
  constexpr unsigned kPes = 3;
  FuzzedBytes fuzzed(bytes);
  const char text[] = "some\nlines\n";
  const auto contents = std::as_bytes(std::span(text));
  ServedFiles files({{{"in", "in"}, {contents.begin(), contents.end()}}},
                    {{"out", "/dev/null"}, {"host", "/dev/null"}});
  std::size_t characters = 0;
  const std::function<void(const PeText&)> hear = [&](const PeText& told) { characters += told.text.size(); };
  Listener listener(files, hear);
  test::FakePort port(kPes);
  try {
    while (!fuzzed.empty()) {
      const auto source = static_cast<PeNumber>(fuzzed.as<std::uint8_t>() % kPes);
      const std::uint16_t kind = fuzzed.as<std::uint8_t>();
      const std::size_t length = fuzzed.as<std::uint16_t>() % (protocol::kMostMessageBytes + 1);
      listener.on_message(port, source, kind, fuzzed.next(length));
      port.take();
    }
    listener.finish();
    return true;
  } catch (const MachineFailure&) {
    return false;
  }
}

}  // namespace torolux
