#include "diagnose/evidence/recording_balances.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/maths/spread.h"
#include "diagnose/balances/masks.h"
#include "diagnose/balances/run_motion.h"
#include "diagnose/balances/test_functions.h"
#include "model/terms/parameter_info.h"
#include "runs/measured/sample_times.h"

namespace hydro::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Factors = SignalFactors;
using Run = runs::MeasuredRun;

// Hz: recorders, filters and delays of any kind pass this frequency.
constexpr double kHighestOfACheck = 40;
// Number of frequency bands up to there: a balance counts as that many numbers.
constexpr double kNumbers = 6;
// Squared part of a term that a model leaves of a balance if it lacks an effect or two. Smaller residuals say
// no more about a recording.
constexpr double kLacking = 0.01;
// Squared, relative to the noise in the terms: a band with smaller terms says nothing.
constexpr double kAboveNoise = 1;
constexpr uint64_t kSeed = 5;
// Relative: how wrong a sensor's gain may be without being a mistake.
constexpr double kGain = 0.05;
// The lowest part of a pressure's range, in which a one-way valve may be open and no flow balances.
constexpr double kLow = 0.05;

double Relative(const model::ModelDescription& model, double model::Parameters::*member) {
  for (size_t i = 0; i < model::BaseParameters().size(); ++i) {
    if (model::BaseParameters()[i].member == member) return std::hypot(model::UncertaintyOf(model, i), kGain);
  }
  return kGain;
}

RunData Bare(Run run) {
  RunData data;
  data.stimulus = StimulusOf(run);
  data.measured = std::move(run);
  return data;
}

class BalanceMaker {
 public:
  BalanceMaker(const model::ModelDescription& model, const Run& run,
               const std::vector<RecordingMistake>& possible)
      : model_(model), p_(model.parameters), run_(run), possible_(possible) {
    Run speeds = run;
    if (run.motor_speed.measured()) speeds.motor_angle = {};
    if (run.shaft == model::Shaft::kDriven) speeds.shaft = model::Shaft::kFree;
    motion_ = MotionOf(Bare(speeds), p_);
    noisy_ = WithNoiseAgain(motion_, p_, kSeed);
    step_ = motion_.step * static_cast<double>(motion_.stride);
    count_ = static_cast<Index>((motion_.size() + motion_.stride - 1) / motion_.stride);
    tile_ = TileLength(step_ * static_cast<double>(count_));
  }

  std::vector<TermBalance> Make() {
    AddTorque();
    for (const bool exchanged : {false, true}) {
      AddFlow(1, exchanged);
      AddFlow(2, exchanged);
    }
    AddArm();
    AddRates();
    return std::move(all_);
  }

 private:
  using Known = double model::KnownMotion::*;
  struct Open {  // a balance under construction
    TermBalance balance;
    std::vector<MatrixXd> series;
  };

  // The first column is a term over time, the second what noise adds to it.
  template <class Value>
  MatrixXd Series(const RunMotion& motion, const RunMotion& noisy, const Value& value) const {
    MatrixXd series(count_, 2);
    for (Index i = 0; i < count_; ++i) {
      const size_t k = static_cast<size_t>(i) * motion.stride;
      series(i, 0) = value(motion.at[k]);
      series(i, 1) = value(noisy.at[k]) - series(i, 0);
    }
    return series;
  }
  template <class Value>
  MatrixXd Series(const Value& value) const {
    return Series(motion_, noisy_, value);
  }
  MatrixXd Series(Known one, double scale) const {
    return Series([=](const model::KnownMotion& at) { return scale * at.*one; });
  }
  static void Put(Open* open, std::function<double(const Factors&)> factor, MatrixXd series, double sd) {
    open->balance.terms.push_back({std::move(factor), sd, static_cast<int>(open->series.size())});
    open->series.push_back(std::move(series));
  }

  // The factor that corrects the motor's speed. The rate of an angle may replace the speed.
  std::function<double(const Factors&)> Speed() const {
    const bool measured = run_.motor_speed.measured();
    return [measured](const Factors& f) { return measured ? f.motor_speed : f.motor_angle; };
  }

