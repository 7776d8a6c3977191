#include "plant/front_end/output_watch.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace hydro::plant {
namespace {

constexpr int kInARow = 2;
constexpr double kUsualTolerance = 0.1;  // V at the terminal: converters' offsets are below it

// Keeps all entries within the patience, and the one before, which acted until the first of them.
template <class Entries>
void Forget(Entries* entries, bus::Clock::TimePoint before) {
  while (entries->size() > 1 && (*entries)[1].at < before) entries->pop_front();
}

// Whether the sample's voltage comes from a command, as the device says.
bool Acts(const hydro_sample& sample) {
  return sample.state == HYDRO_ARMED && sample.source != HYDRO_SOURCE_ZERO;
}

// Of the largest terms: a few steps of single precision, in which another processor may round otherwise.
constexpr double kRounding = 1e-6;

// What a device puts out that is asked for so much, V of eq. (1). Both sides know its limits: the settings
// have the voltage limit, and its IDENTITY has the range of its output.
double Limited(double asked, const hydro_voltage_range& range) {
  return std::clamp(asked, static_cast<double>(range.low), static_cast<double>(range.high));
}

// Adds the fault of a device that says falsely whether its limits have made its voltage smaller.
void LookAtSaturated(const hydro_sample& sample, double asked, const hydro_voltage_range& range,
                     double rounding, std::vector<RigFault>* faults) {
  const bool beyond = asked < range.low - rounding || asked > range.high + rounding;
  const bool within = asked > range.low + rounding && asked < range.high - rounding;
  if (sample.saturated != 0 ? !within : !beyond) return;
  faults->push_back(
      {"output_differs",
       fmt::format("the front end says that its limits {} its voltage (saturated is {}); it was asked for "
                   "{:.4g} V, and its limits are {:.4g} and {:.4g} V",
                   sample.saturated != 0 ? "reduce" : "do not reduce", sample.saturated, asked, range.low,
                   range.high),
       asked, asked < 0 ? range.low : range.high});
}

// What eq. (16) gives for the readings of a sample, and by how much rounding on another processor may change
// it.
struct Computed {
  double voltage;
  double rounding;
};
Computed ByEq16(const hydro_sample& sample, float pressure_ref, const hydro_gains& gains) {
  const hydro_law_input input = {.pressure_ref = pressure_ref,
                                 .p1 = sample.value[HYDRO_P1],
                                 .p2 = sample.value[HYDRO_P2],
                                 .motor_speed = sample.value[HYDRO_MOTOR_SPEED],
                                 .arm_speed = sample.value[HYDRO_ARM_SPEED]};
  const auto size = [](double value) { return std::isfinite(value) ? std::fabs(value) : 0; };
  const double speeds = size(input.motor_speed) + size(gains.arm_speed_ratio) * size(input.arm_speed);
  const double terms =
      size(gains.k_p) * (size(pressure_ref) + size(input.p1) + size(input.p2) + size(gains.k_v) * speeds) +
      size(gains.reference_feedforward) * size(pressure_ref) + size(sample.transfer);
  return {static_cast<double>(hydro_law(&gains, &input) + sample.transfer), kRounding * (1 + terms)};
}

// By how much a change of gains may move eq. (16) for readings as large as those of the sample: the sum of
// its terms, because they may cancel in one tick and not in the next.
double SizeOfChange(const hydro_sample& sample, float pressure_ref, const hydro_gains& from,
                    const hydro_gains& to) {
  const auto size = [](double value) { return std::isfinite(value) ? std::fabs(value) : 0; };
  const double dp = size(sample.value[HYDRO_P2] - sample.value[HYDRO_P1]);
  const double motor = size(sample.value[HYDRO_MOTOR_SPEED]), arm = size(sample.value[HYDRO_ARM_SPEED]);
  const double damping = to.k_p * to.k_v, damped = from.k_p * from.k_v;
  return size(to.k_p - from.k_p) * (size(pressure_ref) + dp) + size(damping - damped) * motor +
         size(damping * to.arm_speed_ratio - damped * from.arm_speed_ratio) * arm +
         size(to.reference_feedforward - from.reference_feedforward) * size(pressure_ref);
}

}  // namespace

OutputWatch::OutputWatch(const settings::DriverSection& driver, bus::Clock::Duration patience,
                         bus::Clock::Duration transfer)
    : own_loop_(driver.front_end.mode == settings::FrontEndMode::kLoopOnDevice),
      patience_(patience),
      transfer_(transfer),
      tolerance_(std::fabs(driver.voltage.scale) * (driver.front_end.read_back_tolerance_V > 0
                                                        ? driver.front_end.read_back_tolerance_V
                                                        : kUsualTolerance)) {}

