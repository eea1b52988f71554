// SPDX-License-Identifier: MIT
// A packet in, a reply out: what GDB asks, and how it lets PEs go on. An empty reply: this is not known here.
#include <algorithm>

#include "emulator/debugger/registers.hpp"
#include "emulator/debugger/session.hpp"
#include "emulator/debugger/words.hpp"
#include "emulator/errors.hpp"

namespace torolux::debugger {
namespace {

constexpr const char* kError = "E01";
/// Of one packet, so that a reply is no longer than a packet.
constexpr std::uint32_t kMostPart = kMostPacketBytes / 2 - 64;

bool takes_prefix(std::string_view& text, std::string_view prefix) {
  if (!text.starts_with(prefix)) return false;
  text.remove_prefix(prefix.size());
  return true;
}

}  // namespace

Session::Reply Session::answer(const std::string& packet) {
  if (packet.empty()) return "";
  std::string_view rest = std::string_view(packet).substr(1);
  switch (packet.front()) {
    case '?':
      return exit_code_ ? kError : stop_reply(last_, knows_swbreak_);
    case '!':
      return "OK";
    case 'H':
      return choose_thread(rest);
    case 'T': {
      const auto choice = thread_choice(rest);
      const bool lives =
          choice && choice->kind == ThreadChoice::Kind::one && holds(choice->pe) && !execution_.find(choice->pe)->left;
      return lives ? "OK" : kError;
    }
    case 'g':
      return read_registers();
    case 'G':
      return write_registers(rest);
    case 'p':
      return read_one(rest);
    case 'P':
      return write_one(rest);
    case 'm':
      return read_memory(rest);
    case 'M':
      return write_memory(rest, true);
    case 'X':
      return write_memory(rest, false);
    case 'Z':
      return set_point(rest, true);
    case 'z':
      return set_point(rest, false);
    case 'c':
    case 's':
      if (!rest.empty()) return kError;  // from another address: not offered
      return resume(std::vector<ResumeAction>{
          {{packet.front() == 'c' ? Resumption::Kind::goes_on : Resumption::Kind::steps}, to_go_on_}});
    case 'b':
      return packet == "bs" ? step_back() : packet == "bc" ? search_back() : "";
    case 'D':
      return detach(rest);
    case 'k':
      connection_.close();
      if (exit_code_) return std::nullopt;
      throw MachineFailure("the debugger has ended the run");
    case 'q':
    case 'Q':
      return answer_query(packet);
    case 'v':
      return answer_multi_letter(packet);
    default:
      return "";
  }
}

std::string Session::choose_thread(std::string_view text) {
  const char of = text.empty() ? ' ' : text.front();
  const auto choice = thread_choice(text.substr(std::min<std::size_t>(1, text.size())));
  if (!choice || (of != 'g' && of != 'c')) return kError;
  const bool one = choice->kind == ThreadChoice::Kind::one;
  if (one && !holds(choice->pe)) return kError;
  if (of == 'c') to_go_on_ = *choice;
  if (of == 'g' && one) chosen_ = choice->pe;
  return "OK";
}

// ---- Going on, and back ----

Session::Reply Session::resume(const std::optional<std::vector<ResumeAction>>& actions) {
  if (!actions) return kError;
  auto& pes = execution_.pes();
  if (exit_code_) {
    const auto next = std::ranges::find_if(pes, [&](const HeldPe& held) {
      return !held.left && std::ranges::any_of(*actions, [&](const auto& one) { return one.who.holds(held.number); });
    });
    if (next == pes.end()) return kError;
    tell_end(*next);
    return std::nullopt;
  }
  std::vector<ResumeAction> chosen = *actions;
  for (ResumeAction& action : chosen) {
    if (action.who.kind == ThreadChoice::Kind::any) action.who = {ThreadChoice::Kind::one, chosen_};
  }
  execution_.resume(chosen);
  const bool any = std::ranges::any_of(
      pes, [](const HeldPe& held) { return !held.left && held.resumption.kind != Resumption::Kind::held; });
  if (!any) return kError;
  held_ = false;
  return std::nullopt;
}

Session::Reply Session::step_back() {
  if (!options_.goes_back || exit_code_) return kError;
  const unsigned number = to_go_on_.kind == ThreadChoice::Kind::one ? to_go_on_.pe : chosen_;
  HeldPe* const held = execution_.find(number);
  if (held == nullptr || held->pe == nullptr) return kError;
  if (held->steps == 0) {
    tell({.reason = Stop::Reason::past_begins, .pe = number});
    return std::nullopt;
  }
  const auto place =
      static_cast<std::size_t>(std::ranges::find_if(execution_.pes(), [&](const HeldPe& one) { return &one == held; }) -
                               execution_.pes().begin());
  const Position end = now();
  go_back(history_.before(end, place, held->steps - 1),
          {Goal::Kind::place, end, {0, place, held->steps - 1, {.reason = Stop::Reason::step, .pe = number}}});
}

Session::Reply Session::search_back() {
  if (!options_.goes_back || exit_code_) return kError;
  search_before(now());
}

std::string Session::detach(std::string_view process) {
  const auto pe = process.empty() ? std::nullopt : process_in(process.substr(1));
  if (!process.empty() && (!pe || !holds(*pe))) return kError;
  bool all = true;
  for (HeldPe& held : execution_.pes()) {
    if (process.empty() || held.number == *pe) {
      held.left = true;
      held.points.clear();
    }
    all &= held.left;
  }
  if (all) {
    connection_.send("OK");
    connection_.close();
    held_ = false;
    return "";
  }
  return "OK";
}

// ---- Queries ----

std::string Session::features(std::string_view theirs) {
  knows_swbreak_ = theirs.find("swbreak+") != std::string_view::npos;
  knows_processes_ = theirs.find("multiprocess+") != std::string_view::npos;
  return "PacketSize=" + hex(kMostPacketBytes) +
         ";QStartNoAckMode+;multiprocess+;swbreak+;vContSupported+;qXfer:features:read+;qXfer:threads:read+;"
         "qXfer:exec-file:read+" +
         (options_.goes_back ? ";ReverseStep+;ReverseContinue+" : "");
}

/// range: "OFFSET,BYTES". 'l': the last part, 'm': there is more.
std::string Session::part_of(const std::string& whole, std::string_view range) {
  const auto part = memory_range(range);
  if (!part) return kError;
  if (part->address >= whole.size()) return "l";
  const std::string text = whole.substr(part->address, std::min(part->bytes, kMostPart));
  return (part->address + text.size() < whole.size() ? "m" : "l") + text;
}

std::string Session::transfer(std::string_view what) {
  if (takes_prefix(what, "features:read:target.xml:")) return part_of(target_description(), what);
  if (takes_prefix(what, "threads:read::")) return part_of(thread_list(true), what);
  if (takes_prefix(what, "exec-file:read:")) {
    const std::string_view process = take_until(what, ':');
    const auto pe = process.empty() ? std::optional(chosen_) : process_in(process);
    if (!pe || !holds(*pe)) return kError;
    return part_of(std::filesystem::absolute(options_.image_of_pe(*pe)).string(), what);
  }
  return "";
}

std::string Session::thread_list(bool xml) const {
  std::string list = xml ? "<?xml version=\"1.0\"?>\n<threads>\n" : "m";
  for (const HeldPe& held : execution_.pes()) {
    if (held.left) continue;
    if (xml) {
      const std::string pe = std::to_string(held.number);
      list += "<thread id=\"" + thread_name(held.number) + "\" name=\"PE " + pe + "\">column " +
              std::to_string(held.number % options_.columns) + ", row " +
              std::to_string(held.number / options_.columns) + "</thread>\n";
    } else {
      list += (list.size() > 1 ? "," : "") + thread_name(held.number);
    }
  }
  if (xml) return list + "</threads>\n";
  return list.size() > 1 ? list : "l";
}

Session::Reply Session::answer_query(std::string_view packet) {
  if (takes_prefix(packet, "qSupported")) return features(packet);
  if (takes_prefix(packet, "qXfer:")) return transfer(packet);
  if (takes_prefix(packet, "qRcmd,")) {
    const auto command = bytes_in(packet);
    if (!command) return kError;
    return monitor({reinterpret_cast<const char*>(command->data()), command->size()});
  }
  if (packet == "QStartNoAckMode") {
    connection_.leave_out_acknowledgements();
    return "OK";
  }
  if (packet == "qfThreadInfo") return thread_list(false);
  if (packet == "qsThreadInfo") return "l";
  if (packet == "qC") return "QC" + thread_name(chosen_);
  if (packet.starts_with("qAttached")) return "1";
  if (packet.starts_with("qSymbol")) return "OK";
  return "";
}

Session::Reply Session::answer_multi_letter(std::string_view packet) {
  if (packet == "vCont?") return "vCont;c;C;s;S;r";
  if (takes_prefix(packet, "vCont")) return resume(resume_actions(packet));
  if (takes_prefix(packet, "vAttach;")) {
    const auto pe = process_in(packet);
    HeldPe* const held = pe ? execution_.find(*pe) : nullptr;
    if (held == nullptr || exit_code_) return kError;
    held->left = false;
    chosen_ = *pe;
    last_ = {.reason = Stop::Reason::attached, .pe = *pe};
    return stop_reply(last_, knows_swbreak_);
  }
  if (packet.starts_with("vKill;")) {
    connection_.send("OK");
    connection_.close();
    if (exit_code_) return std::nullopt;
    throw MachineFailure("the debugger has ended the run");
  }
  return "";
}

}  // namespace torolux::debugger
