#include "diagnose/locate/disturbance_smoother.h"

#include <algorithm>
#include <cmath>

#include "diagnose/locate/smoother_filter.h"

namespace hydro::diagnose {
namespace {

using smoother::Columns;
using smoother::kColumns;
using smoother::Record;
using smoother::RowOfColumns;
using smoother::Setup;
using smoother::Vector;

// Disturbances that vary this many times more than noise explains may wander further in a second pass.
constexpr double kLoosenAbove = 3;
constexpr double kLoosenAtMost = 200;

SmoothedRun EmptyRun(const Setup& setup) {
  const size_t samples = setup.time.size();
  SmoothedRun run;
  for (auto* values :
       {&run.motor_angle, &run.motor_speed, &run.p1, &run.p2, &run.arm_angle, &run.arm_speed}) {
    values->assign(samples, 0.0);
  }
  for (size_t b = 0; b < kBalances; ++b) {
    if (setup.place[b] < 0) continue;
    run.measured[b] = true;
    Disturbance& d = run.disturbance[b];
    d.value.resize(samples);
    d.informative.resize(samples);
    for (auto& draw : d.noise) draw.resize(samples);
  }
  return run;
}

// Stores a sample's smoothed states and disturbances.
void Keep(const Setup& setup, const Columns& smoothed, const std::array<uint8_t, kBalances>& informative,
          size_t k, SmoothedRun* run) {
  std::vector<double>* const kept[6] = {&run->motor_angle, &run->motor_speed, &run->p1,
                                        &run->p2,          &run->arm_angle,   &run->arm_speed};
  const bool free = setup.free_arm();
  for (int i = 0; i < (free ? 6 : 4); ++i) (*kept[i])[k] = smoothed(i, 0);
  if (!free) {
    const auto& stimulus = setup.run.stimulus;
    const bool driven = stimulus.shaft == model::Shaft::kDriven;
    run->arm_angle[k] = driven ? stimulus.motion->Value(setup.time[k]) : stimulus.arm_angle;
    run->arm_speed[k] = driven ? stimulus.motion->Rate(setup.time[k]) : 0;
  }
  for (size_t b = 0; b < kBalances; ++b) {
    if (setup.place[b] < 0) continue;
    Disturbance& d = run->disturbance[b];
    d.value[k] = smoothed(setup.place[b], 0);
    d.informative[k] = informative[b] && std::isfinite(d.value[k]);
    for (size_t draw = 0; draw < kNoiseDraws; ++draw) {
      d.noise[draw][k] = smoothed(setup.place[b], 1 + static_cast<int>(draw));
    }
  }
}

// The backward pass, after Bryson and Frazier: removes the readings from the record again, last first.
SmoothedRun SmoothBackwards(const Setup& setup, Record record) {
  const size_t samples = setup.time.size();
  SmoothedRun run = EmptyRun(setup);
  Columns adjoint = Columns::Zero(setup.size, kColumns);
  Columns smoothed(setup.size, kColumns);
  Record::Update update;
  Vector gain(setup.size);
  for (size_t k = samples; k-- > 0;) {
    if (k + 1 < samples) {
      smoothed.noalias() = record.transition(k).transpose().lazyProduct(adjoint);
      adjoint = smoothed;
    }
    smoothed = record.state(k);
    smoothed.noalias() -= record.covariance(k).lazyProduct(adjoint);
    Keep(setup, smoothed, record.informative(k), k, &run);
    while (record.Take(k, &update, &gain)) {
      RowOfColumns pulled = update.innovation / update.variance;
      pulled.noalias() += gain.transpose().lazyProduct(adjoint);
      adjoint.noalias() -= setup.sensors[update.sensor].row.lazyProduct(pulled);
    }
  }
  return run;
}

// Mean square change from sample to sample, relative to that of noise alone.
double Unrest(const Disturbance& d) {
  double data = 0, noise = 0;
  for (size_t i = 1; i < d.value.size(); ++i) {
    if (!d.informative[i] || !d.informative[i - 1]) continue;
    const double change = d.value[i] - d.value[i - 1];
    data += change * change;
    for (const auto& draw : d.noise) {
      const double drawn = draw[i] - draw[i - 1];
      noise += drawn * drawn / static_cast<double>(kNoiseDraws);
    }
  }
  return noise > 0 ? data / noise : 1;
}

SmoothedRun Smooth(const Setup& setup) { return SmoothBackwards(setup, smoother::Filter(setup).Run()); }

}  // namespace

SmoothedRun SmoothDisturbances(const model::ModelDescription& model, const RunData& run,
                               const PressureOffsets& offsets) {
  Setup setup = smoother::MakeSetup(model, run, offsets);
  SmoothedRun smoothed = Smooth(setup);
  bool again = false;
  for (size_t b = 0; b < kBalances; ++b) {
    if (setup.place[b] < 0) continue;
    const double loosen = Unrest(smoothed.disturbance[b]);
    if (loosen > kLoosenAbove) {
      setup.wander[b] *= std::min(loosen, kLoosenAtMost);
      again = true;
    }
  }
  return again ? Smooth(setup) : smoothed;
}

}  // namespace hydro::diagnose
