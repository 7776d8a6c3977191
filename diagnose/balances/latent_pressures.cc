#include "diagnose/balances/latent_pressures.h"

#include <algorithm>
#include <cmath>

#include "base/maths/spread.h"

namespace hydro::diagnose {
namespace {

using model::KnownMotion;

// s: the start is the median over this time.
constexpr double kStartTime = 0.02;
// The step of finite differences, as a fraction of the range of pressures.
constexpr double kSlopeStep = 1e-4;

constexpr double KnownMotion::*kPressureOf[] = {&KnownMotion::p1, &KnownMotion::p2};
constexpr double KnownMotion::*kRateOf[] = {&KnownMotion::p1_rate, &KnownMotion::p2_rate};
constexpr GridChannel kSides[] = {GridChannel::kP1, GridChannel::kP2};
constexpr BalanceKind kFlows[] = {BalanceKind::kFlow1, BalanceKind::kFlow2};

double Flow(const model::BalancesOf<double>& left, size_t side) {
  return side == 0 ? left.flow_1 : left.flow_2;
}

class March {
 public:
  March(const model::ModelDescription& model, RunMotion* run)
      : equations_(model, run->options), p_3_(model.parameters.p_3), run_(*run) {
    const model::Parameters& p = model.parameters;
    step_ = kSlopeStep * (std::abs(p.p_3) + p.T_pmax / p.D);
    for (size_t side = 0; side < 2; ++side) latent_[side] = run_.IsLatent(kSides[side]);
  }

  void Run() {
    SetStart();
    if (equations_.remembers()) equations_.Start(run_.at.front());
    for (size_t k = 0; k < run_.size(); ++k) {
      if (k % run_.stride == 0) run_.slopes.push_back(SlopesAt(run_.at[k]));
      if (k + 1 < run_.size()) Advance(k);
    }
  }

 private:
  // Sets the pressure that must turn the pump, given the motor's torque, inertia and friction.
  void SetStart() {
    const size_t n = std::min(run_.size(), std::max<size_t>(1, static_cast<size_t>(kStartTime / run_.step)));
    std::vector<double> differences, levels;
    for (size_t k = 0; k < n; ++k) {
      KnownMotion at = run_.at[k];
      if (latent_[0] && latent_[1]) at.p1 = at.p2 = p_3_;
      const double level = latent_[0] ? at.p2 : at.p1;
      at.p1 = at.p2 = level;
      const double torque = equations_.Values(at).torque;
      at.p2 += step_;
      const double slope = (equations_.Values(at).torque - torque) / step_;
      differences.push_back(slope != 0 ? -torque / slope : 0);
      levels.push_back(level);
    }
    const double difference = maths::Median(differences), level = maths::Median(levels);
    KnownMotion& first = run_.at.front();
    if (latent_[0]) first.p1 = std::max(p_3_, latent_[1] ? p_3_ - difference : level - difference);
    if (latent_[1]) first.p2 = std::max(p_3_, latent_[0] ? p_3_ + difference : level + difference);
    for (size_t side = 0; side < 2; ++side) held_[side] = latent_[side] && first.*kPressureOf[side] <= p_3_;
  }

  // psi/s, of the missing pressures with their valves closed.
  std::array<double, 2> Rates(KnownMotion at) const {
    for (size_t side = 0; side < 2; ++side) {
      if (latent_[side]) at.*kRateOf[side] = 0;
    }
    const model::BalancesOf<double> still = equations_.Values(at);
    for (size_t side = 0; side < 2; ++side) {
      if (latent_[side]) at.*kRateOf[side] = 1;
    }
    const model::BalancesOf<double> rising = equations_.Values(at);
    std::array<double, 2> rates{};
    for (size_t side = 0; side < 2; ++side) {
      const double capacity = Flow(still, side) - Flow(rising, side);
      if (latent_[side] && capacity > 0) rates[side] = Flow(still, side) / capacity;
    }
    return rates;
  }

  // One step of Heun's method: the flow of a sample is the mean of the flows at its ends.
  void Advance(size_t k) {
    KnownMotion &from = run_.at[k], &to = run_.at[k + 1];
    const std::array<double, 2> before = Rates(from);
    const auto move = [&](const std::array<double, 2>& rates) {
      for (size_t side = 0; side < 2; ++side) {
        if (!latent_[side]) continue;
        const double p = from.*kPressureOf[side] + run_.step * rates[side];
        held_[side] = p <= p_3_;
        to.*kPressureOf[side] = std::max(p_3_, p);
        from.*kRateOf[side] = held_[side] && from.*kPressureOf[side] <= p_3_ ? 0 : rates[side];
        to.*kRateOf[side] = from.*kRateOf[side];
      }
    };
    move(before);
    const std::array<double, 2> after = Rates(to);
    move({0.5 * (before[0] + after[0]), 0.5 * (before[1] + after[1])});
    if (equations_.remembers()) equations_.Advance(from, to);
  }

