// Test functions: lapped local cosines, orthonormal, each within one unmasked piece of a run and smooth at its ends. What a
// balance leaves is weighed with them, so nothing has to be integrated and gaps count for nothing.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace hydro::diagnose {

struct TestFunctions {
  Eigen::Index first = 0;     // the sample at which they begin
  Eigen::MatrixXd values;     // a row for each, a column for each sample from `first` on
  Eigen::VectorXd frequency;  // Hz
};

// Test functions end at this part of the rate of the slowest signal of a balance: samples show no more of its motion.
inline constexpr double kOfTheRate = 0.2;

// s, the length of the tiles into which pieces are cut: `duration` is that of a typical run.
double TileLength(double duration);

// Those of all unmasked pieces of a series with samples each `step` seconds, up to `highest` Hz. `mask`: 1 where the series
// says nothing. Frequencies within 5 Hz of the mains' are left out.
std::vector<TestFunctions> TestFunctionsOf(const std::vector<uint8_t>& mask, double step, double length,
                                           double highest);

// Which frequencies share a variance, by tiles of that length.
int BandOf(double frequency, double length);

}  // namespace hydro::diagnose