  // Several balances share one mask.
  const std::vector<TestFunctions>& FunctionsOf(const std::vector<uint8_t>& mask) {
    const auto [known, is_new] = functions_.try_emplace(mask);
    if (!is_new) return known->second;
    double interval = motion_.step;
    for (const GridSignal& signal : motion_.signals) interval = std::max(interval, signal.interval);
    return known->second =
               TestFunctionsOf(mask, step_, tile_, std::min(kHighestOfACheck, kOfTheRate / interval));
  }

  void Finish(Open open, const std::vector<uint8_t>& mask) {
    const auto width = static_cast<Index>(open.series.size());
    MatrixXd all(count_, 2 * width);
    for (Index t = 0; t < width; ++t) {
      all.col(t) = open.series[static_cast<size_t>(t)].col(0);
      all.col(width + t) = open.series[static_cast<size_t>(t)].col(1);
    }
    std::map<int, TermBalance::Band> bands;
    for (const TestFunctions& one : FunctionsOf(mask)) {
      const MatrixXd rows = one.values * all.middleRows(one.first, one.values.cols());
      for (Index k = 0; k < rows.rows(); ++k) {
        const auto [found, is_new] = bands.try_emplace(BandOf(one.frequency[k], tile_));
        TermBalance::Band& band = found->second;
        if (is_new) band.products = band.noise = MatrixXd::Zero(width, width);
        band.products += rows.row(k).head(width).transpose() * rows.row(k).head(width);
        band.noise += rows.row(k).tail(width).transpose() * rows.row(k).tail(width);
      }
    }
    for (auto& [place, band] : bands) open.balance.bands.push_back(std::move(band));
    if (!bands.empty()) all_.push_back(std::move(open.balance));
  }

  // The sizes of a signal's factor in all mistakes. A quantity that is not linear in the signal has one term
  // for each.
  std::vector<double> SizesOf(double SignalFactors::*signal) const {
    std::vector<double> sizes = {1};
    for (const RecordingMistake& mistake : possible_) {
      Factors factors;
      AddFactors(mistake, &factors);
      const double size = std::abs(factors.*signal);
      if (std::ranges::find(sizes, size) == sizes.end()) sizes.push_back(size);
    }
    return sizes;
  }
  static bool IsSize(double factor, double size) { return std::abs(std::abs(factor) - size) < 1e-9 * size; }

  // Where the balance says nothing: the pump at rest, gaps, or the pressure of its side low.
  std::vector<uint8_t> MaskOf(BalanceKind balance, GridChannel side = GridChannel::kSpeed) const {
    HeldPressure held;
    if (motion_.Of(side).measured()) {
      const maths::Range range = maths::RangeOf(motion_.Of(side).values);
      held = {range.low, kLow * range.size()};
    }
    BalanceSeries none;
    for (VectorXd& series : none) series = VectorXd::Zero(count_);
    return MasksOf(motion_, none, held, p_)[static_cast<size_t>(balance)];
  }

  void AddTorque() {
    if (!CanForm(motion_, BalanceKind::kTorque)) return;
    Open open;
    const auto speed = Speed();
    Put(
        &open, [=](const Factors& f) { return speed(f); },
        Series(&model::KnownMotion::motor_acceleration, p_.J), Relative(model_, &model::Parameters::J));
    Put(&open, speed, Series(&model::KnownMotion::motor_speed, p_.b),
        Relative(model_, &model::Parameters::b));
    Put(
        &open, [=](const Factors& f) { return speed(f) < 0 ? -1.0 : 1.0; },
        Series(&model::KnownMotion::pump_direction, p_.T_s), Relative(model_, &model::Parameters::T_s));
    if (motion_.pressures) AddPressures(p_.D, &open);
    AddCommands(&open);
    Finish(std::move(open), MaskOf(BalanceKind::kTorque));
  }

  // Adds coefficient (p2 - p1), whichever column is which.
  void AddPressures(double coefficient, Open* open) const {
    Put(
        open, [](const Factors& f) { return f.exchanged ? -f.p1 : f.p1; },
        Series(&model::KnownMotion::p1, -coefficient), kGain);
    Put(
        open, [](const Factors& f) { return f.exchanged ? -f.p2 : f.p2; },
        Series(&model::KnownMotion::p2, coefficient), kGain);
    --open->balance.terms.back().group;  // only the difference counts
  }

