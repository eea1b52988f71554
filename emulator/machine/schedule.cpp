// SPDX-License-Identifier: MIT
// Virtual time: which event may happen, when to wait for which PE, and what it means if nothing can happen any more.
#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <thread>

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
constexpr unsigned kMostReported = 16;

double wall_seconds() {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

std::uint64_t mix(std::uint64_t hash, std::uint64_t value) {
  hash = (hash ^ value) * 0x9E37'79B9'7F4A'7C15U;
  return hash ^ (hash >> 29U);
}

}  // namespace

void Emulation::attend_now_and_then() {
  until_attend_ = kAttendEvents;
  const double seconds = wall_seconds();
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
  const double begin = wall_seconds();
  niu.sleep_until_bound(wanted);
  slept_ += wall_seconds() - begin;
  attend_now_and_then();
}

/// While one PE runs, what the next one needs is fetched: since its last turn all others have had theirs.
void Emulation::fetch_next_turn_ahead() const {
  const auto pe = static_cast<unsigned>(times_.bounds.second_index());
  nius_[pe].fetch_ahead();
  NiuNetworkSide::fetch_turn_ahead(*channels_[pe]);
  engine_.fetch_ahead(pe);
}

/// The next event that no PE can precede any more. False: nothing will ever happen again.
bool Emulation::next_event(Event& event) {
  for (;;) {
    const Cycles time = events_.next_time();  // kNever where there is none
    const Cycles least = times_.bounds.least();
    // Everything before this has happened, and no PE adds to it.
    const Cycles known = std::min(time, least);
    if (times_.releases.least() <= known && known != kNever) {
      NiuNetworkSide& niu = nius_[times_.releases.least_index()];
      // What did not fit into its ring may fit now, and be what it waits for.
      if (!niu.refresh(events_, pool_, times_)) niu.release(known, times_);
      continue;
    }
    if (least > time) {
      event = events_.pop();
      return true;
    }
    if (least == kNever) return false;
    const auto pe = static_cast<unsigned>(times_.bounds.least_index());
    if (nius_[pe].refresh(events_, pool_, times_)) continue;
    nius_[pe].publish_horizon(known);
    fetch_next_turn_ahead();
    await(pe, time);
  }
}

void Emulation::run(const std::function<void(Cycles)>& attend, const std::function<void()>& message_read) {
  attend_ = attend;
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
    trace_hash_ = mix(mix(trace_hash_, event.time), event.order);
    handle(event);
    end_if_failed();
    if (message_read && event.kind == EventKind::host_step) message_read();
    if (--until_attend_ == 0) attend_now_and_then();
  }
  if (!failure_.empty()) throw MachineFailure(failure_);
  torus_.check_slots();
  if (!empty() || !program_->finished()) throw MachineFailure(deadlock_report());
}

void Emulation::go_on_with(HostProgram& program) {
  resumed_ = false;
  program_ = &program;
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

// ---- Deadlock ----

std::string Emulation::report_of(unsigned pe) const {
  constexpr std::array<const char*, 6> kWaits = {"runs",
                                                 "waits to receive",
                                                 "looks for an arrival",
                                                 "waits for a place in its outgoing queue to the torus",
                                                 "waits for a place in its outgoing queue to the bus",
                                                 "has halted"};
  const NiuNetworkSide& niu = nius_[pe];
  return "  PE " + std::to_string(pe) + " (clock " + std::to_string(niu.channel().clock.load()) + ") " +
         kWaits[static_cast<std::size_t>(niu.waits_for())] + "; queued: torus " + std::to_string(torus_.queued(pe)) +
         ", bus " + std::to_string(parts_[pe].outgoing.size()) + ", from the host " +
         std::to_string(host_.waiting(pe)) + "; record slots in use " + std::to_string(niu.slots_used()) +
         (parts_[pe].diverting != kNoBlock ? "; diverts" : "") + "\n";
}

std::string Emulation::deadlock_report() const {
  std::string text = "deadlock at cycle " + std::to_string(now_) +
                     ": nothing can happen any more, and work is outstanding\n  host program: " +
                     (program_->finished() ? "finished" : std::string("waits for ") + program_->waiting_for()) + "; " +
                     std::to_string(host_.inbox()) + " messages not yet read, " +
                     std::to_string(host_.waiting_for_all()) +
                     " broadcasts and what waits for them\n  bus: " + (bus_.busy() ? "busy" : "idle") +
                     "; FBC: " + std::to_string(controller_.waiting()) +
                     " messages; torus: " + std::to_string(torus_.packets_inside()) + " packets\n";
  unsigned reported = 0;
  for (unsigned pe = 0; pe < pes_ && reported < kMostReported; ++pe) {
    const bool plain = nius_[pe].waits_for() == WaitKind::receive && torus_.queued(pe) == 0 &&
                       parts_[pe].outgoing.empty() && host_.waiting(pe) == 0;
    if (plain && pes_ > kMostReported) continue;
    text += report_of(pe);
    ++reported;
  }
  if (reported < pes_) text += "  (other PEs wait to receive, or are like these)\n";
  return text + torus_.report(kMostReported);
}

}  // namespace torolux
