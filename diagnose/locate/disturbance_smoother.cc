#include "diagnose/locate/disturbance_smoother.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <random>

#include "diagnose/data/observed_mode.h"
#include "diagnose/data/sample_interval.h"
#include "diagnose/locate/smoother_record.h"
#include "model/equations.h"
#include "model/linearise.h"

namespace hydro::diagnose {

namespace {

using smoother::Columns;
using smoother::kColumns;
using smoother::Matrix;
using smoother::Record;
using smoother::RowOfColumns;
using smoother::Vector;

// How fast a disturbance may be followed, 1/s: fast enough that friction that turns round is not taken for
// flow.
constexpr double kBandwidth = 500;
constexpr double kBandwidthPerSample = 0.35;
// Disturbances that vary so much more than noise explains are allowed to, in a second pass.
constexpr double kLoosenAbove = 3;
constexpr double kLoosenAtMost = 200;
constexpr double kSwitching = 0.02;  // s

struct Sensor {
  model::Channel channel = model::Channel::kP1;
  const std::vector<double>* values = nullptr;
  double offset = 0, variance = 0;
  std::vector<float> repeats;  // samples that a reading stays the same; empty where noise hides the steps
  Vector row;                  // d reading/d state
  std::array<std::vector<float>, kNoiseDraws> noise;
};

double ChannelNoise(const SignalData& signal) {
  double noise = std::max(signal.noise, signal.resolution / std::sqrt(12.0));
  if (noise > 0) return noise;
  double low = 0, high = 0;
  for (const double value : signal.values) {
    if (std::isnan(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  return std::max(1e-6 * (high - low), 1e-12);
}

// How long each run of equal values is, a value each sample.
std::vector<float> Repeats(const std::vector<double>& values) {
  std::vector<float> repeats(values.size());
  for (size_t i = 0; i < values.size();) {
    size_t end = i + 1;
    while (end < values.size() && values[end] == values[i]) ++end;
    std::fill(repeats.begin() + static_cast<std::ptrdiff_t>(i),
              repeats.begin() + static_cast<std::ptrdiff_t>(end), static_cast<float>(end - i));
    i = end;
  }
  return repeats;
}

class Smoother {
 public:
  Smoother(const model::ModelDescription& model, const RunData& run, const PressureOffsets& offsets)
      : model_(model), run_(run), time_(run.stimulus.time), observed_(ObserveMode(run)) {
    model::ActuatorOptions options;
    options.shaft = run.stimulus.shaft;
    options.arm_angle =
        run.stimulus.shaft == model::Shaft::kFree ? run.start[model::kArmAngle] : run.stimulus.arm_angle;
    options.motion = run.stimulus.motion;
    options.bypass = run.stimulus.bypass;
    options_ = options;
    const model::Equations equations(model, options);
    states_ = equations.states();
    for (double& p : observed_.p1) p -= offsets.p1;
    for (double& p : observed_.p2) p -= offsets.p2;
    ChooseSensors(offsets);
    ChooseBalances(equations);
  }

  SmoothedRun Run() {
    Pass();
    bool again = false;
    for (size_t b = 0; b < kBalances; ++b) {
      if (place_[b] < 0) continue;
      const double loosen = Unrest(result_.disturbance[b]);
      if (loosen > kLoosenAbove) {
        wander_[b] *= std::min(loosen, kLoosenAtMost);
        again = true;
      }
    }
    if (again) Pass();
    return std::move(result_);
  }

 private:
  void ChooseSensors(const PressureOffsets& offsets) {
    std::mt19937_64 random(20240229);
    for (const SignalData& signal : run_.signals) {
      const bool arm =
          signal.channel == model::Channel::kArmAngle || signal.channel == model::Channel::kArmSpeed;
      if (arm && run_.stimulus.shaft != model::Shaft::kFree) continue;
      Sensor sensor;
      sensor.channel = signal.channel;
      sensor.values = &signal.values;
      if (signal.channel == model::Channel::kP1) sensor.offset = offsets.p1;
      if (signal.channel == model::Channel::kP2) sensor.offset = offsets.p2;
      const double noise = ChannelNoise(signal);
      // While a coarse reading stays the same so does its error: it counts once.
      const bool coarse = signal.resolution > 0 && noise < 0.6 * signal.resolution;
      sensor.variance = noise * noise;
      if (coarse) sensor.repeats = Repeats(signal.values);
      std::normal_distribution<double> normal(0, noise);
      for (auto& draw : sensor.noise) {
        draw.resize(signal.values.size());
        for (size_t k = 0; k < draw.size(); ++k) {
          const bool same = coarse && k > 0 && signal.values[k] == signal.values[k - 1];
          draw[k] = same ? draw[k - 1] : static_cast<float>(normal(random));
        }
      }
      sensors_.push_back(std::move(sensor));
    }
  }

  double Variance(model::Channel channel) const {
    for (const Sensor& sensor : sensors_) {
      if (sensor.channel == channel) return sensor.variance;
    }
    return 0;
  }

  // How much a balance's disturbance may wander: as much as makes the smoother follow it with the bandwidth,
  // were there only the sensor of the quantity that the balance moves. `gain` is its rate per disturbance.
  double Wander(double gain, double rate_variance, double integral_variance) const {
    const double step = MedianInterval(time_);
    const double bandwidth = std::min(kBandwidth, kBandwidthPerSample / step);
    double wander = std::numeric_limits<double>::infinity();
    if (rate_variance > 0) wander = std::pow(bandwidth, 4) * rate_variance * step / (gain * gain);
    if (integral_variance > 0) {
      wander = std::min(wander, std::pow(bandwidth, 6) * integral_variance * step / (gain * gain));
    }
    return wander;
  }

  void ChooseBalances(const model::Equations& equations) {
    const model::Parameters& p = model_.parameters;
    const double volume = p.beta / p.V_ms;
    const bool bypass = run_.stimulus.bypass;
    const std::array<double, kBalances> wander = {
        Wander(1 / p.J, Variance(model::Channel::kMotorSpeed), Variance(model::Channel::kMotorAngle)),
        bypass ? INFINITY : Wander(volume, Variance(model::Channel::kP1), 0),
        bypass ? INFINITY : Wander(volume, Variance(model::Channel::kP2), 0),
        run_.stimulus.shaft == model::Shaft::kFree
            ? Wander(1 / p.J_a, Variance(model::Channel::kArmSpeed), Variance(model::Channel::kArmAngle))
            : INFINITY};
    size_ = states_;
    for (size_t b = 0; b < kBalances; ++b) {
      place_[b] = -1;
      wander_[b] = 0;
      if (!std::isfinite(wander[b])) continue;
      place_[b] = size_++;
      wander_[b] = wander[b];
    }
    // The sensors read a linear function of the states.
    double state[model::kMaxStates];
    model::Mode mode;
    BeginState(equations, state, &mode);
    const model::LinearModel linear = model::Linearise(equations, time_[0], 0, mode, state);
    for (Sensor& sensor : sensors_) {
      const size_t channel = static_cast<size_t>(sensor.channel);
      sensor.row = Vector::Zero(size_);
      for (int j = 0; j < states_; ++j) sensor.row[j] = linear.C[channel + j * model::kChannels];
      if (sensor.channel != model::Channel::kP1 && sensor.channel != model::Channel::kP2) continue;
      // The valves feel the pressure, not the reading.
      const bool first = sensor.channel == model::Channel::kP1;
      const int at = first ? model::kP1 : model::kP2;
      const double gain = sensor.row[at];
      std::vector<double>& observed = first ? observed_.p1 : observed_.p2;
      if (gain == 0) {
        observed.clear();  // it reads what a state of its own has made of the pressure
        continue;
      }
      const double offset = linear.output[channel] - gain * state[at];
      for (double& value : observed) value = (value - offset) / gain;
    }
  }

  void BeginState(const model::Equations& equations, double* state, model::Mode* mode) const {
    const double pressure = std::max({run_.start[model::kP1], run_.start[model::kP2], model_.parameters.p_3});
    equations.Start(pressure, state, mode);
    const int base = run_.stimulus.shaft == model::Shaft::kFree ? 6 : 4;
    for (int i = 0; i < base; ++i) state[i] = run_.start[i];
  }

  Matrix BeginCovariance(const model::Equations& equations) const {
    Matrix covariance = Matrix::Zero(size_, size_);
    for (int i = 0; i < states_; ++i) {
      const double scale = equations.scales()[i];
      covariance(i, i) = scale * scale;
    }
    const double step = MedianInterval(time_);
    for (size_t b = 0; b < kBalances; ++b) {
      // What wanders in the time that a disturbance is followed in, and a good deal more.
      if (place_[b] >= 0) covariance(place_[b], place_[b]) = 100 * wander_[b] * std::max(step, 0.1);
    }
    return covariance;
  }

  enum class Rest { kAbove, kNear, kAt, kBelow };

  // Where a side's pressure is against p_3.
  Rest RestOf(int side, size_t k, double pressure, double p_3) const {
    const std::vector<double>& measured = side == 0 ? observed_.p1 : observed_.p2;
    const double margin = side == 0 ? observed_.p1_margin : observed_.p2_margin;
    if (measured.empty() || std::isnan(measured[k]))
      return pressure <= p_3 + std::max(margin, 1e-3 * std::abs(p_3)) ? Rest::kAt : Rest::kAbove;
    // Below p_3 no one-way valve holds it: the flow that does is what is missing.
    if (measured[k] < p_3 - margin) return Rest::kBelow;
    if (measured[k] <= p_3 + margin) return Rest::kAt;
    const size_t reach = 2 * observed_.half_window + 1;
    const size_t end = std::min(measured.size(), k + reach + 1);
    for (size_t i = k < reach ? 0 : k - reach; i < end; ++i) {
      if (measured[i] <= p_3 + margin && measured[i] >= p_3 - margin) return Rest::kNear;
    }
    return Rest::kAbove;
  }

  // The pump's and the valves' switches from what was measured, else from the state.
  void SetMode(const model::Equations& equations, size_t k, double voltage, const double* state,
               model::Mode* mode, model::Terms<double>* terms, double* rate,
               std::array<uint8_t, kBalances>* informative) {
    const double time = time_[k];
    model::Mode open = *mode;
    open.pump = 0;
    open.valve_1 = open.valve_2 = 0;
    const int8_t before = mode->pump;
    equations.Evaluate(time, voltage, open, state, rate, terms);
    informative->fill(1);
    const auto breaks_away = [&] {
      if (std::abs(terms->net_torque) <= terms->breakaway) return 0;
      return terms->net_torque > 0 ? 1 : -1;
    };
    if (observed_.speed_measured()) {
      mode->pump = observed_.turns[k];
      // The model says that it should turn, the data that it rests: friction holds it beyond its limit.
      if (mode->pump == 0) mode->pump = static_cast<int8_t>(breaks_away());
      if (observed_.passes[k]) (*informative)[0] = 0;
    } else if (before == 0 || before * state[model::kMotorSpeed] <= 0) {
      mode->pump = static_cast<int8_t>(breaks_away());
    }
    if (mode->pump == 0) (*informative)[0] = 0;

    const std::array<double, 2> free_rate = {terms->free_rate_1, terms->free_rate_2};
    for (int side = 0; side < 2; ++side) {
      const double pressure = state[side == 0 ? model::kP1 : model::kP2];
      const Rest rest = RestOf(side, k, pressure, terms->p_3);
      at_valve_[side] = rest == Rest::kNear || rest == Rest::kAt;
      if (!equations.data().ideal_valves) continue;
      int8_t& valve = side == 0 ? mode->valve_1 : mode->valve_2;
      valve = at_valve_[side] && free_rate[side] < 0 ? 1 : 0;
      // Just before it opens and just after it closes, an average cannot tell on which side of p_3 it is.
      if (at_valve_[side]) (*informative)[1 + side] = 0;
      free_rate_[side] = free_rate[side];
    }
    if (run_.stimulus.bypass) mode->valve_2 = 0;
    equations.Evaluate(time, voltage, *mode, state, rate, terms);
    // An arm that an effect holds at rest feels no further torque.
    if (run_.stimulus.shaft == model::Shaft::kFree && rate[model::kArmSpeed] == 0) (*informative)[3] = 0;
  }

  void Pass();
  void Measure(const model::Equations& equations, size_t k, double* state, Matrix* covariance,
               Columns* columns, Record* record) const;
  void Smooth(Record& record);
  void Keep(double* state, const model::Equations& equations) const;

  // Mean square change from sample to sample against that of noise alone.
  double Unrest(const Disturbance& d) const {
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

  const model::ModelDescription& model_;
  const RunData& run_;
  const std::vector<double>& time_;
  ObservedMode observed_;
  model::ActuatorOptions options_;
  std::vector<Sensor> sensors_;
  int states_ = 0, size_ = 0;
  std::array<int, kBalances> place_{};  // of each disturbance among the states, -1: none
  std::array<double, kBalances> wander_{};
  std::array<bool, 2> at_valve_{};     // near p_3: the valve may be either way
  std::array<double, 2> free_rate_{};  // of p1, p2 were it closed
  std::vector<double> switched_;       // when a switch of an effect changed
  SmoothedRun result_;
};

// Volumes stay above 0 whatever a filter makes of the arm's angle.
void Smoother::Keep(double* state, const model::Equations& equations) const {
  if (run_.stimulus.shaft != model::Shaft::kFree) return;
  const model::Parameters& p = model_.parameters;
  const double limit = 0.98 * (p.V_ms - equations.data().fixed_volume) / p.c;
  state[model::kArmAngle] = std::clamp(state[model::kArmAngle], -limit, limit);
}

void Smoother::Measure(const model::Equations& equations, size_t k, double* state, Matrix* covariance,
                       Columns* columns, Record* record) const {
  const model::Measurement predicted = equations.Measure(time_[k], state);
  const Vector before = columns->col(0);
  Vector gain(size_);
  for (size_t s = 0; s < sensors_.size(); ++s) {
    const Sensor& sensor = sensors_[s];
    const double value = (*sensor.values)[k];
    if (std::isnan(value)) continue;
    Record::Update update;
    update.sensor = static_cast<int>(s);
    gain.noalias() = covariance->lazyProduct(sensor.row);
    const double repeats = sensor.repeats.empty() ? 1 : sensor.repeats[k];
    update.variance = sensor.row.dot(gain) + sensor.variance * repeats;
    gain /= update.variance;
    update.innovation.noalias() = -sensor.row.transpose().lazyProduct(*columns);
    update.innovation[0] = value - sensor.offset -
                           model::ChannelOf(predicted, static_cast<size_t>(sensor.channel)) -
                           sensor.row.dot(columns->col(0) - before);
    for (size_t draw = 0; draw < kNoiseDraws; ++draw) {
      update.innovation[1 + static_cast<int>(draw)] += static_cast<double>(sensor.noise[draw][k]);
    }
    columns->noalias() += gain.lazyProduct(update.innovation);
    covariance->noalias() -= update.variance * gain.lazyProduct(gain.transpose());
    record->Add(k, update, gain);
  }
  for (int i = 0; i < states_; ++i) state[i] = (*columns)(i, 0);
}

void Smoother::Pass() {
  model::Equations equations(model_, options_);
  const size_t samples = time_.size();
  double state[model::kMaxStates];
  model::Mode mode;
  BeginState(equations, state, &mode);
  const Matrix first_covariance = BeginCovariance(equations);
  Matrix covariance = first_covariance;
  Columns columns = Columns::Zero(size_, kColumns);
  for (int i = 0; i < states_; ++i) columns(i, 0) = state[i];
  Record record(samples, size_);
  Matrix rates = Matrix::Zero(size_, size_);
  Matrix term(size_, size_), power(size_, size_), square(size_, size_), transition(size_, size_);
  double rate[model::kMaxStates], jacobian[model::kMaxStates * model::kMaxStates];
  model::Terms<double> terms;
  const std::vector<double>& scales = equations.scales();
  const double speed_wander = 0.3 * observed_.speed_margin;
  switched_.clear();
  equations.PassStop(time_[0]);

  for (size_t k = 0; k < samples; ++k) {
    Measure(equations, k, state, &covariance, &columns, &record);
    if (!columns.allFinite() || !covariance.allFinite()) {
      // Lost: begin again from what is measured next.
      BeginState(equations, state, &mode);
      covariance = first_covariance;
      columns.setZero();
      for (int i = 0; i < states_; ++i) columns(i, 0) = state[i];
      record.Forget(k);
    }
    Keep(state, equations);
    for (int i = 0; i < states_; ++i) columns(i, 0) = state[i];
    record.covariance(k) = covariance;
    record.state(k) = columns;
    const double voltage = run_.stimulus.voltage[k];
    equations.Command(time_[k], voltage);
    SetMode(equations, k, voltage, state, &mode, &terms, rate, &record.informative(k));
    if (k + 1 == samples) break;

    const double step = time_[k + 1] - time_[k];
    equations.Jacobian(time_[k], voltage, mode, state, jacobian);
    double norm = 0;
    for (int i = 0; i < states_; ++i) {
      double row = 0;
      for (int j = 0; j < states_; ++j) {
        rates(i, j) = jacobian[i + j * states_];
        row += std::abs(rates(i, j)) * scales[j] / scales[i];
      }
      norm = std::max(norm, row);
    }
    const std::array<double, kBalances> gain = {mode.pump == 0 ? 0 : 1 / model_.parameters.J,
                                                mode.valve_1 ? 0 : terms.beta_1 / terms.V_1,
                                                mode.valve_2 ? 0 : terms.beta_2 / terms.V_2,
                                                record.informative(k)[3] ? 1 / model_.parameters.J_a : 0};
    constexpr int kMoved[kBalances] = {model::kMotorSpeed, model::kP1, model::kP2, model::kArmSpeed};
    double push[model::kMaxStates] = {};
    for (size_t b = 0; b < kBalances; ++b) {
      if (place_[b] < 0) continue;
      rates.col(place_[b]).setZero();
      rates(kMoved[b], place_[b]) = gain[b];
      push[kMoved[b]] = gain[b] * columns(place_[b], 0);
    }
    int halvings = 0;
    while (norm * step / (1 << halvings) > 0.5 && halvings < 10) ++halvings;

    // The state by Runge-Kutta, its covariance by the exponential of the Jacobian.
    for (double at = time_[k]; at < time_[k + 1];) {
      const double stop = equations.NextStop(at);
      const double end = std::min(time_[k + 1], stop);
      const int parts = std::max(1, static_cast<int>(std::ceil((end - at) / step * (1 << halvings) - 1e-9)));
      const double h = (end - at) / parts;
      double stage[model::kMaxStates], slope[4][model::kMaxStates];
      for (int part = 0; part < parts; ++part) {
        const double begin = at + part * h;
        constexpr double kReach[4] = {0, 0.5, 0.5, 1};
        for (int s = 0; s < 4; ++s) {
          for (int i = 0; i < states_; ++i) {
            stage[i] = state[i] + (s == 0 ? 0 : kReach[s] * h * slope[s - 1][i]);
          }
          equations.Rates(begin + kReach[s] * h, voltage, mode, stage, slope[s]);
          for (int i = 0; i < states_; ++i) slope[s][i] += push[i];
        }
        for (int i = 0; i < states_; ++i) {
          state[i] += h / 6 * (slope[0][i] + 2 * slope[1][i] + 2 * slope[2][i] + slope[3][i]);
        }
      }
      if (stop <= time_[k + 1]) equations.PassStop(stop);
      at = end;
    }
    Keep(state, equations);
    if (equations.switches() > model::kFirstEffectSwitch) {
      double margin[model::kMaxSwitches];
      equations.Rates(time_[k + 1], voltage, mode, state, rate, margin);
      for (int which = model::kFirstEffectSwitch; which < equations.switches(); ++which) {
        if (margin[which] >= 0) continue;
        equations.Cross(which, time_[k + 1], voltage, state, &mode);
        switched_.push_back(time_[k + 1]);
      }
    }

    const double part = step / (1 << halvings);
    term = part * rates;
    power = term;
    transition = Matrix::Identity(size_, size_) + term;
    for (int order = 2; order <= 4; ++order) {
      square.noalias() = power.lazyProduct(term);
      power = square / order;
      transition += power;
    }
    for (int i = 0; i < halvings; ++i) {
      square.noalias() = transition.lazyProduct(transition);
      transition = square;
    }
    record.transition(k) = transition;
    square.noalias() = transition.lazyProduct(covariance);
    covariance.noalias() = square.lazyProduct(transition.transpose());
    square = covariance.transpose();
    covariance = 0.5 * (covariance + square);
    Columns moved(size_, kColumns);
    moved.noalias() = transition.lazyProduct(columns);
    moved.col(0) = columns.col(0);
    for (int i = 0; i < states_; ++i) moved(i, 0) = state[i];
    columns = moved;

    for (int i = 0; i < states_; ++i) covariance(i, i) += 1e-16 * scales[i] * scales[i];
    for (size_t b = 0; b < kBalances; ++b) {
      if (place_[b] >= 0) covariance(place_[b], place_[b]) += wander_[b] * step;
    }
    if (mode.pump == 0) covariance(model::kMotorSpeed, model::kMotorSpeed) += speed_wander * speed_wander;
    if (observed_.speed_measured() && observed_.passes[k]) {
      const double jump = 2 * terms.coulomb * step / model_.parameters.J;
      covariance(model::kMotorSpeed, model::kMotorSpeed) += jump * jump + speed_wander * speed_wander;
    }
    // A valve may open and close at any time between the samples near p_3.
    for (int side = 0; side < 2; ++side) {
      if (!at_valve_[side] && !run_.stimulus.bypass) continue;
      const double jump = free_rate_[side] * step;
      const int at = side == 0 ? model::kP1 : model::kP2;
      covariance(at, at) +=
          jump * jump + 0.1 * Variance(side == 0 ? model::Channel::kP1 : model::Channel::kP2);
    }
  }
  if (place_[static_cast<size_t>(Balance::kArmTorque)] >= 0) {
    // An arm that its seals hold: when it lets go is known from coarse angles only.
    for (const double at : switched_) {
      const auto from = std::lower_bound(time_.begin(), time_.end(), at - kSwitching);
      for (auto t = from; t != time_.end() && *t <= at + kSwitching; ++t) {
        record.informative(static_cast<size_t>(t - time_.begin()))[3] = 0;
      }
    }
  }
  Smooth(record);
}

void Smoother::Smooth(Record& record) {
  const size_t samples = time_.size();
  const bool free = run_.stimulus.shaft == model::Shaft::kFree;
  result_ = SmoothedRun{};
  std::vector<double>* const kept[6] = {&result_.motor_angle, &result_.motor_speed, &result_.p1,
                                        &result_.p2,          &result_.arm_angle,   &result_.arm_speed};
  for (auto* values : kept) values->assign(samples, 0.0);
  for (size_t b = 0; b < kBalances; ++b) {
    if (place_[b] < 0) continue;
    result_.measured[b] = true;
    Disturbance& d = result_.disturbance[b];
    d.value.resize(samples);
    d.informative.resize(samples);
    for (auto& draw : d.noise) draw.resize(samples);
  }
  Columns adjoint = Columns::Zero(size_, kColumns);
  Columns smoothed(size_, kColumns);
  Record::Update update;
  Vector gain(size_);
  for (size_t k = samples; k-- > 0;) {
    if (k + 1 < samples) {
      smoothed.noalias() = record.transition(k).transpose().lazyProduct(adjoint);
      adjoint = smoothed;
    }
    smoothed = record.state(k);
    smoothed.noalias() -= record.covariance(k).lazyProduct(adjoint);
    for (int i = 0; i < (free ? 6 : 4); ++i) (*kept[i])[k] = smoothed(i, 0);
    if (!free) {
      const bool driven = run_.stimulus.shaft == model::Shaft::kDriven;
      result_.arm_angle[k] = driven ? run_.stimulus.motion->Value(time_[k]) : run_.stimulus.arm_angle;
      result_.arm_speed[k] = driven ? run_.stimulus.motion->Rate(time_[k]) : 0;
    }
    for (size_t b = 0; b < kBalances; ++b) {
      if (place_[b] < 0) continue;
      Disturbance& d = result_.disturbance[b];
      d.value[k] = smoothed(place_[b], 0);
      d.informative[k] = record.informative(k)[b] && std::isfinite(d.value[k]);
      for (size_t draw = 0; draw < kNoiseDraws; ++draw) {
        d.noise[draw][k] = smoothed(place_[b], 1 + static_cast<int>(draw));
      }
    }
    while (record.Take(k, &update, &gain)) {
      RowOfColumns pulled = update.innovation / update.variance;
      pulled.noalias() += gain.transpose().lazyProduct(adjoint);
      adjoint.noalias() -= sensors_[update.sensor].row.lazyProduct(pulled);
    }
  }
}

}  // namespace

SmoothedRun SmoothDisturbances(const model::ModelDescription& model, const RunData& run,
                               const PressureOffsets& offsets) {
  return Smoother(model, run, offsets).Run();
}

}  // namespace hydro::diagnose
