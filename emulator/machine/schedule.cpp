// SPDX-License-Identifier: MIT
// Virtual time: which event may happen, when to wait for which PE, and what it means if nothing can happen any more.
#include <algorithm>
#include <chrono>
#include <thread>

#include "emulator/clock_seconds.hpp"
#include "emulator/errors.hpp"
#include "emulator/machine/emulation.hpp"
#include "emulator/pause.hpp"

namespace torolux {

namespace {

/// Attention at least this often, by events.
constexpr std::uint32_t kAttendEvents = 4096;
/// Between two questions whether a run that is held back may go on.
constexpr std::chrono::milliseconds kHold{2};
/// Running a PE, a millisecond at most, counts as so many.
constexpr std::uint32_t kHelpEvents = 256;
/// Looks at a PE that is about to get there before the scheduler sleeps.
constexpr int kLooks = 50;

std::uint64_t mix(std::uint64_t hash, std::uint64_t value) {
  hash = (hash ^ value) * 0x9E37'79B9'7F4A'7C15U;
  return hash ^ (hash >> 29U);
}

/// Of an event: who made it, of what kind it is, whom it concerns. Not its number: of a router's events some may not
/// have been made (Torus::advance).
std::uint64_t what_of(const Event& event) {
  return (event.order >> 32U) << 32U | std::uint64_t{event.actor} << 8U | static_cast<std::uint64_t>(event.kind);
}

}  // namespace

void Emulation::attend_now_and_then() {
  until_attend_ = kAttendEvents;
  const double seconds = clock_seconds(CLOCK_MONOTONIC);
  if (seconds - last_attended_ < attend_seconds_) return;
  last_attended_ = seconds;
  if (attend_) attend_(now_);
}

void Emulation::hold_until_let(Cycles next) {
  while (!pacer_->lets(next)) {
    std::this_thread::sleep_for(kHold);
    attend_now_and_then();
  }
}

/// Waits for a PE that runs: until its bound is later than `wanted`, or it waits itself, or a while has passed.
void Emulation::await(unsigned pe, Cycles wanted) {
  nius_[pe].wake_if_overlooked();
  if (engine_.help(pe, wanted)) {
    if (until_attend_ <= kHelpEvents) return attend_now_and_then();
    until_attend_ -= kHelpEvents;
    return;
  }
  NiuNetworkSide& niu = nius_[pe];
  for (int i = 0; i < kLooks; ++i) {
    if (niu.refresh(events_, pool_, times_)) return;
    torolux::pause();
  }
  const double begin = clock_seconds(CLOCK_MONOTONIC);
  niu.sleep_until_bound(wanted);
  slept_ += clock_seconds(CLOCK_MONOTONIC) - begin;
  attend_now_and_then();
}

/// Of a PE that takes turns: until its clock is another's, or an event's.
Cycles Emulation::end_of_turn(unsigned pe, Cycles time) const {
  const std::size_t second = times_.bounds.second_index();
  return second == pe ? time : std::min(time, times_.bounds.at(second) - kCommandCycles);
}

/// While one PE runs, what the next one needs is fetched: since its last turn all others have had theirs. Of few PEs it
/// is still near.
void Emulation::fetch_next_turn_ahead() const {
  if (pes_ <= kManyPes) return;
  const auto pe = static_cast<unsigned>(times_.bounds.second_index());
  nius_[pe].fetch_ahead();
  NiuNetworkSide::fetch_turn_ahead(*channels_[pe]);
  engine_.fetch_ahead(pe);
}

/// The next event that no PE can precede any more. False: nothing will ever happen again, or not before the end.
bool Emulation::next_event(Event& event) {
  // One of this cycle has been let in, and what it brings about at PEs comes later: no bound has come back to it.
  if (events_.next_time() == now_ && now_ < until_) {
    event = events_.pop();
    return true;
  }
  for (;;) {
    const Cycles time = events_.next_time();  // kNever where there is none
    const Cycles least = times_.bounds.least();
    // Everything before this has happened, and no PE adds to it.
    const Cycles known = std::min({time, least, until_});
    if (times_.releases.least() <= known && known != kNever) {
      NiuNetworkSide& niu = nius_[times_.releases.least_index()];
      // What did not fit into its ring may fit now, and be what it waits for; or it has found by itself what it waited
      // for.
      if (!niu.refresh(events_, pool_, times_)) niu.release(known, times_);
      continue;
    }
    if (std::min(time, least) >= until_) return false;
    if (least > time) {
      event = events_.pop();
      return true;
    }
    const auto pe = static_cast<unsigned>(times_.bounds.least_index());
    if (nius_[pe].refresh(events_, pool_, times_)) continue;
    nius_[pe].publish_horizon(known);
    fetch_next_turn_ahead();
    await(pe, engine_.takes_turns(pe) ? end_of_turn(pe, time) : time);
  }
}

void Emulation::run(const std::function<void(Cycles)>& attend, const std::function<void()>& message_read) {
  attend_ = attend;
  for (unsigned pe = 0; pe < pes_; ++pe) nius_[pe].tell_polls(!engine_.runs_only_helped(pe), times_);
  if (resumed_) {
    host_.resume(*this);
  } else {
    host_.start(*this);
    note_host_busy();
  }
  Event event{};
  while (next_event(event)) {
    if (event.time < now_) {  // only a wrong bound can do that
      throw MachineFailure("virtual time runs backwards: an event of cycle " + std::to_string(event.time) +
                           " became known at cycle " + std::to_string(now_));
    }
    if (pacer_ != nullptr) hold_until_let(event.time);
    now_ = event.time;
    if (watch_) watch_->before(now_);
    if (!is_inside_torus(event.kind)) trace_hash_ = mix(mix(trace_hash_, event.time), what_of(event));
    handle(event);
    end_if_failed();
    if (message_read && event.kind == EventKind::host_step) message_read();
    if (--until_attend_ == 0) attend_now_and_then();
  }
  if (!failure_.empty()) throw MachineFailure(failure_);
  if (stops_before_end()) return;
  torus_.check_slots();
  if (!empty() || !program_->finished()) throw MachineFailure(deadlock_report());
}

/// All events before `until_` have happened. Each PE goes on as far as these decide what it does, whoever ran how far
/// before. True: there would be more.
bool Emulation::stops_before_end() {
  if (until_ == kNever) return false;
  for (NiuNetworkSide& niu : nius_) niu.tell_polls(true, times_);
  for (let_rest(); times_.releases.least() <= until_; let_rest()) {
    nius_[times_.releases.least_index()].release(until_, times_);
  }
  stopped_ = events_.next_time() != kNever || times_.bounds.least() != kNever ||
             std::ranges::any_of(nius_, [](const auto& niu) { return niu.waits_for() == WaitKind::until; });
  return stopped_;
}

void Emulation::go_on_with(HostProgram& program) {
  resumed_ = false;
  program_ = &program;
  lend_to_near_pes();
  host_.go_on_with(program, now_);
}

void Emulation::begin_picture(std::uint32_t width, std::uint32_t height, std::uint32_t layers) {
  controller_.begin_picture(width, height, layers);
}

void Emulation::tell_to_stop() {
  for (NiuNetworkSide& niu : nius_) niu.tell_to_stop();
}

bool Emulation::empty() const {
  if (torus_.packets_inside() != 0 || bus_.busy() || controller_.waiting() != 0 || !host_.idle()) return false;
  if (host_.waiting_for_all() != 0) return false;
  for (unsigned pe = 0; pe < pes_; ++pe) {
    const WaitKind waits = nius_[pe].waits_for();
    if ((waits != WaitKind::receive || !nius_[pe].nothing_gathered()) && waits != WaitKind::halted) return false;
    if (!parts_[pe].outgoing.empty() || parts_[pe].diverting != kNoBlock || host_.waiting(pe) != 0) return false;
  }
  return true;
}

// ---- Figures ----

/// Whether a PE can do nothing before something else happens.
bool Emulation::at_rest(unsigned pe) {
  nius_[pe].refresh(events_, pool_, times_);
  return nius_[pe].waits_for() != WaitKind::running;
}

}  // namespace torolux
