#include "diagnose/recording/run_data.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/maths/spread.h"
#include "base/number_text.h"
#include "base/text_file.h"
#include "diagnose/recording/smoothed_motion.h"
#include "model/sides.h"
#include "runs/measured/sample_times.h"

namespace hydro::diagnose {
namespace {

constexpr size_t kFewestOfASignal = 20;  // of one signal, because slower sensors leave gaps

constexpr runs::MeasuredSignal runs::MeasuredRun::*kSignalOf[model::kChannels] = {
    &runs::MeasuredRun::motor_angle, &runs::MeasuredRun::motor_speed, &runs::MeasuredRun::arm_angle,
    &runs::MeasuredRun::arm_speed,   &runs::MeasuredRun::p1,          &runs::MeasuredRun::p2};

[[noreturn]] void Refuse(const std::string& place, const std::string& signal, const std::string& found,
                         const std::string& allowed) {
  throw InputError(place + (signal.empty() ? "" : ": " + signal) + ": found " + found + ", allowed " +
                   allowed);
}

maths::Range UpTo(double size) { return {-size, size}; }

// The arm's angles at which V_1 or V_2 is 0, eqs. (6), (7).
maths::Range StrokeOf(const model::ModelDescription& model) {
  const model::Travel travel = model::TravelOf(model);
  return {travel.least, travel.most};
}

std::string AnglesWithin(const maths::Range& stroke, const std::string& unit) {
  return "angles between " + ShortestNumber(stroke.low) + " and " + ShortestNumber(stroke.high) + " " + unit +
         ", where the model's V_1 and V_2 are above 0";
}

void CheckRange(const runs::MeasuredRun& run, const std::string& name, const std::vector<double>& values,
                const maths::Range& allowed, const std::string& unit) {
  for (size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i]) || (values[i] >= allowed.low && values[i] <= allowed.high)) continue;
    Refuse(run.Place(i), name, ShortestNumber(values[i]) + " " + unit,
           ShortestNumber(allowed.low) + " to " + ShortestNumber(allowed.high) +
               " with this model: is the column in another unit?");
  }
}

// Checks that there are enough values, and that they are not all equal.
void CheckShows(const runs::MeasuredRun& run, const runs::SignalName& row) {
  const std::vector<double>& values = (run.*row.signal).values;
  const size_t valid = CountValid(values);
  if (valid < kFewestOfASignal) {
    Refuse(run.file, row.ours, valid == 0 ? "no value in any row" : std::to_string(valid) + " values",
           std::to_string(kFewestOfASignal) + " values or more, or leave the signal out");
  }
  // An arm may stand still. A simulation without noise also gives a single number for a side on its one-way
  // valve or for a pump that sticks.
  const bool simulated = !run.model_text.empty() && !(run.*row.signal).noise.has_value();
  if (row.arm != 0 || simulated) return;
  size_t first = 0;
  while (std::isnan(values[first])) ++first;
  const bool constant =
      std::ranges::all_of(values, [&](double value) { return std::isnan(value) || value == values[first]; });
  if (!constant) return;
  Refuse(run.Place(first), row.ours,
         ShortestNumber(values[first]) + " " + run.units.UnitFor(row.unit, row.arm) +
             " here and in every later row",
         "a signal that changes, or leave it out");
}

// `values` without the samples at the end of a sensor's range, if there are any. Noise makes neighbours
// differ; where many consecutive values equal the largest or smallest of all, the sensor is at the end of its
// range.
std::vector<double> WithoutEnds(const std::vector<double>& values, const maths::Range& range) {
  constexpr size_t kInARow = 8;
  std::vector<double> rest = values;
  for (const double end : {range.low, range.high}) {
    size_t longest = 0, here = 0;
    for (const double value : values) {
      here = value == end ? here + 1 : 0;
      longest = std::max(longest, here);
    }
    if (longest < kInARow) continue;
    for (double& value : rest) {
      if (value == end) value = runs::kMissing;
    }
  }
  return rest;
}

// The smallest noise to assume: below it, the simulation itself is the source of the noise. A noise that
// shows, or an encoder's steps, counts down to the simulation's tolerance: an angle that turns far has a
// large range, but its sensor is as good as before.
double LeastNoise(double noise, double resolution, double range) {
  constexpr double kShows = 1e-6, kStepsShow = 1e-7, kTolerance = 1e-6;  // of the range
  const bool shows = noise > kShows * range || resolution / std::sqrt(12.0) > kStepsShow * range;
  return (shows ? kTolerance : kNoNoise) * range;
}

