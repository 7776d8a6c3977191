#include "diagnose/prove/proof_context.h"

#include <algorithm>

#include "diagnose/recording/windows.h"

namespace hydro::diagnose {
namespace {

constexpr double kWindowsPerRun = 4;
// Stretches of a signal within a search horizon that count as independent of each other.
constexpr double kIndependentStretches = 10;

// The number of independent pieces of evidence in the runs, if they are as wrong as a wrong model leaves
// them.
double EvidenceOf(const std::vector<const RunData*>& runs) {
  double pieces = 0;
  for (const RunData* run : runs) {
    const double stretches = std::max(1.0, run->duration() / kHorizon);
    pieces += kIndependentStretches * stretches * static_cast<double>(run->signals.size());
  }
  return pieces;
}

}  // namespace

std::vector<size_t> MovableValues(const ProofContext& context) {
  std::vector<size_t> places;
  for (const Change& change : context.changes) {
    if (change.effect.empty()) places.push_back(model::BasePlace(change.parameter));
  }
  return places;
}

bool TimeIsUp(const ProofContext& context) { return context.time_is_up && context.time_is_up(); }

double SearchHorizon(const std::vector<const RunData*>& runs) {
  const double shortest = ShortestDuration(runs);
  const double sampled = kFewestSamplesOfAWindow * SampleInterval(runs);
  return std::max(std::min(std::max(kHorizon, sampled), shortest / kWindowsPerRun), 0.25 * sampled);
}

FitOptions FineFit(int jobs) {
  FitOptions fine;
  fine.most_iterations = 15;
  fine.tolerance = 1e-5;
  fine.jobs = jobs;
  return fine;
}

FitOptions FitToCompare(int jobs) {
  FitOptions compare = FineFit(jobs);
  compare.tolerance = kToCompare;
  return compare;
}

std::shared_ptr<const Knowledge> KnownAt(const model::ModelDescription& given,
                                         const std::vector<const RunData*>& runs, double sum) {
  return std::make_shared<Knowledge>(Knowledge{given, sum / EvidenceOf(runs)});
}

}  // namespace hydro::diagnose
