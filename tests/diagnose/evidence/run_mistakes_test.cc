// Tests of what one recording says of its own mistakes: the balances of corrected signals, and the search.
#include "diagnose/evidence/run_mistakes.h"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "diagnose/evidence/recording_balances.h"
#include "tests/diagnose/noisy_rig.h"
#include "tests/table1.h"

namespace hydro::diagnose {
namespace {

using Recording = runs::MeasuredRun;

const model::ModelDescription kAsGiven = {"Table 1", testing::Table1(), {}};

bool NeverUp() { return false; }

// A rig that lacks nothing: clamped, or with a free arm, under steps of both signs.
Recording Recorded(model::Shaft shaft) {
  testing::NoisyRig rig;
  rig.model = kAsGiven;
  return rig.Record("run", shaft, 0.1, 2, false, [](double t) { return std::sin(9 * t) > 0 ? 3.0 : -2.0; })
      .measured;
}

void Multiply(std::vector<double>* values, double factor) {
  for (double& value : *values) value *= factor;
}

RecordingMistake Named(const Recording& run, const std::string& what) {
  for (const RecordingMistake& one : PossibleMistakes(run)) {
    if (one.what == what) return one;
  }
  ADD_FAILURE() << what;
  return {};
}

// Tests that the balances close with the numbers as they are, with no other ones as well, and small numbers
// gain nothing.
TEST(RecordingBalances, CloseWithTheRightNumbers) {
  for (const model::Shaft shaft : {model::Shaft::kClamped, model::Shaft::kFree}) {
    const Recording run = Recorded(shaft);
    const RecordingBalances balances(kAsGiven, run, PossibleMistakes(run));
    EXPECT_LT(balances.LeastLeftOpen(), 0.02);
    const double right = balances.Evidence({});
    for (const auto& change :
         {+[](SignalFactors& f) { f.p1 = f.p2 = 14.5; }, +[](SignalFactors& f) { f.voltage = -1; },
          +[](SignalFactors& f) { f.motor_speed = 0.1; }, +[](SignalFactors& f) { f.exchanged = true; },
          +[](SignalFactors& f) { f.p1 = f.p2 = f.motor_speed = f.voltage = 1e-3; }}) {
      SignalFactors factors;
      change(factors);
      EXPECT_LT(balances.Evidence(factors), right - OddsAgainstMistake());
    }
  }
}

// Tests that a correction gives back the evidence that the mistake took.
TEST(RecordingBalances, UndoneMistakes) {
  const Recording run = Recorded(model::Shaft::kClamped);
  Recording wrong = run;
  Multiply(&wrong.motor_speed.values, 30 / M_PI);
  std::swap(wrong.p1, wrong.p2);
  SignalFactors undone;
  AddFactors(Named(wrong, "motor_speed is in rpm"), &undone);
  AddFactors(Named(wrong, "p1 and p2 are exchanged"), &undone);
  EXPECT_NEAR(undone.motor_speed, M_PI / 30, 1e-9);
  EXPECT_TRUE(undone.exchanged);
  const double right = RecordingBalances(kAsGiven, run, PossibleMistakes(run)).Evidence({});
  EXPECT_NEAR(RecordingBalances(kAsGiven, wrong, PossibleMistakes(wrong)).Evidence(undone), right, 1);
}

// Tests that what cannot be formed says nothing.
TEST(RecordingBalances, NothingFormed) {
  Recording run = Recorded(model::Shaft::kClamped);
  run.p1 = run.p2 = run.motor_angle = {};
  const RecordingBalances balances(kAsGiven, run, PossibleMistakes(run));
  EXPECT_EQ(balances.Evidence({}), 0);
  EXPECT_EQ(balances.LeastLeftOpen(), 0);
}

// Tests what one run says by itself: nothing when it is right, and its mistake first when it is not.
TEST(RunMistakes, OneRun) {
  const Recording run = Recorded(model::Shaft::kClamped);
  EXPECT_LT(RunMistakes(kAsGiven, run).Search(NeverUp).front().Merit(), 0);
  Recording bar = run;
  for (auto signal : {&Recording::p1, &Recording::p2}) Multiply(&(bar.*signal).values, 1 / 14.5037738);
  const RunMistakes wrong(kAsGiven, bar);
  const std::vector<MistakeTrial> found = wrong.Search(NeverUp);
  ASSERT_EQ(found.front().mistakes.size(), 1u);
  EXPECT_EQ(found.front().mistakes[0].what, "p1 and p2 are in bar");
  EXPECT_GT(found.front().Merit(), OddsAgainstMistake());
  EXPECT_EQ(wrong.Try(found.front().mistakes).gain, found.front().gain);
  EXPECT_EQ(wrong.Try({}).gain, 0);
  EXPECT_TRUE(wrong.Search([] { return true; }).empty());
}

// The signal as counts of `scale` each, in integers of this size without a sign.
void StoreUnsigned(double bits, double scale, runs::MeasuredSignal* signal) {
  for (double& value : signal->values) {
    const double counts = std::round(value / scale);
    value = scale * (counts < 0 ? counts + std::exp2(bits) : counts);
  }
  signal->source.scale = scale;
}

// Tests that signed numbers that were read as unsigned are found, of any size and signal, and that a
// recorder's whole range is none.
TEST(RunMistakes, SignedNumbersReadAsUnsigned) {
  const Recording run = Recorded(model::Shaft::kClamped);
  for (const auto& [bits, scale] : {std::pair{8, 0.05}, std::pair{12, 0.0025}, std::pair{16, 0.01}}) {
    Recording wrong = run;
    StoreUnsigned(bits, scale, &wrong.voltage);
    const MistakeTrial found = RunMistakes(kAsGiven, wrong).Search(NeverUp).front();
    ASSERT_EQ(found.mistakes.size(), 1u);
    EXPECT_THAT(found.mistakes[0].what,
                ::testing::HasSubstr("a signed number read as unsigned (" + std::to_string(bits) + " bits)"));
    EXPECT_GT(found.Merit(), 0);
    Correct(found.mistakes[0], &wrong);
    for (size_t k = 0; k < run.samples(); ++k)
      EXPECT_NEAR(wrong.voltage.values[k], run.voltage.values[k], scale);
  }
  Recording speed = run;
  StoreUnsigned(14, 0.05, &speed.motor_speed);
  EXPECT_THAT(RunMistakes(kAsGiven, speed).Search(NeverUp).front().mistakes.front().what,
              ::testing::StartsWith("motor_speed jumps by 16384 counts"));
  testing::NoisyRig rig;
  rig.model = kAsGiven;
  Recording one_way = rig.Record("pulses", model::Shaft::kClamped, 0.1, 2, false,
                                 [](double t) { return std::sin(9 * t) > 0 ? 2.55 : 0.0; })
                          .measured;
  one_way.voltage.source.scale = 0.01;
  EXPECT_LT(RunMistakes(kAsGiven, one_way).Search(NeverUp).front().Merit(), 0);
}

// Tests that nothing is said of a run at rest: noise in other units is noise.
TEST(RunMistakes, NothingOfARunAtRest) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    Recording run = Recorded(model::Shaft::kClamped);
    run.motor_angle = {};
    for (size_t k = 0; k < run.samples(); ++k) {
      run.voltage.values[k] = 0.3 * std::sin(0.01 * static_cast<double>(k));
      run.motor_speed.values[k] = 0.3 * normal(random);
      run.p1.values[k] = 100 + 1.5 * normal(random);
      run.p2.values[k] = 100 + 1.5 * normal(random);
    }
    EXPECT_TRUE(RunMistakes(kAsGiven, run).Search(NeverUp).empty()) << seed;
  }
}

