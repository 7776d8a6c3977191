#include "diagnose/locate/smoother_filter.h"

#include <algorithm>
#include <cmath>

namespace hydro::diagnose::smoother {
namespace {

constexpr size_t kArmTorque = static_cast<size_t>(Balance::kArmTorque);
// The state whose rate each balance determines.
constexpr int kMoved[kBalances] = {model::kMotorSpeed, model::kP1, model::kP2, model::kArmSpeed};
// s. For this long before and after a switch of an effect, the arm's balance is not informative.
constexpr double kSwitching = 0.02;

}  // namespace

Filter::Filter(const Setup& setup)
    : setup_(setup),
      equations_(setup.model, setup.options),
      mode_at_sample_(setup),
      record_(setup.time.size(), setup.size),
      first_covariance_(BeginCovariance()),
      rates_(Matrix::Zero(setup.size, setup.size)) {}

Record Filter::Run() {
  Begin();
  equations_.PassStop(setup_.time[0]);
  const size_t samples = setup_.time.size();
  for (size_t k = 0; k < samples; ++k) {
    ReadSample(k);
    if (k + 1 < samples) Advance(k);
  }
  if (setup_.place[kArmTorque] >= 0) ForgetArmAtSwitches();
  return std::move(record_);
}

void Filter::Begin() {
  setup_.Begin(equations_, state_, &mode_);
  covariance_ = first_covariance_;
  columns_ = Columns::Zero(setup_.size, kColumns);
  CopyStateToColumns();
}

Matrix Filter::BeginCovariance() const {
  Matrix covariance = Matrix::Zero(setup_.size, setup_.size);
  for (int i = 0; i < setup_.states; ++i) {
    const double scale = equations_.scales()[i];
    covariance(i, i) = scale * scale;
  }
  for (size_t b = 0; b < kBalances; ++b) {
    const int at = setup_.place[b];
    // Well above how far the disturbance wanders in the time in which it is followed.
    if (at >= 0) covariance(at, at) = 100 * setup_.wander[b] * std::max(setup_.interval, 0.1);
  }
  return covariance;
}

// Keeps the volumes above 0, whatever the filter makes of the arm's angle.
void Filter::KeepVolumes() {
  if (!setup_.free_arm()) return;
  const model::Parameters& p = setup_.model.parameters;
  const double limit = 0.98 * (p.V_ms - equations_.data().fixed_volume) / p.c;
  state_[model::kArmAngle] = std::clamp(state_[model::kArmAngle], -limit, limit);
}

void Filter::CopyStateToColumns() {
  for (int i = 0; i < setup_.states; ++i) columns_(i, 0) = state_[i];
}

void Filter::ReadSample(size_t k) {
  Correct(k);
  if (!columns_.allFinite() || !covariance_.allFinite()) {
    // Lost: begin again from the next measurements.
    Begin();
    record_.Forget(k);
  }
  KeepVolumes();
  CopyStateToColumns();
  record_.covariance(k) = covariance_;
  record_.state(k) = columns_;
  const double voltage = setup_.run.stimulus.voltage[k];
  equations_.Command(setup_.time[k], voltage);
  double rate[model::kMaxStates];
  mode_at_sample_.Set(equations_, k, voltage, state_, &mode_, &terms_, rate, &record_.informative(k));
}

// Corrects by each reading of the sample in turn.
void Filter::Correct(size_t k) {
  const model::Measurement predicted = equations_.Measure(setup_.time[k], state_);
  const Vector before = columns_.col(0);
  Vector gain(setup_.size);
  for (size_t s = 0; s < setup_.sensors.size(); ++s) {
    const Sensor& sensor = setup_.sensors[s];
    const double value = (*sensor.values)[k];
    if (std::isnan(value)) continue;
    Record::Update update;
    update.sensor = static_cast<int>(s);
    gain.noalias() = covariance_.lazyProduct(sensor.row);
    const double repeats = sensor.repeats.empty() ? 1 : sensor.repeats[k];
    update.variance = sensor.row.dot(gain) + sensor.variance * repeats;
    gain /= update.variance;
    update.innovation.noalias() = -sensor.row.transpose().lazyProduct(columns_);
    update.innovation[0] = value - sensor.offset -
                           model::ChannelOf(predicted, static_cast<size_t>(sensor.channel)) -
                           sensor.row.dot(columns_.col(0) - before);
    for (size_t draw = 0; draw < kNoiseDraws; ++draw) {
      update.innovation[1 + static_cast<int>(draw)] += static_cast<double>(sensor.noise[draw][k]);
    }
    columns_.noalias() += gain.lazyProduct(update.innovation);
    covariance_.noalias() -= update.variance * gain.lazyProduct(gain.transpose());
    record_.Add(k, update, gain);
  }
  for (int i = 0; i < setup_.states; ++i) state_[i] = columns_(i, 0);
}

// Advances the state by Runge-Kutta, and its covariance by the exponential of the Jacobian.
void Filter::Advance(size_t k) {
  const double step = setup_.time[k + 1] - setup_.time[k];
  const double norm = Linearise(k);
  const Rates push = DisturbanceRates(k);
  int halvings = 0;
  while (norm * step / (1 << halvings) > 0.5 && halvings < 10) ++halvings;

  IntegrateState(k, halvings, push);
  KeepVolumes();
  CrossSwitches(k);

  const Matrix transition = Transition(step / (1 << halvings), halvings);
  record_.transition(k) = transition;
  PropagateCovariance(transition);
  PropagateColumns(transition);
  AddUncertainty(k, step);
}

// Puts the model's Jacobian into rates_ and returns its norm in units of the states' scales, 1/s.
double Filter::Linearise(size_t k) {
  const int states = setup_.states;
  const std::vector<double>& scales = equations_.scales();
  double jacobian[model::kMaxStates * model::kMaxStates];
  equations_.Jacobian(setup_.time[k], setup_.run.stimulus.voltage[k], mode_, state_, jacobian);
  double norm = 0;
  for (int i = 0; i < states; ++i) {
    double row = 0;
    for (int j = 0; j < states; ++j) {
      rates_(i, j) = jacobian[i + j * states];
      row += std::abs(rates_(i, j)) * scales[j] / scales[i];
    }
    norm = std::max(norm, row);
  }
  return norm;
}

// What the disturbances add to the states' rates; also fills their columns of rates_.
Filter::Rates Filter::DisturbanceRates(size_t k) {
  const model::Parameters& p = setup_.model.parameters;
  const std::array<double, kBalances> gain = {
      mode_.pump == 0 ? 0 : 1 / p.J, mode_.valve_1 ? 0 : terms_.beta_1 / terms_.V_1,
      mode_.valve_2 ? 0 : terms_.beta_2 / terms_.V_2, record_.informative(k)[kArmTorque] ? 1 / p.J_a : 0};
  Rates push{};
  for (size_t b = 0; b < kBalances; ++b) {
    const int at = setup_.place[b];
    if (at < 0) continue;
    rates_.col(at).setZero();
    rates_(kMoved[b], at) = gain[b];
    push[kMoved[b]] = gain[b] * columns_(at, 0);
  }
  return push;
}

// Takes 2^halvings steps, each from stop to stop of the equations.
void Filter::IntegrateState(size_t k, int halvings, const Rates& push) {
  const double voltage = setup_.run.stimulus.voltage[k];
  const double next = setup_.time[k + 1];
  const double step = next - setup_.time[k];
  for (double at = setup_.time[k]; at < next;) {
    const double stop = equations_.NextStop(at);
    const double end = std::min(next, stop);
    const int parts = std::max(1, static_cast<int>(std::ceil((end - at) / step * (1 << halvings) - 1e-9)));
    const double h = (end - at) / parts;
    for (int part = 0; part < parts; ++part) RungeKuttaStep(at + part * h, h, voltage, push);
    if (stop <= next) equations_.PassStop(stop);
    at = end;
  }
}

void Filter::RungeKuttaStep(double begin, double h, double voltage, const Rates& push) {
  const int states = setup_.states;
  double stage[model::kMaxStates], slope[4][model::kMaxStates];
  constexpr double kReach[4] = {0, 0.5, 0.5, 1};
  for (int s = 0; s < 4; ++s) {
    for (int i = 0; i < states; ++i) {
      stage[i] = state_[i] + (s == 0 ? 0 : kReach[s] * h * slope[s - 1][i]);
    }
    equations_.Rates(begin + kReach[s] * h, voltage, mode_, stage, slope[s]);
    for (int i = 0; i < states; ++i) slope[s][i] += push[i];
  }
  for (int i = 0; i < states; ++i) {
    state_[i] += h / 6 * (slope[0][i] + 2 * slope[1][i] + 2 * slope[2][i] + slope[3][i]);
  }
}

// Crosses the switches of effects that the state has passed by the next sample.
void Filter::CrossSwitches(size_t k) {
  if (equations_.switches() <= model::kFirstEffectSwitch) return;
  const double time = setup_.time[k + 1];
  const double voltage = setup_.run.stimulus.voltage[k];
  double rate[model::kMaxStates], margin[model::kMaxSwitches];
  equations_.Rates(time, voltage, mode_, state_, rate, margin);
  for (int which = model::kFirstEffectSwitch; which < equations_.switches(); ++which) {
    if (margin[which] >= 0) continue;
    equations_.Cross(which, time, voltage, state_, &mode_);
    switched_.push_back(time);
  }
}

// The exponential of rates_ times part * 2^halvings: a series for `part`, squared `halvings` times.
Matrix Filter::Transition(double part, int halvings) const {
  const int size = setup_.size;
  Matrix term(size, size), power(size, size), square(size, size), transition(size, size);
  term = part * rates_;
  power = term;
  transition = Matrix::Identity(size, size) + term;
  for (int order = 2; order <= 4; ++order) {
    square.noalias() = power.lazyProduct(term);
    power = square / order;
    transition += power;
  }
  for (int i = 0; i < halvings; ++i) {
    square.noalias() = transition.lazyProduct(transition);
    transition = square;
  }
  return transition;
}

void Filter::PropagateCovariance(const Matrix& transition) {
  Matrix square(setup_.size, setup_.size);
  square.noalias() = transition.lazyProduct(covariance_);
  covariance_.noalias() = square.lazyProduct(transition.transpose());
  square = covariance_.transpose();
  covariance_ = 0.5 * (covariance_ + square);
}

void Filter::PropagateColumns(const Matrix& transition) {
  Columns moved(setup_.size, kColumns);
  moved.noalias() = transition.lazyProduct(columns_);
  moved.col(0) = columns_.col(0);
  columns_ = moved;
  CopyStateToColumns();
}

// Adds the uncertainty of changes between the samples that the equations do not contain.
void Filter::AddUncertainty(size_t k, double step) {
  const std::vector<double>& scales = equations_.scales();
  const double speed_wander = 0.3 * setup_.observed.speed_margin;
  for (int i = 0; i < setup_.states; ++i) covariance_(i, i) += 1e-16 * scales[i] * scales[i];
  for (size_t b = 0; b < kBalances; ++b) {
    const int at = setup_.place[b];
    if (at >= 0) covariance_(at, at) += setup_.wander[b] * step;
  }
  double& speed = covariance_(model::kMotorSpeed, model::kMotorSpeed);
  if (mode_.pump == 0) speed += speed_wander * speed_wander;
  if (setup_.observed.speed_measured() && setup_.observed.passes[k]) {
    const double jump = 2 * terms_.coulomb * step / setup_.model.parameters.J;
    speed += jump * jump + speed_wander * speed_wander;
  }
  // Near p_3 a valve may open and close at any time between the samples.
  for (int side = 0; side < 2; ++side) {
    if (!mode_at_sample_.at_valve(side) && !setup_.run.stimulus.bypass) continue;
    const double jump = mode_at_sample_.free_rate(side) * step;
    const int at = side == 0 ? model::kP1 : model::kP2;
    covariance_(at, at) +=
        jump * jump + 0.1 * setup_.Variance(side == 0 ? model::Channel::kP1 : model::Channel::kP2);
  }
}

// Only coarse angles show when an arm that its seals hold breaks loose, so the arm's balance is ignored near
// switches.
void Filter::ForgetArmAtSwitches() {
  const std::vector<double>& time = setup_.time;
  for (const double at : switched_) {
    const auto from = std::lower_bound(time.begin(), time.end(), at - kSwitching);
    for (auto t = from; t != time.end() && *t <= at + kSwitching; ++t) {
      record_.informative(static_cast<size_t>(t - time.begin()))[kArmTorque] = 0;
    }
  }
}

}  // namespace hydro::diagnose::smoother
