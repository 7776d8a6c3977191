#include "diagnose/fit/unknown_findings.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace hydro::diagnose {
namespace {

const double kSameFactor = std::log(1.2);

double SizeOf(const RecordingFinding& finding) {
  return std::log(finding.mistakes.front().factors.front().second);
}

// Whether all runs say nearly the same factor of the same signals.
bool Agree(const std::vector<RecordingFinding>& findings) {
  return std::all_of(findings.begin(), findings.end(), [&](const RecordingFinding& one) {
    return one.mistakes.front().factors.front().first ==
               findings.front().mistakes.front().factors.front().first &&
           std::abs(SizeOf(one) - SizeOf(findings.front())) <= kSameFactor;
  });
}

void GiveOneFactor(std::vector<RecordingFinding>* findings) {
  std::vector<SignalOfRun> signals;
  for (const auto& [signal, factor] : findings->front().mistakes.front().factors) signals.push_back(signal);
  double sum = 0;
  for (const RecordingFinding& one : *findings) sum += SizeOf(one);
  const RecordingMistake common = UnknownUnit(signals, std::exp(sum / static_cast<double>(findings->size())));
  for (RecordingFinding& one : *findings) one.mistakes = {common};
}

}  // namespace

std::vector<RecordingFinding> UnknownFactorFindings(const std::vector<std::optional<RunCheck>>& checks,
                                                    int jobs) {
  std::vector<std::optional<MistakeTrial>> trials(checks.size());
  ParallelFor(checks.size(), jobs, [&](size_t r) {
    if (!checks[r]->IsInOrder()) trials[r] = checks[r]->UnknownFactor();
  });
  std::vector<RecordingFinding> findings;
  size_t asked = 0;
  for (size_t r = 0; r < checks.size(); ++r) {
    asked += checks[r]->IsInOrder() ? 0 : 1;
    if (!trials[r].has_value() || trials[r]->gain < FarAlone()) continue;
    findings.push_back({r, trials[r]->mistakes, checks[r]->as_recorded(), trials[r]->worst, trials[r]->gain});
  }
  // One run's may stand for anything that is missing there.
  if (2 * findings.size() <= asked) return {};
  if (!findings.empty() && Agree(findings)) GiveOneFactor(&findings);
  return findings;
}

}  // namespace hydro::diagnose