  // Adds the command's torque for each size of the voltage's factor, because the torque has a limit.
  void AddCommands(Open* open) const {
    for (const double size : SizesOf(&Factors::voltage)) {
      std::vector<double> torque;
      torque.reserve(motion_.size());
      for (const double voltage : motion_.voltage)
        torque.push_back(-std::clamp(p_.k_1 * size * voltage, -p_.T_pmax, p_.T_pmax));
      torque = Smoothed(torque, SmoothingOf(motion_.step) / motion_.step);
      MatrixXd series = MatrixXd::Zero(count_, 2);  // a command has no noise
      for (Index i = 0; i < count_; ++i) series(i, 0) = torque[static_cast<size_t>(i) * motion_.stride];
      Put(
          open,
          [size](const Factors& f) {
            if (!IsSize(f.voltage, size)) return 0.0;
            return f.voltage < 0 ? -1.0 : 1.0;
          },
          std::move(series), kGain);
    }
  }

  // Adds the flow of one side. The other column's flow is the exchanged one.
  void AddFlow(int side, bool exchanged) {
    if (!CanForm(motion_, BalanceKind::kFlow1)) return;
    const bool first = (side == 1) != exchanged;  // the column p1
    const Known own = first ? &model::KnownMotion::p1 : &model::KnownMotion::p2,
                other = first ? &model::KnownMotion::p2 : &model::KnownMotion::p1,
                rate = first ? &model::KnownMotion::p1_rate : &model::KnownMotion::p2_rate;
    const auto of_own = [first](const Factors& f) { return first ? f.p1 : f.p2; };
    const auto of_other = [first](const Factors& f) { return first ? f.p2 : f.p1; };
    const double sign = side == 1 ? 1 : -1;
    Open open;
    open.balance.holds = [exchanged](const Factors& f) { return f.exchanged == exchanged; };
    const double oil = Relative(model_, &model::Parameters::beta);
    const double still = motion_.arm_moves ? 0 : motion_.options.arm_angle;
    Put(
        &open, [=](const Factors& f) { return of_own(f); },
        Series(rate, (p_.V_ms - sign * p_.c * still) / p_.beta), oil);
    Put(&open, Speed(), Series(&model::KnownMotion::motor_speed, sign * p_.D), kGain);
    const double across = Relative(model_, &model::Parameters::c_I),
                 out = Relative(model_, &model::Parameters::c_E);
    Put(&open, of_own, Series(own, p_.c_I), across);
    Put(&open, of_other, Series(other, -p_.c_I), across);
    --open.balance.terms.back().group;
    Put(&open, of_own, Series(own, p_.c_E), out);
    Put(
        &open, [](const Factors&) { return 1.0; },
        Series([this](const model::KnownMotion&) { return -p_.c_E * p_.p_3; }), out);
    if (motion_.arm_moves) {
      Put(
          &open, [](const Factors& f) { return f.arm_angle; },
          Series(&model::KnownMotion::arm_speed, -sign * p_.c), kGain);
      Put(
          &open, [=](const Factors& f) { return f.arm_angle * of_own(f); },
          Series([=, this](const model::KnownMotion& at) {
            return -sign * p_.c / p_.beta * at.arm_angle * at.*rate;
          }),
          oil);
    }
    Finish(std::move(open), MaskOf(first ? BalanceKind::kFlow1 : BalanceKind::kFlow2,
                                   first ? GridChannel::kP1 : GridChannel::kP2));
  }

  void AddArm() {
    if (run_.shaft != model::Shaft::kFree || !motion_.pressures || !motion_.speed_known) return;
    Open open;
    AddPressures(p_.k_2, &open);
    const double inertia = Relative(model_, &model::Parameters::J_a);
    if (motion_.arm_moves) {
      Put(
          &open, [](const Factors& f) { return f.arm_angle; },
          Series(&model::KnownMotion::arm_acceleration, -p_.J_a), inertia);
    } else {
      // The arm was not measured. Below the resonance of the oil it follows the pump.
      Put(&open, Speed(), Series(&model::KnownMotion::motor_acceleration, -p_.J_a * p_.D / p_.c), inertia);
    }
    if (run_.arm_force.measured()) {
      Put(
          &open, [](const Factors&) { return 1.0; },
          Series([](const model::KnownMotion& at) { return at.around.arm_force; }), kGain);
    }
    if (motion_.arm_moves && p_.mgl != 0) {
      for (const double size : SizesOf(&Factors::arm_angle)) {
        Put(
            &open, [size](const Factors& f) { return IsSize(f.arm_angle, size) ? 1.0 : 0.0; },
            Series([=, this](const model::KnownMotion& at) {
              return -p_.mgl * (model_.units.linear_arm ? 1 : std::cos(size * at.arm_angle));
            }),
            Relative(model_, &model::Parameters::mgl));
      }
    } else {
      // A weight that nobody stated may have any size, so the constant part says nothing.
      for (MatrixXd& series : open.series) series.rowwise() -= series.colwise().mean().eval();
    }
    Finish(std::move(open), MaskOf(motion_.arm_moves ? BalanceKind::kArm : BalanceKind::kTorque));
  }

