#include "plant/front_end/output_watch.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

namespace hydro::plant {
namespace {

constexpr int kInARow = 2;
constexpr double kUsualTolerance = 0.1;  // V at the terminal: converters' offsets are below it

// Keeps all entries within the patience, and the one before, which acted until the first of them.
template <class Entries>
void Forget(Entries* entries, bus::Clock::TimePoint before) {
  while (entries->size() > 1 && (*entries)[1].at < before) entries->pop_front();
}

bool Acts(const hydro_sample& sample) {
  return sample.state == HYDRO_ARMED && sample.source == HYDRO_SOURCE_VOLTAGE;
}

}  // namespace

OutputWatch::OutputWatch(const settings::DriverSection& driver, bus::Clock::Duration patience)
    : own_loop_(driver.front_end.mode == settings::FrontEndMode::kLoopOnDevice),
      patience_(patience),
      tolerance_(std::fabs(driver.voltage.scale) * (driver.front_end.read_back_tolerance_V > 0
                                                        ? driver.front_end.read_back_tolerance_V
                                                        : kUsualTolerance)) {}

void OutputWatch::OnTold(uint32_t sequence, double voltage, int64_t command_tick, bus::Clock::TimePoint now) {
  told_.push_back({sequence, voltage, command_tick, now});
  Forget(&told_, now - patience_);
}

const OutputWatch::Told* OutputWatch::Find(const hydro_sample& sample) const {
  if (!Acts(sample)) return nullptr;
  const auto found = std::find_if(told_.rbegin(), told_.rend(),
                                  [&](const Told& told) { return told.sequence == sample.command_sequence; });
  return found != told_.rend() ? &*found : nullptr;
}

int64_t OutputWatch::CommandTick(const hydro_sample& sample) const {
  const Told* const told = Find(sample);
  return told != nullptr ? told->command_tick : -1;
}

void OutputWatch::Look(const hydro_sample& sample, uint32_t interval, bus::Clock::TimePoint now,
                       std::vector<RigFault>* faults) {
  const size_t before = faults->size();
  LookAtReport(sample, faults);
  if (faults->size() == before) LookAtReadBack(sample, interval, now, faults);
}

// The device's own loop may do so, where it has one. So may a command so old that its age is the fault,
// unless all recent commands told zero.
bool OutputWatch::MayPutOut(const hydro_sample& sample) const {
  if (sample.source == HYDRO_SOURCE_LAW) return own_loop_;
  return std::any_of(told_.begin(), told_.end(), [](const Told& told) { return told.voltage != 0; });
}

// Where its range ends, a device may put out less than it was told, and reports that; it never puts out more,
// and never the other sign.
void OutputWatch::LookAtReport(const hydro_sample& sample, std::vector<RigFault>* faults) const {
  const auto voltage = static_cast<double>(sample.voltage);
  const Told* const found = Find(sample);
  const bool armed = sample.state == HYDRO_ARMED && sample.source != HYDRO_SOURCE_ZERO;
  if (armed && found == nullptr && MayPutOut(sample)) return;
  const double told = found != nullptr ? found->voltage : 0;
  const bool less = sample.saturated != 0 && voltage * told >= 0 && std::fabs(voltage) <= std::fabs(told);
  if (voltage == told || less) return;
  faults->push_back(
      {"output_differs",
       fmt::format("the front end says that it puts out {:.4g} V; it was told {:.4g} V", voltage, told),
       voltage, told});
}

// The read-back was measured before the device put out the voltage of this sample. The output takes a while
// to follow, so it may hold anything that the device reported recently. Its earlier voltage is not known when
// the sample before was lost, or when a loop on the device has had ticks between the two samples. A swing of
// that loop's voltage that no sample shows is short; a wrong output is not.
void OutputWatch::LookAtReadBack(const hydro_sample& sample, uint32_t interval, bus::Clock::TimePoint now,
                                 std::vector<RigFault>* faults) {
  reported_.push_back({sample.voltage, now});
  Forget(&reported_, now - patience_);
  const bool next = last_tick_ && sample.tick == *last_tick_ + interval;
  last_tick_ = sample.tick;
  const auto read_back = static_cast<double>(sample.read_back);
  const auto [least, most] =
      std::minmax_element(reported_.begin(), reported_.end(),
                          [](const PutOut& a, const PutOut& b) { return a.voltage < b.voltage; });
  const double nearest = std::clamp(read_back, least->voltage, most->voltage);
  if (!Differs(read_back, nearest, next && (interval == 1 || sample.source != HYDRO_SOURCE_LAW), now)) return;
  faults->push_back(
      {"output_differs",
       fmt::format("the front end's output reads back {:.4g} V; {:.4g} V was put out", read_back, nearest),
       read_back, nearest});
}

bool OutputWatch::Differs(double read_back, double nearest, bool held_is_known, bus::Clock::TimePoint now) {
  if (!std::isfinite(read_back) || std::fabs(read_back - nearest) <= tolerance_) {
    differing_ = 0;
    differs_since_.reset();
    return false;
  }
  if (!differs_since_) differs_since_ = now;
  if (held_is_known) differing_ = std::min(differing_ + 1, kInARow);
  return differing_ == kInARow || now - *differs_since_ >= patience_;
}

}  // namespace hydro::plant