  PressureSlopes SlopesAt(const KnownMotion& at) const {
    PressureSlopes slopes;
    const model::BalancesOf<double> here = equations_.Values(at);
    for (size_t by = 0; by < 2; ++by) {
      KnownMotion moved = at;
      moved.*kPressureOf[by] += step_;
      const model::BalancesOf<double> there = equations_.Values(moved);
      slopes.torque[by] = (there.torque - here.torque) / step_;
      for (size_t of = 0; of < 2; ++of) slopes.flow[of][by] = (Flow(there, of) - Flow(here, of)) / step_;
      moved = at;
      moved.*kRateOf[by] += 1;
      slopes.capacity[by] = Flow(here, by) - Flow(equations_.Values(moved), by);
      slopes.moves[by] = latent_[by] && !held_[by] && slopes.capacity[by] > 0;
    }
    return slopes;
  }

  model::BalanceEquations equations_;
  double p_3_ = 0, step_ = 0;
  RunMotion& run_;
  std::array<bool, 2> latent_{}, held_{};
};

// delta at the end of a step of the trapezoidal rule, from the values at its beginning. Each side is computed
// alone, with the other side's part unchanged, because a step is short compared with the time in which
// pressures leak.
void Follow(const PressureSlopes& slopes, const std::array<double, 2>& flow, double step,
            std::array<double, 2>* delta, std::array<double, 2>* rate) {
  const std::array<double, 2> before = *delta;
  for (size_t i = 0; i < 2; ++i) {
    if (!slopes.moves[i]) {
      (*delta)[i] = (*rate)[i] = 0;
      continue;
    }
    const size_t other = 1 - i;
    const double given = flow[i] + slopes.flow[i][other] * before[other];
    const double own = slopes.flow[i][i] / slopes.capacity[i];
    (*delta)[i] =
        (before[i] + 0.5 * step * ((*rate)[i] + given / slopes.capacity[i])) / (1 - 0.5 * step * own);
    (*rate)[i] = given / slopes.capacity[i] + own * (*delta)[i];
  }
}

}  // namespace

bool MayMarch(const RunMotion& run) {
  return run.options.shaft == model::Shaft::kClamped && !run.options.bypass && run.speed_known &&
         !run.pressures;
}

void MarchPressures(const model::ModelDescription& model, RunMotion* run) {
  run->slopes.clear();
  run->pressures = true;
  March(model, run).Run();
}

BalanceSeries AfterPressures(const RunMotion& run, BalanceSeries change, double start) {
  const auto place = [](BalanceKind balance) { return static_cast<size_t>(balance); };
  Eigen::VectorXd& torque = change[place(BalanceKind::kTorque)];
  const double step = run.step * static_cast<double>(run.stride);
  std::array<double, 2> delta{}, rate{};
  for (size_t side = 0; side < 2; ++side) {
    if (!run.slopes.empty() && run.slopes.front().moves[side]) delta[side] = start;
  }
  for (size_t k = 0; k < run.slopes.size(); ++k) {
    const PressureSlopes& slopes = run.slopes[k];
    const auto i = static_cast<Eigen::Index>(k);
    std::array<double, 2> flow{};
    for (size_t side = 0; side < 2; ++side) {
      const Eigen::VectorXd& series = change[place(kFlows[side])];
      if (series.size() > 0) flow[side] = series[i];
    }
    if (k == 0) {
      for (size_t side = 0; side < 2; ++side)
        rate[side] = slopes.moves[side] ? flow[side] / slopes.capacity[side] : 0;
    } else {
      Follow(slopes, flow, step, &delta, &rate);
    }
    if (torque.size() > 0) torque[i] += slopes.torque[0] * delta[0] + slopes.torque[1] * delta[1];
    for (size_t side = 0; side < 2; ++side) {
      if (!CanForm(run, kFlows[side])) continue;
      const size_t other = 1 - side;
      change[place(kFlows[side])][i] += slopes.flow[side][other] * delta[other];
    }
  }
  for (size_t side = 0; side < 2; ++side) {
    if (!CanForm(run, kFlows[side])) change[place(kFlows[side])].resize(0);
  }
  return change;
}

}  // namespace hydro::diagnose