  // Adds the balance of a speed against its angle.
  void AddRate(runs::MeasuredSignal Run::*speed, runs::MeasuredSignal Run::*angle,
               double SignalFactors::*of_speed, double SignalFactors::*of_angle) {
    if (!(run_.*speed).measured() || !(run_.*angle).measured()) return;
    Open open;
    for (const bool rate : {false, true}) {
      Run alone = run_;
      alone.motor_speed = rate ? runs::MeasuredSignal{} : run_.*speed;
      alone.motor_angle = rate ? run_.*angle : runs::MeasuredSignal{};
      const RunMotion motion = MotionOf(Bare(std::move(alone)), p_);
      MatrixXd series =
          Series(motion, WithNoiseAgain(motion, p_, kSeed),
                 [sign = rate ? -1.0 : 1.0](const model::KnownMotion& at) { return sign * at.motor_speed; });
      Put(
          &open, [=](const Factors& f) { return rate ? f.*of_angle : f.*of_speed; }, std::move(series),
          kGain);
    }
    Finish(std::move(open), std::vector<uint8_t>(static_cast<size_t>(count_), 0));
  }

  void AddRates() {
    AddRate(&Run::motor_speed, &Run::motor_angle, &Factors::motor_speed, &Factors::motor_angle);
    if (run_.shaft == model::Shaft::kClamped) return;
    AddRate(&Run::arm_speed, &Run::arm_angle, &Factors::arm_speed, &Factors::arm_angle);
  }

  const model::ModelDescription& model_;
  const model::Parameters& p_;
  const Run& run_;
  const std::vector<RecordingMistake>& possible_;
  RunMotion motion_, noisy_;
  double step_ = 0, tile_ = 0;
  Index count_ = 0;
  std::map<std::vector<uint8_t>, std::vector<TestFunctions>> functions_;
  std::vector<TermBalance> all_;
};

}  // namespace

void AddFactors(const RecordingMistake& mistake, SignalFactors* factors) {
  static constexpr std::pair<SignalOfRun, double SignalFactors::*> kMembers[] = {
      {&Run::voltage, &SignalFactors::voltage},
      {&Run::motor_speed, &SignalFactors::motor_speed},
      {&Run::motor_angle, &SignalFactors::motor_angle},
      {&Run::arm_angle, &SignalFactors::arm_angle},
      {&Run::arm_speed, &SignalFactors::arm_speed},
      {&Run::p1, &SignalFactors::p1},
      {&Run::p2, &SignalFactors::p2}};
  for (const auto& [signal, factor] : mistake.factors) {
    for (const auto& [of, member] : kMembers) {
      if (of != signal) continue;
      // After an exchange, the name refers to the other column.
      const bool other = factors->exchanged && (signal == &Run::p1 || signal == &Run::p2);
      const auto column = !other ? member : signal == &Run::p1 ? &SignalFactors::p2 : &SignalFactors::p1;
      factors->*column *= factor;
    }
  }
  factors->exchanged = factors->exchanged != mistake.pressures_exchanged;
}

RecordingBalances::RecordingBalances(const model::ModelDescription& model, const Run& run,
                                     const std::vector<RecordingMistake>& possible)
    : balances_(BalanceMaker(model, run, possible).Make()) {}

