// SPDX-License-Identifier: MIT
// The life of a session: turns, stops, going back, the end.
#include "emulator/debugger/session.hpp"

#include <algorithm>

#include "emulator/debugger/words.hpp"
#include "emulator/errors.hpp"

namespace torolux::debugger {
namespace {

using std::chrono::milliseconds;

/// Between two questions whether the run is to end.
constexpr milliseconds kWhile{20};

}  // namespace

Session::Session(SessionOptions options)
    : options_(std::move(options)),
      connection_(options_.place),
      execution_(options_.pes),
      chosen_(options_.pes.front()),
      last_{.reason = Stop::Reason::attached, .pe = options_.pes.front()} {}

// ---- Machines begin and end ----

void Session::begin(std::vector<std::unique_ptr<DebuggedPe>> by_number) {
  execution_.begin(std::move(by_number));
  auto& pes = execution_.pes();
  for (std::size_t i = 0; i < pes.size(); ++i) {
    set_steps(pes[i], from_ != nullptr ? from_->position.places[i].steps : 0, from_ != nullptr);
    pes[i].told_at.reset();
  }
  said_ = from_ != nullptr ? from_->said : 0;
}

SnapshotReader* Session::from() {
  if (from_ == nullptr) return nullptr;
  read_ = 0;
  reader_.emplace([this](std::span<std::byte> out) {
    if (from_->bytes.size() - read_ < out.size()) refuse_snapshot("it ends too early");
    std::ranges::copy(std::span(from_->bytes).subspan(read_, out.size()), out.begin());
    read_ += out.size();
  });
  return &*reader_;
}

bool Session::is_new() {
  if (++said_ <= heard_) return false;
  heard_ = said_;
  return true;
}

void Session::keep_state_if_due() {
  if (!options_.goes_back || !save_) return;
  const auto& pes = execution_.pes();
  std::uint64_t steps = 0;
  for (const HeldPe& held : pes) steps += held.steps;
  if (!history_.is_due(steps)) return;
  for (HeldPe& held : execution_.pes()) {
    if (held.stands_between()) make_due_edits(held);
  }
  SavedState state{now(), said_, {}};
  SnapshotWriter writer([&state](std::span<const std::byte> bytes) {
    state.bytes.insert(state.bytes.end(), bytes.begin(), bytes.end());
  });
  save_(writer);
  writer.flush();
  history_.keep(std::move(state));
}

// ---- Turns ----

void Session::turn(unsigned pe, std::uint64_t until) {
  in_turn_ = true;
  keep_state_if_due();
  if (replay_) {
    replay(pe, until);
  } else {
    if (held_) hold_all();
    if (auto stop = execution_.turn(pe, until)) {
      tell(*stop);
      hold_all();
    }
  }
  in_turn_ = false;
}

/// Ctrl-C, where nobody has a turn: PEs stand where they are.
void Session::look() {
  if (in_turn_ || held_ || replay_) return;
  serve(milliseconds(0));
  if (held_) hold_all();
}

void Session::tell(const Stop& stop) {
  execution_.hold(stop);
  last_ = stop;
  chosen_ = stop.pe;
  held_ = true;
  if (stop.reason == Stop::Reason::held_back) {
    connection_.send("O" + hex_of("PE " + std::to_string(stop.pe) +
                                  " can go no further while other PEs are held. To let all go on: "
                                  "set schedule-multiple on\n"));
  }
  connection_.send(stop_reply(stop, knows_swbreak_));
}

void Session::hold_all() {
  while (held_) {
    if (options_.goes_on && !options_.goes_on()) throw Interrupted("the run was interrupted");
    if (const std::string why = gives_up(); !why.empty()) throw MachineFailure(why);
    serve(kWhile);
  }
}

void Session::serve(milliseconds longest) {
  const auto item = connection_.next(longest);
  if (connection_.has_ended()) return let_go();
  if (!item) return;
  if (item->kind == PacketReader::Item::Kind::interrupt) {
    if (!held_ && !exit_code_) tell({.reason = Stop::Reason::interrupt, .pe = chosen_});
    return;
  }
  if (const Reply reply = answer(item->contents)) connection_.send(*reply);
}

/// The debugger is gone: the run goes on as if there had been none.
void Session::let_go() {
  for (HeldPe& held : execution_.pes()) held.left = true;
  held_ = false;
}

// ---- Going back ----

void Session::go_back(std::shared_ptr<const SavedState> state, Goal goal) {
  from_ = std::move(state);
  replay_.emplace(execution_, std::move(goal));
  held_ = false;
  in_turn_ = false;
  throw GoesBack();
}

/// For the last place before `end` at which to stop.
void Session::search_before(const Position& end) {
  go_back(history_.before(end), {Goal::Kind::search, end, {}});
}

void Session::replay(unsigned pe, std::uint64_t until) {
  if (!replay_->turn(pe, until)) return;
  const Goal goal = replay_->goal();
  if (goal.kind == Goal::Kind::search) {
    if (const auto& found = replay_->found()) {
      go_back(history_.before(goal.end, found->place, found->steps), {Goal::Kind::place, goal.end, *found});
    }
    if (from_ != nullptr) search_before(Position(from_->position));
    const unsigned first = execution_.pes().front().number;
    go_back(nullptr, {Goal::Kind::place, goal.end, {0, 0, 0, {.reason = Stop::Reason::past_begins, .pe = first}}});
  }
  replay_.reset();
  tell(goal.target.stop);
  hold_all();
}

// ---- The end ----

void Session::tell_end(HeldPe& held) {
  held.left = true;
  const std::string process = knows_processes_ ? ";process:" + hex(held.number + 1) : "";
  connection_.send("W0" + hex(static_cast<unsigned>(*exit_code_)) + process);
}

void Session::finish(int exit_code, const std::string& text) {
  exit_code_ = exit_code;
  if (connection_.has_ended()) return;
  if (!text.empty()) connection_.send("O" + hex_of(text + "\n"));
  if (HeldPe* const held = execution_.find(chosen_)) tell_end(*held);
  held_ = true;
  while (!connection_.has_ended()) {
    if ((options_.goes_on && !options_.goes_on()) || !gives_up().empty()) return;
    const bool all_told = std::ranges::all_of(execution_.pes(), [](const HeldPe& held) { return held.left; });
    if (all_told) return;
    serve(kWhile);
  }
}

}  // namespace torolux::debugger
