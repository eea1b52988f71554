// SPDX-License-Identifier: MIT
// What a debugger asks for, read from its packets: text in, values out; nothing where the text has another form.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace torolux::debugger {

/// Process N + 1 is PE N; its one thread is number 1.
struct ThreadChoice {
  enum class Kind : std::uint8_t { any, all, one };
  Kind kind;
  unsigned pe = 0;  ///< of `one`

  bool holds(unsigned number) const { return kind != Kind::one || pe == number; }
  bool operator==(const ThreadChoice&) const = default;
};
/// "p3.1", "p3.-1", "p3.0", "p3": PE 2; "-1", "p-1.-1": all; "0": any; "3": PE 2, of a debugger that knows no
/// processes.
std::optional<ThreadChoice> thread_choice(std::string_view text);
/// "3": PE 2.
std::optional<unsigned> process_in(std::string_view text);

/// How a PE goes on.
struct Resumption {
  enum class Kind : std::uint8_t {
    held,
    goes_on,
    steps,     ///< one instruction
    in_range,  ///< instructions in [begin, end)
  };
  Kind kind = Kind::held;
  std::uint32_t begin = 0, end = 0;

  bool operator==(const Resumption&) const = default;
};
struct ResumeAction {
  Resumption how;
  ThreadChoice who;
};
/// What stands behind "vCont": ";c:p1.-1;s". The first that names a PE counts for it.
std::optional<std::vector<ResumeAction>> resume_actions(std::string_view text);

/// "ADDRESS,BYTES".
struct MemoryRange {
  std::uint32_t address, bytes;
};
std::optional<MemoryRange> memory_range(std::string_view text);

enum class PointKind : std::uint8_t { breakpoint, write, read, access };
struct Point {
  PointKind kind;
  std::uint32_t address;
  std::uint32_t bytes;  ///< of a watchpoint

  bool operator==(const Point&) const = default;
};
/// What stands behind "Z" or "z": "2,80001000,4".
std::optional<Point> point_in(std::string_view text);

}  // namespace torolux::debugger