SignalData MakeSignal(const runs::MeasuredRun& run, model::Channel channel) {
  const runs::MeasuredSignal& measured = run.*SignalOf(channel).signal;
  SignalData signal;
  signal.channel = channel;
  signal.values = measured.values;
  signal.stated_noise = measured.noise.value_or(runs::kMissing);
  signal.resolution = EstimateResolution(measured.values);
  const maths::Range range = maths::RangeOf(measured.values);
  const double size = range.size();
  if (size == 0) {
    // For a signal that never moves, use the stated noise.
    signal.noise = measured.noise.value_or(1e-5 * std::max(1.0, std::abs(range.high)));
  } else {
    std::vector<double> rest = WithoutEnds(measured.values, range);
    double noise = EstimateNoise(rest);
    // Without noise above the rounding error, saturation cannot be detected: a signal that rests at an end of
    // its motion looks the same.
    if (noise >= 0.6 * signal.resolution && noise >= 1e-4 * size) {
      signal.values = std::move(rest);
    } else {
      noise = EstimateNoise(measured.values);
    }
    signal.noise = std::max(noise, LeastNoise(noise, signal.resolution, size));
  }
  signal.estimated_noise = signal.noise;
  if (measured.noise.has_value()) signal.noise = *measured.noise;
  signal.valid = CountValid(signal.values);
  signal.saturated = CountValid(measured.values) - signal.valid;
  return signal;
}

// The imposed motion of a driven shaft.
std::unique_ptr<trajectory::Trajectory> ImposedMotion(const runs::MeasuredRun& run,
                                                      const model::ModelDescription& model) {
  const SignalData angle = MakeSignal(run, model::Channel::kArmAngle);
  SignalData speed;
  if (run.arm_speed.measured()) speed = MakeSignal(run, model::Channel::kArmSpeed);
  std::unique_ptr<trajectory::Trajectory> motion =
      SmoothMotion(run.time, angle.values, angle.noise, speed.values, speed.noise);
  const maths::Range stroke = StrokeOf(model);
  const std::string unit = ChannelUnit(model::Channel::kArmAngle, run.units);
  CheckRange(run, "arm_angle", angle.values, stroke, unit);
  if (motion->Min() <= stroke.low || motion->Max() >= stroke.high) {
    Refuse(run.file, "arm_angle", "a motion that reaches the end of the stroke", AnglesWithin(stroke, unit));
  }
  return motion;
}

// The values at the samples, interpolated linearly where some are missing.
std::vector<double> Bridged(const std::vector<double>& time, std::vector<double> values) {
  size_t before = values.size();  // the last sample that is present; none yet
  for (size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) continue;
    for (size_t k = before == values.size() ? 0 : before + 1; k < i; ++k) {
      const double part = before == values.size() ? 1 : (time[k] - time[before]) / (time[i] - time[before]);
      values[k] = part == 1 ? values[i] : values[before] + part * (values[i] - values[before]);
    }
    before = i;
  }
  if (before < values.size())
    std::fill(values.begin() + static_cast<std::ptrdiff_t>(before), values.end(), values[before]);
  return values;
}

// The recorded outside influences; empty: none were recorded.
std::vector<model::Surroundings> SurroundingsOf(const runs::MeasuredRun& run) {
  std::vector<model::Surroundings> around;
  if (!run.arm_force.measured() && !run.temperature.measured()) return around;
  around.resize(run.samples());
  const auto set = [&](const runs::MeasuredSignal& signal, double model::Surroundings::*place) {
    if (CountValid(signal.values) == 0) return;
    const std::vector<double> values = Bridged(run.time, signal.values);
    for (size_t i = 0; i < around.size(); ++i) around[i].*place = values[i];
  };
  set(run.arm_force, &model::Surroundings::arm_force);
  set(run.temperature, &model::Surroundings::temperature);
  return around;
}

}  // namespace

double LargestPossible(const runs::SignalName& row, const model::ModelDescription& model) {
  const std::string name = row.ours;
  const maths::Range within = StrokeOf(model);
  const double stroke = std::max(-within.low, within.high);
  if (name == "motor_speed") return 1e5;  // rad/s in every coherent system
  if (name == "motor_angle") return 1e9;
  if (name == "arm_angle") return 2 * stroke;
  if (name == "arm_speed") return 1000 * stroke;
  return model.parameters.beta / 2;  // the oil at half its volume, eq. (5)
}