void OutputWatch::OnTold(uint32_t sequence, double voltage, int64_t command_tick, bus::Clock::TimePoint now) {
  Keep({sequence, voltage, command_tick, now});
}

void OutputWatch::OnTold(uint32_t sequence, float pressure_ref, const hydro_gains& gains,
                         bus::Clock::TimePoint now) {
  if (gains_ && !hydro_same_gains(&*gains_, &gains)) {
    // While one change passes, another one begins at what is left of it.
    left_ = AChangePasses(now) ? left_ + moved_ : 0;
    moved_ = 0;
    gains_changed_at_ = now;
    former_gains_ = *gains_;
  }
  gains_ = gains;
  Keep({sequence, 0, -1, now, ByLaw{pressure_ref, gains}});
}

void OutputWatch::Keep(const Told& told) {
  constexpr uint32_t kFarthest = std::numeric_limits<uint32_t>::max() / 2;  // that is older, and not newer
  if (!first_ || told.sequence - *first_ > kFarthest)
    first_ = first_ ? told.sequence - kFarthest : told.sequence;
  told_.push_back(told);
  Forget(&told_, told.at - patience_);
}

// Of a voltage that was told, and of one by eq. (16), only a command of the same kind is the reason.
const OutputWatch::Told* OutputWatch::Find(const hydro_sample& sample) const {
  if (!Acts(sample)) return nullptr;
  const bool law = sample.source == HYDRO_SOURCE_LAW;
  const auto found = std::find_if(told_.rbegin(), told_.rend(), [&](const Told& told) {
    return told.sequence == sample.command_sequence && told.by_law.has_value() == law;
  });
  return found != told_.rend() ? &*found : nullptr;
}

int64_t OutputWatch::CommandTick(const hydro_sample& sample) const {
  const Told* const told = Find(sample);
  return told != nullptr ? told->command_tick : -1;
}

bool OutputWatch::ActsByLaw(const hydro_sample& sample) const {
  const Told* const told = Find(sample);
  return told != nullptr && told->by_law.has_value();
}

bool OutputWatch::ActsByAnOldCommand(const hydro_sample& sample) const {
  return Acts(sample) && sample.voltage != 0 && Find(sample) == nullptr && !told_.empty() && IsOld(sample);
}

void OutputWatch::Look(const hydro_sample& sample, const hydro_voltage_range& range, uint32_t interval,
                       bus::Clock::TimePoint now, std::vector<RigFault>* faults) {
  const size_t before = faults->size();
  const Told* const told = Find(sample);
  if (told != nullptr && told->by_law) {
    LookAtLaw(sample, *told->by_law, range, now, faults);
  } else {
    LookAtReport(sample, range, faults);
  }
  if (faults->size() == before) LookAtReadBack(sample, interval, now, faults);
}

// The device's own loop may do so, if it was told recently to act by it. So may a command so old that its age
// is the fault, unless all recent commands told zero volts.
bool OutputWatch::MayPutOut(const hydro_sample& sample) const {
  const bool law = sample.source == HYDRO_SOURCE_LAW;
  if (law && !own_loop_) return false;
  return std::any_of(told_.begin(), told_.end(),
                     [&](const Told& told) { return law ? told.by_law.has_value() : told.voltage != 0; });
}

// Whether the command that a sample names may have been sent before those that are kept: as the rig's check
// of its age sees too. A device cannot act by one that comes later, or that is missing among those kept.
bool OutputWatch::IsOld(const hydro_sample& sample) const {
  return first_ && sample.command_sequence - *first_ < told_.front().sequence - *first_;
}

// A device that names a command which was never sent obeys another computer, or invents what it says.
void OutputWatch::LookAtUnsent(const hydro_sample& sample, std::vector<RigFault>* faults) const {
  const auto same = std::find_if(told_.begin(), told_.end(),
                                 [&](const Told& told) { return told.sequence == sample.command_sequence; });
  const std::string found = fmt::format("the front end says that it puts out {:.4g} V by command {}",
                                        sample.voltage, sample.command_sequence);
  const std::string newest =
      told_.empty() ? "none was sent yet" : fmt::format("the newest has number {}", told_.back().sequence);
  faults->push_back(
      {"output_differs",
       same != told_.end()
           ? fmt::format("{} as its source {}, and that command told it {}", found, sample.source,
                         same->by_law ? "a reference for its law (source 2)" : "a voltage (source 1)")
           : fmt::format("{}, which was never sent: {}. It obeys another program, or its firmware makes up "
                         "the number; allowed is the number of a command that was sent",
                         found, newest),
       static_cast<double>(sample.command_sequence),
       told_.empty() ? NAN : static_cast<double>(told_.back().sequence)});
}

