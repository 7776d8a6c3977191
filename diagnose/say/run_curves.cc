#include "diagnose/say/run_curves.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace hydro::diagnose {
namespace {

constexpr size_t kMostPoints = 1200;
constexpr size_t kStretchesARun = 25;
constexpr size_t kShortestStretch = 60;  // samples

// Empty where the run cannot be simulated.
model::Response ResponseOf(const model::ModelDescription& model, const RunData& run,
                           const model::StartState& start) {
  try {
    return model::Respond(model, run.stimulus, start, {}, {});
  } catch (const model::ModelError&) {
    return {};
  }
}

// The predictions of the run by two models, each from its own start.
RunCurves Curves(const RunData& run, bool held_out, const model::Response& before,
                 const model::Response& after) {
  RunCurves curves;
  curves.run = run.name;
  curves.held_out = held_out;
  const size_t stride = std::max<size_t>(1, run.samples() / kMostPoints);
  const auto thin = [&](const std::vector<double>& values) {
    std::vector<double> thinned;
    for (size_t i = 0; i < values.size(); i += stride) thinned.push_back(values[i]);
    return thinned;
  };
  curves.time = thin(run.stimulus.time);
  for (const SignalData& signal : run.signals) {
    const auto c = static_cast<size_t>(signal.channel);
    curves.curves.push_back(
        {signal.channel, thin(signal.values), thin(before.values[c]), thin(after.values[c])});
  }
  return curves;
}

// A place in a run, and the distance between the models there, in noise units.
struct StretchPlace {
  double apart = 0;
  size_t signal = 0, first = 0, end = 0;
};

struct Responses {
  model::Response with, without;
};

StretchPlace MostIn(const RunData& run, const Responses& responses) {
  StretchPlace most;
  const size_t samples = run.samples();
  const size_t length = std::min(samples, std::max(kShortestStretch, samples / kStretchesARun));
  for (size_t s = 0; s < run.signals.size(); ++s) {
    const auto c = static_cast<size_t>(run.signals[s].channel);
    const std::vector<double>&with = responses.with.values[c], &without = responses.without.values[c];
    if (!(run.signals[s].noise > 0) || with.size() != samples || without.size() != samples) continue;
    for (size_t first = 0; first + length <= samples; first += std::max<size_t>(1, length / 4)) {
      double apart = 0;
      for (size_t i = first; i < first + length; ++i) apart += std::abs(with[i] - without[i]);
      apart /= run.signals[s].noise * static_cast<double>(length);
      if (apart > most.apart) most = {apart, s, first, first + length};
    }
  }
  return most;
}

std::vector<double> StretchPart(const std::vector<double>& values, const StretchPlace& place) {
  return {values.begin() + static_cast<std::ptrdiff_t>(place.first),
          values.begin() + static_cast<std::ptrdiff_t>(place.end)};
}

}  // namespace

std::vector<RunCurves> CurvesOf(const ProofContext& context, const Proof& proof, const WholeRuns& whole) {
  const bool in_turn = context.held_out.empty();
  const size_t fitted = context.runs.size(), all = fitted + context.held_out.size();
  std::vector<RunCurves> curves(all);
  ParallelFor(all, context.jobs, [&](size_t i) {
    const bool predicted = in_turn || i >= fitted;
    const size_t r = i < fitted ? i : i - fitted;
    const RunData& run = i < fitted ? *context.runs[r] : *context.held_out[r];
    const auto response = [&](const ProvedSet& set, ComparedModel which) {
      const WindowGap& gap = predicted ? whole.held_out[which][r] : whole.fitted[which][r];
      return ResponseOf(predicted ? set.ModelOf(r) : set.hypothesis.model, run,
                        gap.tested ? gap.start : run.start);
    };
    curves[i] =
        Curves(run, predicted, response(proof.Given(), kAsItWas), response(proof.Best(), kWithWhatWasFound));
  });
  return curves;
}

std::optional<FoundStretch> StretchOf(const ProofContext& context, const Proof& proof, const WholeRuns& whole,
                                      const std::string& effect) {
  const model::ModelDescription& with = proof.Found().model;
  model::ModelDescription without = with;
  std::erase_if(without.effects, [&](const model::EffectDescription& one) { return one.id == effect; });
  std::vector<Responses> responses(context.runs.size());
  std::vector<StretchPlace> places(context.runs.size());
  ParallelFor(context.runs.size(), context.jobs, [&](size_t r) {
    const RunData& run = *context.runs[r];
    const WindowGap& gap = whole.fitted[kWithWhatWasFound][r];
    const model::StartState& start = gap.tested ? gap.start : run.start;
    responses[r] = {ResponseOf(with, run, start), ResponseOf(without, run, start)};
    places[r] = MostIn(run, responses[r]);
  });
  const auto most = std::ranges::max_element(
      places, [](const StretchPlace& a, const StretchPlace& b) { return a.apart < b.apart; });
  if (most == places.end() || !(most->apart > 0)) return std::nullopt;
  const auto r = static_cast<size_t>(most - places.begin());
  const RunData& run = *context.runs[r];
  const SignalData& signal = run.signals[most->signal];
  const auto c = static_cast<size_t>(signal.channel);
  FoundStretch stretch{effect, run.name, signal.channel, {}, {}, {}, {}};
  stretch.time = StretchPart(run.stimulus.time, *most);
  stretch.measured = StretchPart(signal.values, *most);
  stretch.with = StretchPart(responses[r].with.values[c], *most);
  stretch.without = StretchPart(responses[r].without.values[c], *most);
  return stretch;
}

}  // namespace hydro::diagnose
