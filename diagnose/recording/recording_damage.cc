#include "diagnose/recording/recording_damage.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "base/maths/spread.h"
#include "base/number_text.h"
#include "base/word_list.h"
#include "diagnose/recording/run_data.h"
#include "runs/measured/sample_times.h"

namespace hydro::diagnose {
namespace {

using Run = runs::MeasuredRun;

constexpr double kByChance = 1e-3;  // probability, in each run, that chance holds a value this long
constexpr size_t kShortestHold = 8;
constexpr std::ptrdiff_t kFew = 10;
constexpr double kAboveSteps = 1.5;        // noise over resolution; below it, values repeat naturally
constexpr double kSpike = 8;               // noise units beyond all neighbours
constexpr double kSpreadOfNeighbours = 2;  // and this many times the neighbours' spread
constexpr double kChange = 5;              // and this many times the change that 19 of 20 do not reach
constexpr size_t kNeighbours = 3;          // neighbours on each side
constexpr double kBeyondAll = 10;          // times all other values: no peak in another unit
constexpr size_t kMostSpikes = 50;         // one sample in so many; more belong to the signal

struct Stretch {
  size_t first, last;  // [first, last)
};

std::string Counted(size_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

// Stretches of equal values. The first value of each is a measurement.
std::vector<Stretch> EqualValues(const std::vector<double>& values) {
  std::vector<Stretch> stretches;
  for (size_t i = 0; i < values.size();) {
    size_t end = i + 1;
    while (end < values.size() && values[end] == values[i]) ++end;
    if (end - i > 1) stretches.push_back({i, end});
    i = end;
  }
  return stretches;
}

// Whether noise moves this signal from sample to sample, so that many equal values are not its own.
bool HasNoise(const std::vector<double>& values, double noise) {
  return noise >= kAboveSteps * EstimateResolution(values) && noise >= 1e-4 * maths::RangeOf(values).size();
}

// The noise that moves a signal from sample to sample; 0: none does. A sensor that is stuck for much of a run
// has its noise in the rest of the run. During such a stretch the command has to change: at rest, a sensor
// may well repeat itself.
double MovingNoise(const std::vector<double>& values, const std::vector<double>& command) {
  const double noise = EstimateNoise(values);
  if (noise > 0 && HasNoise(values, noise)) return noise;
  std::vector<double> rest = values;
  const double step = kStepOfCommand * maths::RangeOf(command).size();
  std::ptrdiff_t stuck = 0;
  for (const Stretch& one : EqualValues(values)) {
    if (one.last - one.first < kShortestHold) continue;
    if (++stuck > kFew) return 0;
    const auto from = command.begin() + static_cast<std::ptrdiff_t>(one.first);
    const auto to = command.begin() + static_cast<std::ptrdiff_t>(one.last);
    if (!(maths::RangeOf({from, to}).size() > step)) continue;
    for (size_t i = one.first; i < one.last; ++i) rest[i] = runs::kMissing;
  }
  if (CountValid(rest) < kFewestSamples) return 0;
  const double moving = EstimateNoise(rest);
  return moving > 0 && HasNoise(rest, moving) ? moving : 0;
}

// The change between samples that 19 of 20 changes do not exceed.
double UsualChange(const std::vector<double>& values) {
  std::vector<double> changes;
  for (size_t i = 1; i < values.size(); ++i) {
    const double change = std::abs(values[i] - values[i - 1]);
    if (!std::isnan(change)) changes.push_back(change);
  }
  if (changes.empty()) return 0;
  const auto most = changes.begin() + static_cast<std::ptrdiff_t>(changes.size() * 19 / 20);
  std::nth_element(changes.begin(), most, changes.end());
  return *most;
}

// A few equal values far from those on both sides, and on the same side of both: what a recorder writes for
// "nothing", for example -999.
bool IsSentinel(const std::vector<double>& values, const Stretch& one, double leap) {
  if (one.first == 0 || one.last == values.size() || one.last - one.first >= kShortestHold) return false;
  const double before = values[one.first - 1] - values[one.first];
  const double after = values[one.last] - values[one.first];
  return before * after > 0 &&
         std::min(std::abs(before), std::abs(after)) > leap + kSpreadOfNeighbours * std::abs(after - before);
}

std::vector<Stretch> HeldStretches(const std::vector<double>& values, double noise) {
  if (noise <= 0) return {};
  const std::vector<Stretch> equal = EqualValues(values);
  // How often a value repeats the previous one by chance. A few long stretches are damage; many are the
  // record of a slow sensor.
  const auto is_long = [](const Stretch& one) { return one.last - one.first >= kShortestHold; };
  const bool few = std::ranges::count_if(equal, is_long) <= kFew;
  double repeats = 1;
  for (const Stretch& one : equal) {
    if (!few || !is_long(one)) repeats += static_cast<double>(one.last - one.first - 1);
  }
  const double n = static_cast<double>(values.size());
  const double chance = std::min(0.9, repeats / n);
  const maths::Range range = maths::RangeOf(values);
  const double leap = std::max(kSpike * noise, kChange * UsualChange(values));
  std::vector<Stretch> held;
  for (const Stretch& one : equal) {
    const size_t length = one.last - one.first;
    if (IsSentinel(values, one, leap)) {
      held.push_back(one);
      continue;
    }
    if (length < kShortestHold) continue;
    if (n * std::pow(chance, static_cast<double>(length - 1)) > kByChance) continue;
    // At the end of its range the sensor's reading stays, unless the value is far from those beside it.
    const double value = values[one.first];
    const double before = one.first > 0 ? values[one.first - 1] : value;
    const double after = one.last < values.size() ? values[one.last] : value;
    const bool apart = std::abs(before - value) > 20 * noise && std::abs(after - value) > 20 * noise;
    if ((value == range.low || value == range.high) && !apart) continue;
    // So does that of a speed which is 0: the machine stands still.
    if (value == 0 && !apart) continue;
    // The first value is a measurement, unless it is far from the value before it.
    const bool own = !(std::abs(before - value) > 20 * noise);
    held.push_back({one.first + (own ? 1 : 0), one.last});
  }
  return held;
}

// Cells that no sensor of the machine reads: a few beyond what is possible, and far beyond all others.
std::vector<size_t> ImpossibleCells(const std::vector<double>& values, double possible) {
  std::vector<size_t> cells;
  double nearest = possible, largest = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    const double size = std::abs(values[i]);
    if (size > possible) {
      nearest = cells.empty() ? size : std::min(nearest, size);
      cells.push_back(i);
    } else if (size > largest) {
      largest = size;
    }
  }
  const bool few = cells.size() * kMostSpikes <= values.size();
  return few && nearest > kBeyondAll * largest ? cells : std::vector<size_t>();
}

// The neighbours of a slow sensor's sample are its own samples, not the empty rows between them.
std::vector<size_t> Spikes(const std::vector<double>& all) {
  std::vector<size_t> rows;
  std::vector<double> values;
  for (size_t i = 0; i < all.size(); ++i) {
    if (std::isnan(all[i])) continue;
    rows.push_back(i);
    values.push_back(all[i]);
  }
  const double noise = std::max(EstimateNoise(all), EstimateResolution(values));
  std::vector<size_t> spikes;
  if (noise <= 0) return spikes;
  const double least = std::max(kSpike * noise, kChange * UsualChange(values));
  for (size_t i = kNeighbours; i + kNeighbours < values.size(); ++i) {
    maths::Range beside;
    for (size_t k = i - kNeighbours; k <= i + kNeighbours; ++k) {
      if (k == i) continue;
      beside.low = std::min(beside.low, values[k]);
      beside.high = std::max(beside.high, values[k]);
    }
    const double beyond = std::max(values[i] - beside.high, beside.low - values[i]);
    if (beyond > least + kSpreadOfNeighbours * beside.size()) spikes.push_back(rows[i]);
  }
  // If there are many, they belong to the signal.
  return spikes.size() * kMostSpikes > values.size() ? std::vector<size_t>() : spikes;
}

// Whether the angle beside a speed advances at the held value, to the encoder's steps. A speed that is
// computed from counts repeats itself while they come evenly.
bool TurnsAtHeldSpeed(const Run& run, const runs::SignalName& sensor, const Stretch& held) {
  const runs::MeasuredSignal* angle = sensor.signal == &Run::motor_speed ? &run.motor_angle
                                      : sensor.signal == &Run::arm_speed ? &run.arm_angle
                                                                         : nullptr;
  if (angle == nullptr || !angle->measured()) return false;
  constexpr double kAsFast = 0.02, kSteps = 2;
  const double turned = angle->values[held.last - 1] - angle->values[held.first];
  const double said =
      (run.*sensor.signal).values[held.first] * (run.time[held.last - 1] - run.time[held.first]);
  return std::abs(turned - said) <= kSteps * EstimateResolution(angle->values) + kAsFast * std::abs(turned);
}

// Makes held values and spikes missing, and counts for each row how many sensors hold their value there.
void SetAside(const model::ModelDescription& model, Run* run, std::vector<size_t>* held_there,
              size_t* sensors, std::vector<std::string>* lines) {
  for (const runs::SignalName& sensor : runs::kSignals) {
    if (sensor.standard_deviation == nullptr) continue;  // not a sensor's signal
    std::vector<double>& values = (run->*sensor.signal).values;
    if (values.size() < kFewestSamples) continue;
    // First the impossible: beside it, nothing else in the signal shows.
    std::vector<size_t> spikes = ImpossibleCells(values, LargestPossible(sensor, model));
    for (const size_t i : spikes) values[i] = runs::kMissing;
    const double noise = MovingNoise(values, run->voltage.values);
    std::vector<Stretch> held = HeldStretches(values, noise);
    std::erase_if(held, [&](const Stretch& one) { return TurnsAtHeldSpeed(*run, sensor, one); });
    const std::vector<size_t> others = Spikes(values);
    spikes.insert(spikes.end(), others.begin(), others.end());
    std::ranges::sort(spikes);
    *sensors += noise > 0 ? 1 : 0;
    size_t count = 0;
    for (const Stretch& one : held) {
      for (size_t i = one.first; i < one.last; ++i) {
        values[i] = runs::kMissing;
        ++(*held_there)[i];
        ++count;
      }
    }
    for (const size_t i : spikes) values[i] = runs::kMissing;
    const std::string place = RunNamed(run->name) + ": " + sensor.ours;
    if (count > 0) {
      lines->push_back(place + " repeats one value in " + std::to_string(held.size()) +
                       (held.size() == 1 ? " stretch, " : " stretches, ") + Counted(count, "sample") +
                       " in all, the first at " + ShortNumber(run->time[held.front().first], 6) +
                       " s: dropouts, which count as missing");
    }
    if (!spikes.empty()) {
      lines->push_back(place + " has " + Counted(spikes.size(), "spike") + ", the first at " +
                       ShortNumber(run->time[spikes.front()], 6) + " s; " +
                       (spikes.size() == 1 ? "it counts" : "they count") + " as missing");
    }
  }
}

// Stretches where rows are lost (in time, or held in all sensors) and the command is different after them.
std::vector<Stretch> LostSteps(const Run& run, const std::vector<size_t>& held_there, size_t sensors) {
  const double usual = runs::MedianInterval(run.time);
  const std::vector<double>& voltage = run.voltage.values;
  const double least = kStepOfCommand * maths::RangeOf(voltage).size();
  std::vector<Stretch> lost;
  for (size_t i = 0; i + 1 < run.samples(); ++i) {
    if (run.time[i + 1] - run.time[i] > kGapInTime * usual && std::abs(voltage[i + 1] - voltage[i]) > least) {
      lost.push_back({i + 1, i + 1});
    }
  }
  for (size_t i = 1; i < run.samples() && sensors >= 2;) {
    size_t end = i;
    while (end < run.samples() && held_there[end] >= sensors) ++end;
    if (end == i) {
      ++i;
      continue;
    }
    // A recorder that has stopped also holds the command, which then steps when the rows continue.
    const bool command_held = std::all_of(voltage.begin() + static_cast<std::ptrdiff_t>(i),
                                          voltage.begin() + static_cast<std::ptrdiff_t>(end),
                                          [&](double v) { return v == voltage[i - 1]; });
    if (command_held && end < run.samples() && std::abs(voltage[end] - voltage[i - 1]) > least) {
      lost.push_back({i, end});
    }
    i = end;
  }
  std::ranges::sort(lost, [](const Stretch& a, const Stretch& b) { return a.first < b.first; });
  return lost;
}

// The parts of the run, without the lost stretches.
std::vector<Run> Cut(const Run& run, const std::vector<Stretch>& lost, std::vector<std::string>* lines) {
  std::vector<Run> parts;
  size_t first = 0;
  for (size_t k = 0; k <= lost.size(); ++k) {
    const size_t last = k < lost.size() ? lost[k].first : run.samples();
    if (k < lost.size()) {
      lines->push_back(RunNamed(run.name) + ": the command steps while rows are missing, after " +
                       ShortNumber(run.time[last - 1], 6) + " s: the run is cut in two there");
    }
    if (last >= first + kFewestSamples) {
      parts.push_back(run);
      parts.back().Keep(first, last);
      if (first > 0) parts.back().name += ", from " + ShortNumber(run.time[first], 4) + " s";
    }
    if (k < lost.size()) first = lost[k].last;
  }
  return parts;
}

}  // namespace

std::vector<std::string> SetAsideDamage(const model::ModelDescription& model, std::vector<Run>* runs) {
  std::vector<std::string> lines;
  std::vector<Run> all;
  for (Run& run : *runs) {
    std::vector<size_t> held_there(run.samples(), 0);
    size_t sensors = 0;
    SetAside(model, &run, &held_there, &sensors, &lines);
    const std::vector<Stretch> lost = LostSteps(run, held_there, sensors);
    std::vector<Run> parts;
    if (!lost.empty()) parts = Cut(run, lost, &lines);
    if (parts.empty()) {
      all.push_back(std::move(run));
    } else {
      all.insert(all.end(), std::make_move_iterator(parts.begin()), std::make_move_iterator(parts.end()));
    }
  }
  *runs = std::move(all);
  return lines;
}

}  // namespace hydro::diagnose
