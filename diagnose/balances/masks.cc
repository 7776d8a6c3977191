#include "diagnose/balances/masks.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/maths/spread.h"
#include "diagnose/balances/test_functions.h"

namespace hydro::diagnose {
namespace {

// s: the pump is at rest where noise hides its speed for this long. A shorter rest is a reversal.
constexpr double kStillTime = 0.008;
// s: smoothing spreads the rest this far.
constexpr double kStillSpread = 0.003;
// Values below this part of the range of pressures may belong to a held side.
constexpr double kLowPart = 0.15;
constexpr size_t kEnoughLow = 200;
// s: a pump that reverses rests for a shorter time.
constexpr double kRestTime = 0.1;

// Widens marked stretches by `by` on either side.
void Widen(size_t by, std::vector<uint8_t>* mask) {
  std::vector<uint8_t> wide(*mask);
  const size_t n = mask->size();
  for (size_t i = 0; i < n; ++i) {
    if ((*mask)[i] == 0) continue;
    const size_t from = i < by ? 0 : i - by, to = std::min(n, i + by + 1);
    std::fill(wide.begin() + static_cast<std::ptrdiff_t>(from),
              wide.begin() + static_cast<std::ptrdiff_t>(to), uint8_t{1});
  }
  *mask = std::move(wide);
}

size_t Samples(double seconds, const RunMotion& run) {
  return std::max<size_t>(1, static_cast<size_t>(std::lround(seconds / run.step)));
}

std::vector<uint8_t> AtRest(const RunMotion& run) {
  std::vector<uint8_t> rest(run.size(), 0);
  const double limit = kHides * run.speed_noise;
  const size_t shortest = std::max<size_t>(2, Samples(kStillTime, run));
  for (size_t i = 0; i < run.size();) {
    size_t end = i;
    while (end < run.size() && std::abs(run.at[end].motor_speed) < limit) ++end;
    if (end - i >= shortest)
      std::fill(rest.begin() + static_cast<std::ptrdiff_t>(i),
                rest.begin() + static_cast<std::ptrdiff_t>(end), uint8_t{1});
    i = std::max(end, i + 1);
  }
  Widen(Samples(kStillSpread, run), &rest);
  return rest;
}

std::vector<uint8_t> Gaps(const RunMotion& run, const std::vector<GridChannel>& signals) {
  std::vector<uint8_t> mask(run.size(), 0);
  for (const GridChannel signal : signals) {
    const std::vector<uint8_t>& gap = run.Of(signal).gap;
    for (size_t k = 0; k < gap.size(); ++k) mask[k] |= gap[k];
  }
  Widen(Samples(kSpread, run), &mask);
  return mask;
}

std::vector<uint8_t> Either(std::vector<uint8_t> a, const std::vector<uint8_t>& b) {
  for (size_t k = 0; k < a.size(); ++k) a[k] |= b[k];
  return a;
}

std::vector<uint8_t> EachStride(const std::vector<uint8_t>& mask, size_t stride) {
  std::vector<uint8_t> thin;
  for (size_t k = 0; k < mask.size(); k += stride) {
    const auto from = mask.begin() + static_cast<std::ptrdiff_t>(k < stride / 2 ? 0 : k - stride / 2);
    const auto to = mask.begin() + static_cast<std::ptrdiff_t>(std::min(mask.size(), k + stride / 2 + 1));
    thin.push_back(std::any_of(from, to, [](uint8_t one) { return one != 0; }) ? 1 : 0);
  }
  return thin;
}

// Finds where the side's valve passes oil: more flows in than noise and other terms explain.
std::vector<uint8_t> Held(const RunMotion& run, const std::vector<uint8_t>& low, const Eigen::VectorXd& flow,
                          double D) {
  const auto n = static_cast<size_t>(flow.size());
  std::vector<double> lacking(n);
  double speed = 0;
  for (size_t i = 0; i < n; ++i) {
    lacking[i] = -flow[static_cast<Eigen::Index>(i)];
    speed += std::pow(run.at[i * run.stride].motor_speed, 2);
  }
  const double step = run.step * static_cast<double>(run.stride);
  lacking = Smoothed(lacking, std::max(0.5, 0.003 / step));
  const double flow_size = D * std::sqrt(speed / static_cast<double>(n));
  std::vector<double> far;
  for (size_t i = 0; i < n; ++i) {
    if (low[i] == 0) far.push_back(lacking[i]);
  }
  // Five robust standard deviations, and two per cent of the pump's flow, because the leakage alone may be
  // wrong by that much.
  double limit = 0.15 * flow_size;
  if (far.size() > 50) {
    const double middle = maths::Median(far);
    for (double& one : far) one = std::abs(one - middle);
    limit = 5 * 1.48 * maths::Median(far);
  }
  limit += 0.02 * flow_size;
  std::vector<uint8_t> mask(n, 1);
  for (size_t i = 0; i < n; ++i) mask[i] = low[i] != 0 && lacking[i] > limit ? 0 : 1;
  return mask;
}

// Stretches, from and to (not included), in which the pump hardly turns, and not just because it reverses.
std::vector<std::pair<size_t, size_t>> Rests(const RunMotion& run) {
  // As a fraction of the largest speed.
  constexpr double kRest = 0.05;
  double largest = 0;
  for (const model::KnownMotion& at : run.at) largest = std::max(largest, std::abs(at.motor_speed));
  std::vector<std::pair<size_t, size_t>> rests;
  for (size_t i = 0; i < run.size();) {
    size_t end = i;
    while (end < run.size() && std::abs(run.at[end].motor_speed) < kRest * largest) ++end;
    if (end - i >= Samples(kRestTime, run)) rests.emplace_back(i, end);
    i = std::max(end, i + 1);
  }
  return rests;
}

// The rests of a machine with a valve that closes at rest and that the model lacks. In most of these rests
// the pump stands although the pressures would turn it against its friction and the motor. That valve then
// determines how oil and arm behave, and also for a while before and after.
std::vector<uint8_t> HeldAtRest(const RunMotion& run, const model::Parameters& p) {
  // Static friction of pumps is at most about this many times the friction in the model.
  constexpr double kStatic = 2;
  std::vector<uint8_t> held(run.size(), 0);
  if (!run.pressures || !run.arm_moves) return held;
  const auto would_turn = [&](const model::KnownMotion& at) {
    const double motor = std::clamp(p.k_1 * at.voltage, -p.T_pmax, p.T_pmax);
    return std::abs(motor - p.D * (at.p2 - at.p1)) > kStatic * (p.T_s + p.f * std::abs(at.p1 + at.p2));
  };
  const std::vector<std::pair<size_t, size_t>> rests = Rests(run);
  size_t stand = 0;
  for (const auto& [from, to] : rests) {
    const auto turned = std::count_if(run.at.begin() + static_cast<std::ptrdiff_t>(from),
                                      run.at.begin() + static_cast<std::ptrdiff_t>(to), would_turn);
    stand += 2 * static_cast<size_t>(turned) > to - from ? 1 : 0;
    std::fill(held.begin() + static_cast<std::ptrdiff_t>(from),
              held.begin() + static_cast<std::ptrdiff_t>(to), uint8_t{1});
  }
  if (2 * stand <= rests.size()) return std::vector<uint8_t>(run.size(), 0);
  Widen(Samples(kRestTime, run), &held);
  return held;
}

bool BothLatent(const RunMotion& run) {
  return run.IsLatent(GridChannel::kP1) && run.IsLatent(GridChannel::kP2);
}

// The lower of the pressures that were measured.
double Lower(const RunMotion& run, const model::KnownMotion& at) {
  if (run.IsLatent(GridChannel::kP1)) return at.p2;
  return run.IsLatent(GridChannel::kP2) ? at.p1 : std::min(at.p1, at.p2);
}

}  // namespace

HeldPressure FindHeldPressure(const std::vector<RunMotion>& runs, const model::Parameters& given) {
  HeldPressure held{given.p_3, 0};
  double highest = given.p_3, noise = 0;
  for (const RunMotion& run : runs) {
    if (!run.pressures) continue;
    noise = std::max({noise, run.Of(GridChannel::kP1).noise, run.Of(GridChannel::kP2).noise});
    for (const model::KnownMotion& at : run.at) highest = std::max({highest, at.p1, at.p2});
  }
  std::vector<double> low;
  for (const RunMotion& run : runs) {
    if (!run.pressures || BothLatent(run)) continue;
    for (const model::KnownMotion& at : run.at) {
      const double lower = Lower(run, at);
      if (lower < given.p_3 + kLowPart * (highest - given.p_3)) low.push_back(lower);
    }
  }
  double spread = 0;
  if (low.size() > kEnoughLow) {
    held.at = maths::Median(low);
    double sum = 0, count = 0, mean = 0;
    for (const double value : low) {
      if (std::abs(value - held.at) < 30 * noise) mean += value, ++count;
    }
    mean /= std::max(count, 1.0);
    for (const double value : low) {
      if (std::abs(value - held.at) < 30 * noise) sum += std::pow(value - mean, 2);
    }
    spread = 1.5 * std::sqrt(sum / std::max(count, 1.0));
  }
  held.margin = std::max({6 * noise, 0.01 * (highest - given.p_3), spread});
  return held;
}

std::array<std::vector<uint8_t>, kBalanceKinds> MasksOf(const RunMotion& run, const BalanceSeries& left,
                                                        const HeldPressure& held,
                                                        const model::Parameters& given) {
  std::array<std::vector<uint8_t>, kBalanceKinds> masks;
  const auto place = [](BalanceKind balance) { return static_cast<size_t>(balance); };
  const std::vector<uint8_t> closed = HeldAtRest(run, given);
  std::vector<GridChannel> speed = {run.from_angle ? GridChannel::kAngle : GridChannel::kSpeed};
  if (CanForm(run, BalanceKind::kTorque)) {
    std::vector<GridChannel> signals = speed;
    if (run.pressures) signals.insert(signals.end(), {GridChannel::kP1, GridChannel::kP2});
    masks[place(BalanceKind::kTorque)] =
        EachStride(Either(Either(AtRest(run), closed), Gaps(run, signals)), run.stride);
  }
  if (CanForm(run, BalanceKind::kArm)) {
    masks[place(BalanceKind::kArm)] = EachStride(
        Either(closed, Gaps(run, {GridChannel::kArm, GridChannel::kP1, GridChannel::kP2})), run.stride);
  }
  std::vector<GridChannel> signals = speed;
  signals.insert(signals.end(), {GridChannel::kP1, GridChannel::kP2});
  if (run.arm_moves) signals.push_back(GridChannel::kArm);
  const std::vector<uint8_t> gaps = Either(closed, Gaps(run, signals));
  const std::pair<BalanceKind, BalanceKind> sides[] = {{BalanceKind::kFlow1, BalanceKind::kLevel1},
                                                       {BalanceKind::kFlow2, BalanceKind::kLevel2}};
  for (const auto& [flow, level] : sides) {
    if (!CanForm(run, flow)) continue;
    double model::KnownMotion::*pressure =
        flow == BalanceKind::kFlow1 ? &model::KnownMotion::p1 : &model::KnownMotion::p2;
    std::vector<uint8_t> low(run.size());
    for (size_t k = 0; k < run.size(); ++k) low[k] = run.at[k].*pressure < held.at + held.margin ? 1 : 0;
    const std::vector<uint8_t> only_low = EachStride(low, run.stride);
    Widen(Samples(kSpread, run), &low);
    masks[place(flow)] = EachStride(Either(low, gaps), run.stride);
    masks[place(level)] =
        Either(Held(run, only_low, left[place(flow)], given.D), EachStride(gaps, run.stride));
  }
  return masks;
}

}  // namespace hydro::diagnose