namespace {

// A balance with corrected terms: what it leaves at the likeliest values.
struct Closed {
  double left = 0;     // mean over bands of the logarithm of the squared share that is left
  double penalty = 0;  // of the values
};

// Products of the corrected terms in a band: of their sum, and of each group by itself, without noise and for
// noise.
struct Band {
  MatrixXd sum, parts, noise_sum, noise_parts;

  // The share of the terms that is left, a ratio of squares, including what is never known better. Terms that
  // have nothing to do with each other leave more than all of them, which counts as no worse than nothing.
  double Left(const VectorXd& x) const {
    const double noise = x.dot(noise_parts * x), size = x.dot(parts * x) - noise;
    if (!(size > kAboveNoise * noise)) return 1;
    const double left = std::max(0.0, x.dot(sum * x) - x.dot(noise_sum * x));
    return std::min(1.0, left / size + kLacking);
  }
};

std::vector<Band> Corrected(const TermBalance& balance, const VectorXd& factors) {
  const auto parts_of = [&](MatrixXd products) {
    for (Index i = 0; i < products.rows(); ++i) {
      for (Index j = 0; j < products.cols(); ++j) {
        if (balance.terms[static_cast<size_t>(i)].group != balance.terms[static_cast<size_t>(j)].group)
          products(i, j) = 0;
      }
    }
    return products;
  };
  std::vector<Band> bands;
  for (const TermBalance::Band& band : balance.bands) {
    const MatrixXd sum = factors.asDiagonal() * band.products * factors.asDiagonal();
    const MatrixXd noise = factors.asDiagonal() * band.noise * factors.asDiagonal();
    bands.push_back({sum, parts_of(sum), noise, parts_of(noise)});
  }
  return bands;
}

Closed Close(const TermBalance& balance, const VectorXd& f) {
  const Index n = f.size();
  const VectorXd given = VectorXd::Ones(n);
  VectorXd precision(n);
  for (Index t = 0; t < n; ++t) {
    const SignalTerm& term = balance.terms[static_cast<size_t>(t)];
    precision[t] = 1 / (term.sd * term.sd);
  }
  const std::vector<Band> bands = Corrected(balance, f);
  const double weight = kNumbers / static_cast<double>(bands.size());
  const auto closed_at = [&](const VectorXd& x) {
    Closed closed;
    for (const Band& band : bands) closed.left += std::log(band.Left(x)) * weight / kNumbers;
    closed.penalty = 0.5 * precision.dot((x - given).cwiseAbs2());
    return closed;
  };
  // Iterates between amounts and variances. Amounts that only make all terms small gain nothing, because the
  // remainder is measured by the terms.
  VectorXd x = given;
  for (int turn = 0; turn < 8; ++turn) {
    MatrixXd normal = precision.asDiagonal();
    for (const Band& band : bands) {
      const double variance = x.dot(band.sum * x) + kLacking * x.dot(band.parts * x);
      if (variance > 0) normal += weight / variance * band.sum;
    }
    x = normal.ldlt().solve(precision);
  }
  const Closed fitted = closed_at(x), held = closed_at(given);
  const auto cost = [](const Closed& one) { return 0.5 * kNumbers * one.left + one.penalty; };
  return cost(fitted) < cost(held) ? fitted : held;
}

}  // namespace

double RecordingBalances::Evidence(const SignalFactors& factors) const {
  double evidence = 0;
  for (const TermBalance& balance : balances_) {
    if (!balance.holds(factors)) continue;
    evidence += EvidenceOf(balance, factors);
  }
  return evidence;
}

double RecordingBalances::EvidenceOf(const TermBalance& balance, const SignalFactors& factors) const {
  std::vector<double> f;
  for (const SignalTerm& term : balance.terms) f.push_back(term.factor(factors));
  const auto [known, is_new] = balance.evidence.try_emplace(f, 0.0);
  if (is_new) {
    const Closed closed = Close(balance, Eigen::Map<const VectorXd>(f.data(), static_cast<Index>(f.size())));
    known->second = -0.5 * kNumbers * closed.left - closed.penalty;
  }
  return known->second;
}

double RecordingBalances::LeastLeftOpen() const {
  double most = 0;
  for (const TermBalance& balance : balances_) {
    if (balance.holds({})) most = std::max(most, EvidenceOf(balance, {}));
  }
  return balances_.empty() ? 0 : std::exp(-2 * most / kNumbers);
}

}  // namespace hydro::diagnose
