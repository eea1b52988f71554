// SPDX-License-Identifier: MIT
// The HINT where firmware runs natively: a call to whatever stands for the NIU (a fake in unit tests, or the
// emulator's).
#pragma once

#include <cstdint>
#include <cstdlib>

#include "firmware/protocol/niu_window.hpp"

namespace torolux::pe {

/// Does what the NIU does at a HINT, through the window and local memory that it knows.
class HintTarget {
 public:
  HintTarget() = default;
  HintTarget(const HintTarget&) = delete;
  HintTarget& operator=(const HintTarget&) = delete;
  virtual ~HintTarget() = default;
  /// immediate: as in protocol::Hint. Returns when the HINT has happened, retries included.
  /// Must throw instead of returning from Hint::halt and Hint::fail, and whenever the program is to be stopped.
  virtual void hint(std::int32_t immediate) = 0;
};

class HintGate {
 public:
  HintGate() = default;
  /// target outlives this.
  explicit HintGate(HintTarget& target) : target_(&target) {}

  template <std::int32_t kImmediate>
  void execute(protocol::NiuWindow& /*window*/) const {
    target_->hint(kImmediate);
  }
  template <std::int32_t kImmediate>
  void mark(protocol::NiuWindow& /*window*/) const {
    target_->hint(kImmediate);
  }
  [[noreturn]] void end() const { std::abort(); }

 private:
  HintTarget* target_ = nullptr;
};

}  // namespace torolux::pe
