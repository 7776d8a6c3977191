#include "plant/driver/device_watch.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "bus/output_left.h"

namespace hydro::plant {

DeviceWatch::DeviceWatch(const DeviceDescription& description, bus::Clock::Duration patience,
                         bus::Clock::TimePoint now)
    : name_(description.name), output_(description.output), patience_(patience), heard_(now) {}

void DeviceWatch::OnDriven(double output, bus::Clock::TimePoint now) {
  driven_.emplace_back(now, output);
  while (driven_.size() > 1 && now - driven_[1].first > patience_) driven_.pop_front();
}

bool DeviceWatch::Look(const DeviceReadings& readings, bus::Clock::TimePoint now,
                       std::vector<RigFault>* faults) {
  // A reading from the future is a wrong clock of the driver; it would hide the silence of its device.
  for (const Reading& reading : readings.inputs) {
    if (reading.at - now <= kClockError) heard_ = std::max(heard_, std::min(reading.at, now));
  }
  const bool silent = now - heard_ > patience_;
  if (silent) {
    const double allowed = bus::ToSeconds(patience_), found = bus::ToSeconds(now - heard_);
    faults->push_back({"device_silent",
                       fmt::format("nothing has come from {} for longer than {:.4g} s "
                                   "(limits.stale_input_s): is it on, and connected?",
                                   name_, allowed),
                       found, allowed});
  }
  if (!readings.fault.empty()) {
    faults->push_back(
        {"device_fault",
         fmt::format("{} reports {}", name_, bus::ReasonText(readings.fault, "a fault without words"))});
  }
  LookAtOutput(readings.output, now, faults);
  return silent;
}

void DeviceWatch::LookAtOutput(const Reading& output, bus::Clock::TimePoint now,
                               std::vector<RigFault>* faults) {
  if (std::isnan(output.value) || driven_.empty()) return;
  const bool timed = output.at != bus::Clock::TimePoint{};
  if (timed && now - output.at > patience_) return;  // what a silent device said last is no reading
  // A device answers a little later, so it may hold any output that was put out within the patience.
  while (driven_.size() > 1 && now - driven_[1].first > patience_) driven_.pop_front();
  const auto [least, most] = std::minmax_element(
      driven_.begin(), driven_.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  const double nearest = std::clamp(output.value, least->second, most->second);
  if (std::fabs(output.value - nearest) <= output_.tolerance) return;
  faults->push_back({"output_differs",
                     fmt::format("the output of {} reads back {:.4g} {unit}; {:.4g} {unit} was put out",
                                 name_, output.value, nearest, fmt::arg("unit", output_.unit)),
                     output.value, nearest});
}

}  // namespace hydro::plant
