// Where columns are judged against exact simulations, and how near they must be.
#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/diagnose/balances/clean_scan.h"

namespace hydro::testing {

// A balance is judged where the thing makes so many times what smoothing leaves of the plain machine:
// friction that turns within the smoothing, mostly.
inline constexpr double kAboveSmoothing = 10;

// What smoothing leaves of the balances of the plain machine, the most in any run; at least a ten-thousandth
// of their main terms, and of levels a hundredth of p_3.
double Smoothing(diagnose::BalanceKind balance);

// Where things were judged, and where columns met what was simulated for some amount.
struct Judged {
  std::map<std::pair<std::string, diagnose::BalanceKind>, std::string> failed;
  std::set<std::pair<std::string, diagnose::BalanceKind>> met;

  // `effect`: whose tolerances hold; "" those of most.
  void Add(const std::vector<Comparison>& all, const std::string& effect = "");
  // Fails the test for each balance of each run that was judged and never met.
  void Expect(const std::string& what) const;
};

// The rich runs of this machine, as they are for the plain one.
std::vector<diagnose::RunData> RunsOf(const model::ModelDescription& truth);
// All variants of all effects with each name that they can take, and the plain runs' columns for the units of
// their amounts.
const CleanScan& PlainScan();
// The plain machine with the effect, these of its parameters elsewhere.
model::ModelDescription With(const diagnose::EffectVariant& variant,
                             const std::map<std::string, double>& values);

}  // namespace hydro::testing
