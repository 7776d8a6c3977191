// Test functions: lapped local cosines, orthonormal, each within one unmasked piece of a run and smooth at
// its ends. Balances are weighed with them, so that nothing has to be integrated and gaps do not count.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace hydro::diagnose {

struct TestFunctions {
  Eigen::Index first = 0;     // the sample at which the functions begin
  Eigen::MatrixXd values;     // one row for each function, one column for each sample from `first` on
  Eigen::VectorXd frequency;  // Hz
};

// Test functions end at this fraction of the sampling rate of the balance's slowest signal. Samples show no
// faster motion.
inline constexpr double kOfTheRate = 0.2;

// s: smoothing and derivatives spread a masked sample this far, and a valve closes this much later than its
// side's pressure leaves the level.
inline constexpr double kSpread = 0.004;
// s, rise time of a test function at the end of a piece: slower than the spread from the smoothing of
// signals.
inline constexpr double kRise = 0.008;

// s, the length of the tiles into which pieces are cut. `duration` is that of a typical run.
double TileLength(double duration);

// The test functions of all unmasked pieces of a series sampled every `step` seconds, up to `highest` Hz.
// `mask` is 1 where the series says nothing. Frequencies within 5 Hz of the mains frequency are left out.
std::vector<TestFunctions> TestFunctionsOf(const std::vector<uint8_t>& mask, double step, double length,
                                           double highest);

// The band of a frequency, for tiles of that length. Frequencies of one band share a variance.
int BandOf(double frequency, double length);

}  // namespace hydro::diagnose
