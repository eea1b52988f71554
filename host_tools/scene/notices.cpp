// SPDX-License-Identifier: MIT
// Words refusals, and joins notes of one kind.
#include "host_tools/scene/notices.hpp"

#include "emulator/errors.hpp"

namespace torolux {

void refuse(const Place& place, const std::string& message) {
  throw InputError(place.file.empty() ? message : place.text() + ": " + message);
}

void Notices::note(const std::string& message, const Place& place, const std::string& detail) {
  if (const auto found = number_.find(message); found != number_.end()) {
    ++notices_[found->second].count;
  } else if (notices_.size() == kMostKinds) {
    ++more_;
  } else {
    number_.emplace(message, notices_.size());
    notices_.push_back({message, place, detail, 1});
  }
}

std::vector<std::string> Notices::lines() const {
  std::vector<std::string> lines;
  for (const Notice& notice : notices_) {
    std::string line = notice.first.text() + ": " + notice.message;
    if (!notice.detail.empty()) line += ": " + notice.detail;
    if (notice.count > 1) line += " (and " + std::to_string(notice.count - 1) + " more)";
    lines.push_back(std::move(line));
  }
  if (more_ > 0) lines.push_back(std::to_string(more_) + " more notes, of further kinds");
  return lines;
}

}  // namespace torolux
