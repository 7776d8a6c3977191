#include "diagnose/say/lacking.h"

#include <algorithm>

#include "base/maths/spread.h"
#include "base/parallel.h"
#include "diagnose/balances/masks.h"
#include "diagnose/balances/test_functions.h"

namespace hydro::diagnose {
namespace {

constexpr std::array<const char*, kBalanceKinds> kBalanceNames = {"pump_torque", "flow_1",  "flow_2",
                                                                  "arm_torque",  "level_1", "level_2"};
constexpr uint64_t kDrawSeed = 11;
// A certain direction, on a scale of -1 to 1: three standard deviations of the speed's noise.
constexpr double kSure = 0.997;
constexpr size_t kNearBlocks = 16;  // on either side, over which a block's noise is averaged

LackingRun LackingIn(const model::ModelDescription& model, const RunData& run, size_t which,
                     const PressureOffsets& offsets) {
  LackingRun lacking;
  const RunMotion read = MotionOf(run, model.parameters);
  lacking.motion = Without(read, ErrorsOf(model, read), 1);
  if (read.pressures) {
    for (model::KnownMotion& at : lacking.motion.at) at.p1 -= offsets.p1, at.p2 -= offsets.p2;
  }
  lacking.base = SeriesOf(model, lacking.motion);
  const BaseSeries plain = SeriesOf(model, read);
  for (size_t draw = 0; draw < kNoiseDraws; ++draw) {
    const uint64_t seed = kDrawSeed + kNoiseDraws * which + draw;
    lacking.noise[draw] = Beyond(model, WithNoiseAgain(read, model.parameters, seed), plain);
  }
  return lacking;
}

// Where the pump's direction is not certain, dry friction may have any value. Short stops are in no mask.
void MaskReversals(LackingRun* run) {
  std::vector<uint8_t>& mask = run->masks[static_cast<size_t>(BalanceKind::kTorque)];
  for (size_t i = 0; i < mask.size(); ++i) {
    if (std::abs(run->At(i).pump_direction) < kSure) mask[i] = 1;
  }
}

// From 0 where masked to 1 at kRise from there, as smooth as test functions are.
Eigen::VectorXd WeightsOf(const std::vector<uint8_t>& mask, double interval) {
  const double rise = std::max(1.0, kRise / interval);
  Eigen::VectorXd weights(static_cast<Eigen::Index>(mask.size()));
  double away = 0;
  for (size_t i = 0; i < mask.size(); ++i) {
    away = mask[i] != 0 ? 0 : away + 1;
    weights[static_cast<Eigen::Index>(i)] = away;
  }
  away = 0;
  for (size_t i = mask.size(); i-- > 0;) {
    away = mask[i] != 0 ? 0 : away + 1;
    double& weight = weights[static_cast<Eigen::Index>(i)];
    weight = std::pow(std::sin(0.5 * std::numbers::pi * std::min(1.0, std::min(weight, away) / rise)), 2);
  }
  return weights;
}

// Appends the blocks of one run. The effect of noise depends on the motion, so a block's noise is averaged
// with its neighbours'.
void AddBlocks(const LackingRun& run, size_t which, BalanceKind balance, size_t length,
               std::vector<Block>* blocks) {
  const size_t before = blocks->size(), size = run.masks[static_cast<size_t>(balance)].size();
  std::vector<double> drawn = {0};  // cumulative sums of the draws' squares
  for (size_t first = 0; first + length <= size; first += length) {
    Block block{which, first, first + length, 0, 0};
    block.value = -MeanOver(block, run, balance, run.base.left);
    if (std::isnan(block.value)) continue;
    drawn.push_back(drawn.back());
    for (const BalanceSeries& draw : run.noise)
      drawn.back() += std::pow(MeanOver(block, run, balance, draw), 2) / kNoiseDraws;
    blocks->push_back(block);
  }
  const size_t count = blocks->size() - before;
  for (size_t i = 0; i < count; ++i) {
    const size_t first = i < kNearBlocks ? 0 : i - kNearBlocks, end = std::min(count, i + kNearBlocks + 1);
    double& noise = (*blocks)[before + i].noise;
    noise = std::sqrt((drawn[end] - drawn[first]) / static_cast<double>(end - first));
    if (!(noise > 0)) noise = std::numeric_limits<double>::infinity();
  }
}

// No run counts more because its sensors happen to be quiet: a machine repeats itself less exactly than they
// measure.
void LevelNoise(std::vector<Block>* blocks) {
  std::vector<double> noise;
  for (const Block& block : *blocks) noise.push_back(block.noise);
  if (noise.empty()) return;
  const double usual = maths::Median(noise);
  for (Block& block : *blocks) block.noise = std::max(block.noise, usual);
}

}  // namespace

std::string NameOf(BalanceKind balance) { return kBalanceNames[static_cast<size_t>(balance)]; }

std::string UnitOf(BalanceKind balance, const UnitSystem& units) {
  const bool flow = balance == BalanceKind::kFlow1 || balance == BalanceKind::kFlow2;
  return flow ? units.UnitFor("in^3/s") : units.UnitFor("in-lbf", balance == BalanceKind::kArm ? -1 : 0);
}

double MeanOver(const Block& block, const LackingRun& run, BalanceKind balance, const BalanceSeries& series) {
  const Eigen::VectorXd& values = series[static_cast<size_t>(balance)];
  return MeanOver(block, run, balance, [&](size_t i) { return values[static_cast<Eigen::Index>(i)]; });
}

std::vector<LackingRun> LackingIn(const model::ModelDescription& model,
                                  const std::vector<const RunData*>& runs, int jobs,
                                  const PressureOffsets& offsets) {
  std::vector<LackingRun> all(runs.size());
  ParallelFor(runs.size(), jobs, [&](size_t r) { all[r] = LackingIn(model, *runs[r], r, offsets); });
  std::vector<RunMotion> motions(all.size());
  std::ranges::transform(all, motions.begin(), &LackingRun::motion);
  const HeldPressure held = FindHeldPressure(motions, model.parameters);
  for (LackingRun& run : all) {
    run.masks = MasksOf(run.motion, run.base.left, held, model.parameters);
    MaskReversals(&run);
    const double interval = run.motion.step * static_cast<double>(run.motion.stride);
    for (size_t b = 0; b < kBalanceKinds; ++b) run.weights[b] = WeightsOf(run.masks[b], interval);
  }
  return all;
}

std::vector<Block> BlocksOf(const std::vector<LackingRun>& runs, BalanceKind balance, double duration) {
  std::vector<Block> blocks;
  for (size_t r = 0; r < runs.size(); ++r) {
    const RunMotion& motion = runs[r].motion;
    const double instants = duration / (motion.step * static_cast<double>(motion.stride));
    AddBlocks(runs[r], r, balance, static_cast<size_t>(std::max(1.0, std::round(instants))), &blocks);
  }
  LevelNoise(&blocks);
  return blocks;
}

}  // namespace hydro::diagnose
