#include "diagnose/verdict/effect_stretch.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/parallel.h"

namespace hydro::diagnose {

namespace {

constexpr size_t kStretchesARun = 25;
constexpr size_t kShortestStretch = 60;  // samples

// A place in a run, and how far the two models are apart there in noise units.
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
    if (!(run.signals[s].noise > 0)) continue;
    for (size_t first = 0; first + length <= samples; first += std::max<size_t>(1, length / 4)) {
      double apart = 0;
      for (size_t i = first; i < first + length; ++i) {
        apart += std::abs(responses.with.values[c][i] - responses.without.values[c][i]);
      }
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

std::optional<FoundStretch> StretchOf(const SearchContext& context, const Explanation& best,
                                      const std::string& effect) {
  const model::ModelDescription& with = best.fitted.hypothesis.model;
  model::ModelDescription without = with;
  std::erase_if(without.effects, [&](const model::EffectDescription& one) { return one.id == effect; });
  std::vector<Responses> responses(context.runs.size());
  std::vector<StretchPlace> places(context.runs.size());
  ParallelFor(context.runs.size(), context.jobs, [&](size_t r) {
    const RunData& run = *context.runs[r];
    try {
      const model::StartState& start = best.fitted.runs[r].start;
      responses[r] = {model::Respond(with, run.stimulus, start, {}, {}),
                      model::Respond(without, run.stimulus, start, {}, {})};
      places[r] = MostIn(run, responses[r]);
    } catch (const model::ModelError&) {
      places[r] = {};
    }
  });
  size_t r = 0;
  for (size_t i = 1; i < places.size(); ++i) {
    if (places[i].apart > places[r].apart) r = i;
  }
  if (places.empty() || !(places[r].apart > 0)) return std::nullopt;
  const RunData& run = *context.runs[r];
  const SignalData& signal = run.signals[places[r].signal];
  const auto c = static_cast<size_t>(signal.channel);
  FoundStretch stretch{effect, run.name, signal.channel, {}, {}, {}, {}};
  stretch.time = StretchPart(run.stimulus.time, places[r]);
  stretch.measured = StretchPart(signal.values, places[r]);
  stretch.with = StretchPart(responses[r].with.values[c], places[r]);
  stretch.without = StretchPart(responses[r].without.values[c], places[r]);
  return stretch;
}

}  // namespace hydro::diagnose