// Tests that samples closer than any recorder takes form no balance: the work of one grows with how close
// they are.
TEST(RunMistakes, SamplesTooClose) {
  Recording run = Recorded(model::Shaft::kClamped);
  EXPECT_TRUE(RunMistakes(kAsGiven, run).Formed());
  Multiply(&run.time, 1e-3);
  run.time_source.scale = 1e-3;
  const RunMistakes close(kAsGiven, run);
  EXPECT_FALSE(close.Formed());
  EXPECT_EQ(close.LeastLeftOpen(), 1);
  EXPECT_EQ(close.Search(NeverUp).front().mistakes.front().what, "time is in s, not in ms");
}

// Tests that a factor without a unit gains where it is right, and half of it less.
TEST(RunMistakes, FactorWithoutAUnit) {
  Recording run = Recorded(model::Shaft::kClamped);
  for (auto signal : {&Recording::p1, &Recording::p2}) Multiply(&(run.*signal).values, 3.1);
  const RunMistakes mistakes(kAsGiven, run);
  const auto gain = [&](double factor) {
    return mistakes.Gain({UnknownUnit({&Recording::p1, &Recording::p2}, factor)});
  };
  EXPECT_GT(gain(1 / 3.1), OddsAgainstMistake());
  EXPECT_GT(gain(1 / 3.1), gain(1 / 1.6));
  EXPECT_GT(gain(1 / 3.1), gain(1 / 6.2));
}

}  // namespace
}  // namespace hydro::diagnose