const runs::SignalName& SignalOf(model::Channel channel) {
  return runs::RowOf(kSignalOf[static_cast<size_t>(channel)]);
}

bool IsCompared(const runs::MeasuredRun& run, model::Channel channel) {
  const runs::SignalName& row = SignalOf(channel);
  return (run.*row.signal).measured() && (row.arm == 0 || run.shaft == model::Shaft::kFree);
}

size_t CountValid(const std::vector<double>& values) {
  return static_cast<size_t>(std::ranges::count_if(values, [](double value) { return !std::isnan(value); }));
}

bool HaveOil(const std::vector<const RunData*>& runs) {
  return std::ranges::any_of(runs, [](const RunData* run) {
    const auto is_pressure = [](const SignalData& signal) {
      return signal.channel == model::Channel::kP1 || signal.channel == model::Channel::kP2;
    };
    return !run->stimulus.bypass || std::ranges::any_of(run->signals, is_pressure);
  });
}

bool AreDriven(const std::vector<const RunData*>& runs) {
  return std::ranges::any_of(runs, [](const RunData* run) {
    const std::vector<double>& command = run->stimulus.voltage;
    return std::ranges::any_of(command, [](double v) { return v != 0; });
  });
}

double ShortestDuration(const std::vector<const RunData*>& runs) {
  double shortest = runs.front()->duration();
  for (const RunData* run : runs) shortest = std::min(shortest, run->duration());
  return shortest;
}

double SampleInterval(const std::vector<const RunData*>& runs) {
  std::vector<const std::vector<double>*> times;
  times.reserve(runs.size());
  for (const RunData* run : runs) times.push_back(&run->stimulus.time);
  return runs::MedianInterval(times);
}

model::Stimulus StimulusOf(const runs::MeasuredRun& run) {
  model::Stimulus stimulus;
  stimulus.shaft = run.shaft;
  stimulus.arm_angle = run.arm_angle_rad;
  stimulus.bypass = run.bypass;
  stimulus.begin = run.Begin();
  stimulus.time = run.time;
  stimulus.voltage = run.voltage.values;
  stimulus.around = SurroundingsOf(run);
  return stimulus;
}

std::vector<const RunData*> PointersTo(const std::vector<RunData>& runs) {
  std::vector<const RunData*> pointers;
  pointers.reserve(runs.size());
  for (const RunData& run : runs) pointers.push_back(&run);
  return pointers;
}

std::vector<model::StartState> MeasuredStarts(const std::vector<const RunData*>& runs) {
  std::vector<model::StartState> starts;
  starts.reserve(runs.size());
  for (const RunData* run : runs) starts.push_back(run->start);
  return starts;
}

std::string ChannelName(model::Channel channel) { return SignalOf(channel).ours; }

std::string ChannelUnit(model::Channel channel, const UnitSystem& units) {
  return units.UnitFor(SignalOf(channel).unit, SignalOf(channel).arm);
}

const SignalData* RunData::Find(model::Channel channel) const {
  for (const SignalData& signal : signals) {
    if (signal.channel == channel) return &signal;
  }
  return nullptr;
}

namespace {

// No unit of any recorder makes a value this large. A larger value is a damaged cell, and its square would
// overflow.
constexpr double kNoSuchValue = 1e15;

void CheckCells(const runs::MeasuredRun& run) {
  for (const runs::SignalName& row : runs::kSignals) {
    const std::vector<double>& values = (run.*row.signal).values;
    const auto bad =
        std::ranges::find_if(values, [](double value) { return std::abs(value) > kNoSuchValue; });
    if (bad == values.end()) continue;
    Refuse(run.Place(static_cast<size_t>(bad - values.begin())), row.ours, ShortestNumber(*bad),
           "-1e15 to 1e15: a damaged cell? Empty it, or write nan");
  }
}

// Later steps put a recording on an even grid. What is missing between its rows may be ten times as many as
// the recording has, or as many as a minute has at 2 kHz: more would make that grid too large.
void CheckGaps(const runs::MeasuredRun& run) {
  constexpr double kTimesTheRows = 10, kAnyway = 120000;
  const double interval = runs::MedianInterval(run.time), rows = static_cast<double>(run.samples());
  const double most = interval * (kTimesTheRows * rows + kAnyway);
  for (size_t i = 1; i < run.samples(); ++i) {
    const double gap = run.time[i] - run.time[i - 1];
    if (gap <= most) continue;
    Refuse(run.file, "time",
           "no row between " + ShortNumber(run.time[i - 1]) + " and " + ShortNumber(run.time[i]) + " s",
           "rows without a gap as long: make a table of what is before it and one of what is after it");
  }
  const double duration = run.time.back() - run.time.front();
  if (duration <= most + interval * rows) return;
  Refuse(run.file, "time",
         "rows of which half are at most " + ShortNumber(interval) + " s apart, and " +
             std::to_string(run.samples()) + " of them in " + ShortNumber(duration) + " s",
         "rows that are about equally far apart: where they were taken evenly, set time = { every = " +
             ShortNumber(duration / (rows - 1), 3) +
             " } in the sidecar; where they come in stretches, make a table of each");
}

}  // namespace

