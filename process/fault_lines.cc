#include "process/fault_lines.h"

#include <algorithm>

namespace hydro::process {

using TimePoint = bus::Clock::TimePoint;

bool FaultLines::Show(const std::string& code, TimePoint now) {
  Lines& lines = lines_.try_emplace(code, Lines{.filled = now}).first->second;
  const auto periods = (now - lines.filled) / kPeriod;
  lines.left = static_cast<int>(std::min<int64_t>(kAtOnce, lines.left + periods));
  lines.filled = lines.left == kAtOnce ? now : lines.filled + periods * kPeriod;
  lines.changed = now;
  if (lines.left > 0 && lines.hidden == 0) {
    --lines.left;
    return true;
  }
  if (lines.hidden++ == 0) lines.hidden_since = now;
  return false;
}

bool FaultLines::hides(const std::string& code) const {
  const auto found = lines_.find(code);
  return found != lines_.end() && found->second.hidden > 0;
}

TimePoint FaultLines::DueOf(const Lines& lines) {
  if (lines.hidden == 0) return TimePoint::max();
  const TimePoint settled = std::min<TimePoint>(lines.changed + kQuiet, lines.hidden_since + kPeriod);
  return lines.said == TimePoint::min() ? settled : std::max<TimePoint>(settled, lines.said + kPeriod);
}

TimePoint FaultLines::due() const {
  TimePoint due = TimePoint::max();
  for (const auto& [code, lines] : lines_) due = std::min(due, DueOf(lines));
  return due;
}

std::vector<FaultLines::LeftOut> FaultLines::TakeDue(TimePoint now, bool at_end) {
  std::vector<LeftOut> left_out;
  for (auto& [code, lines] : lines_) {
    if (lines.hidden == 0 || (!at_end && now < DueOf(lines))) continue;
    left_out.push_back({code, lines.hidden});
    lines.hidden = 0;
    lines.said = now;
  }
  return left_out;
}

}  // namespace hydro::process
