// SPDX-License-Identifier: MIT
// What goes back over the bus when light ends: additions to the frame buffer, and credits. They leave in this order in
// one queue, so that a credit is never home before its result.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/niu/niu.hpp"
#include "firmware/pe/vectors.hpp"

namespace torolux::pe {

/// Radiance to quanta: rounded to nearest (halves away from zero), saturating at 2^56; a value that is not finite does,
/// too.
std::int64_t to_quanta(float value);

class Results {
 public:
  /// Worth a message of their own.
  static constexpr std::uint32_t kManyCredits = 64;

  bool empty() const { return pixels_ == 0 && credits_ == 0; }
  /// value: in quanta, before rounding. Sent when a message is full.
  void add_pixel(Niu& niu, std::uint32_t pixel, const glm::vec3& value) {
    add(niu, protocol::Plane::colour, pixel, {to_quanta(value.x), to_quanta(value.y), to_quanta(value.z)});
  }
  void add(Niu& niu, protocol::Plane plane, std::uint32_t pixel, const std::array<std::int64_t, 3>& value);
  /// A record has died, or a grant was not used up. Sent when there are many.
  void add_credits(Niu& niu, std::uint32_t count);
  void flush(Niu& niu);
  void flush_pixels(Niu& niu);

 private:
  std::uint32_t pixels_ = 0;  ///< in the NIU driver's batch message
  std::uint32_t credits_ = 0;
};

}  // namespace torolux::pe