bool OutputWatch::AChangePasses(bus::Clock::TimePoint now) const {
  return gains_changed_at_ && now - *gains_changed_at_ <= transfer_ + patience_;
}

// The device holds its voltage when its gains change, and lets the difference pass. It knows the readings of
// that very tick, which no sample may have; those of the samples about it are as large.
double OutputWatch::MostTransfer(const hydro_sample& sample, const ByLaw& told, bus::Clock::TimePoint now) {
  constexpr double kBetweenSamples = 2;  // times: readings swing from one tick to the next
  if (!AChangePasses(now)) return 0;
  if (now - *gains_changed_at_ <= patience_)
    moved_ = std::max(moved_, SizeOfChange(sample, told.pressure_ref, former_gains_, *gains_));
  return kBetweenSamples * (left_ + moved_) + tolerance_;
}

// Holds for an arm that stands still as for one that moves: the sample has all that the law was computed
// from. What a change of gains adds is the device's own word, and only believed while one passes, and up to
// what the change explains.
void OutputWatch::LookAtLaw(const hydro_sample& sample, const ByLaw& told, const hydro_voltage_range& range,
                            bus::Clock::TimePoint now, std::vector<RigFault>* faults) {
  const auto voltage = static_cast<double>(sample.voltage);
  const auto [law, rounding] = ByEq16(sample, told.pressure_ref, told.gains);
  const double expected = Limited(law, range);
  const double most = MostTransfer(sample, told, now);
  if (sample.pressure_ref != told.pressure_ref) {
    faults->push_back(
        {"output_differs",
         fmt::format("the front end says that it acts by a reference of {:.6g}; it was told {:.6g}",
                     sample.pressure_ref, told.pressure_ref),
         sample.pressure_ref, told.pressure_ref});
  } else if (std::fabs(sample.transfer) > most) {
    faults->push_back(
        {"output_differs",
         fmt::format("the front end adds {:.4g} V to eq. (16) for a change of its gains; {}", sample.transfer,
                     most == 0 ? std::string("they have not changed")
                               : fmt::format("theirs explains at most {:.4g} V", most)),
         sample.transfer, most});
  } else if (!(std::fabs(voltage - expected) <= rounding)) {
    faults->push_back(
        {"output_differs",
         fmt::format("the front end says that it puts out {:.4g} V; eq. (16) gives {:.4g} V for the readings "
                     "that it sends",
                     voltage, expected),
         voltage, expected});
  } else {
    LookAtSaturated(sample, law, range, rounding, faults);
  }
}

// A voltage within the limits comes back as it was sent, to the bit; an end of them, to rounding.
void OutputWatch::LookAtReport(const hydro_sample& sample, const hydro_voltage_range& range,
                               std::vector<RigFault>* faults) const {
  const auto voltage = static_cast<double>(sample.voltage);
  const Told* const found = Find(sample);
  if (Acts(sample) && found == nullptr) {
    if (!IsOld(sample)) return LookAtUnsent(sample, faults);
    if (MayPutOut(sample)) return;
  }
  const double told = found != nullptr ? found->voltage : 0;
  const double expected = Limited(told, range);
  const double rounding = kRounding * (1 + std::fabs(told));
  if (expected == told ? voltage == told : std::fabs(voltage - expected) <= rounding) {
    if (found != nullptr) LookAtSaturated(sample, told, range, rounding, faults);
    return;
  }
  const std::string limits =
      expected != told ? fmt::format(", and its limits allow {:.4g} V", expected) : std::string();
  faults->push_back({"output_differs",
                     fmt::format("the front end says that it puts out {:.4g} V; it was told {:.4g} V{}",
                                 voltage, told, limits),
                     voltage, expected});
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
  // NaN alone says that the board cannot read its output.
  if (std::isnan(read_back) || std::fabs(read_back - nearest) <= tolerance_) {
    differing_ = 0;
    differs_since_.reset();
    return false;
  }
  if (!differs_since_) differs_since_ = now;
  if (held_is_known) differing_ = std::min(differing_ + 1, kInARow);
  return differing_ == kInARow || now - *differs_since_ >= patience_;
}

}  // namespace hydro::plant