void RequireArmInStroke(const runs::MeasuredRun& run, const model::ModelDescription& model) {
  const maths::Range stroke = StrokeOf(model);
  const bool within = run.arm_angle_rad > stroke.low && run.arm_angle_rad < stroke.high;
  if (run.shaft != model::Shaft::kClamped || within) return;
  const std::string unit = ChannelUnit(model::Channel::kArmAngle, run.units);
  Refuse(run.sidecar.empty() ? run.file : run.sidecar,
         run.units.linear_arm ? "arm_angle" : "arm_angle or arm_angle_rad",
         ShortestNumber(run.arm_angle_rad) + " " + unit + " of a clamped shaft", AnglesWithin(stroke, unit));
}

void CheckUsable(const runs::MeasuredRun& run) {
  if (run.samples() < kFewestSamples) {
    Refuse(run.file, "", std::to_string(run.samples()) + " samples",
           std::to_string(kFewestSamples) + " or more");
  }
  CheckGaps(run);
  CheckCells(run);
  for (size_t place = 0; place < model::kChannels; ++place) {
    const runs::SignalName& row = SignalOf(static_cast<model::Channel>(place));
    if ((run.*row.signal).measured()) CheckShows(run, row);
  }
}

RunData PrepareRun(runs::MeasuredRun run, const model::ModelDescription& model) {
  CheckUsable(run);
  runs::RequirePossibleSamples(run);
  RequireArmInStroke(run, model);
  RunData data;
  data.name = run.name;
  data.stimulus = StimulusOf(run);
  // A thousand times the voltage that saturates the amplifier, eq. (1).
  const runs::SignalName& command = runs::kSignals.front();
  CheckRange(run, runs::KeyIn(run, command), run.voltage.values,
             UpTo(1000 * model.parameters.T_pmax / model.parameters.k_1), runs::UnitIn(run, command));
  for (size_t place = 0; place < model::kChannels; ++place) {
    const auto channel = static_cast<model::Channel>(place);
    const runs::SignalName& row = SignalOf(channel);
    if ((run.*row.signal).measured()) {
      CheckRange(run, row.ours, (run.*row.signal).values, UpTo(LargestPossible(row, model)),
                 run.units.UnitFor(row.unit, row.arm));
    }
    if (!IsCompared(run, channel)) continue;
    SignalData signal = MakeSignal(run, channel);
    if (signal.valid >= kFewestOfASignal) data.signals.push_back(std::move(signal));
  }
  if (data.signals.empty()) {
    Refuse(run.file, "", "no signal to compare with a model",
           std::string("at least one of motor_speed, motor_angle, p1, p2") +
               (run.shaft == model::Shaft::kFree ? ", arm_angle, arm_speed" : ""));
  }
  if (run.shaft == model::Shaft::kDriven) {
    data.motion = ImposedMotion(run, model);
    data.stimulus.motion = data.motion.get();
  }
  SetStart(model.parameters, &data);
  data.measured = std::move(run);
  return data;
}

void MakeNamesUnique(std::vector<RunData>* runs) {
  std::set<std::string> taken;
  for (RunData& run : *runs) {
    const std::string own = run.name;
    for (int number = 2; !taken.insert(run.name).second; ++number) {
      run.name = own + " (" + std::to_string(number) + ")";
    }
  }
}

}  // namespace hydro::diagnose
