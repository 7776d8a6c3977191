#include "diagnose/verdict/run_curves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace hydro::diagnose {

namespace {

constexpr size_t kMostPoints = 1200;

struct CurveSums {
  std::array<double, model::kChannels> square{};
  std::array<double, model::kChannels> count{};
  void Add(const RunData& run, const model::ModelDescription& model, const model::StartState& start) {
    model::Response response;
    try {
      response = model::Respond(model, run.stimulus, start, {}, {});
    } catch (const model::ModelError&) {
      return;
    }
    for (const SignalData& signal : run.signals) {
      const auto c = static_cast<size_t>(signal.channel);
      for (size_t i = 0; i < signal.values.size(); ++i) {
        if (std::isnan(signal.values[i])) continue;
        square[c] += std::pow(response.values[c][i] - signal.values[i], 2);
        count[c] += 1;
      }
    }
  }
  double Rms(size_t c) const {
    return count[c] > 0 ? std::sqrt(square[c] / count[c]) : std::numeric_limits<double>::quiet_NaN();
  }
};

CurveSums OfFit(const SearchContext& context, const Explanation& one) {
  CurveSums sums;
  for (size_t r = 0; r < context.runs.size(); ++r) {
    sums.Add(*context.runs[r], one.fitted.hypothesis.model, one.fitted.runs[r].start);
  }
  return sums;
}

CurveSums OfHeldOut(const SearchContext& context, const Explanation& one) {
  CurveSums sums;
  for (size_t r = 0; r < context.predicted().size(); ++r) {
    sums.Add(*context.predicted()[r], one.held_out.models[r], one.held_out.starts[r]);
  }
  return sums;
}

RunCurves Curves(const RunData& run, bool held_out, const model::ModelDescription& model_before,
                 const model::StartState& start_before, const model::ModelDescription& model_after,
                 const model::StartState& start_after) {
  RunCurves curves;
  curves.run = run.name;
  curves.held_out = held_out;
  const size_t stride = std::max<size_t>(1, run.samples() / kMostPoints);
  const auto respond = [&](const model::ModelDescription& model, const model::StartState& start) {
    try {
      return model::Respond(model, run.stimulus, start, {}, {});
    } catch (const model::ModelError&) {
      return model::Response{};
    }
  };
  const model::Response before = respond(model_before, start_before);
  const model::Response after = respond(model_after, start_after);
  const auto thin = [&](const std::vector<double>& values) {
    std::vector<double> thinned;
    for (size_t i = 0; i < values.size(); i += stride) thinned.push_back(values[i]);
    return thinned;
  };
  curves.time = thin(run.stimulus.time);
  curves.voltage = thin(run.stimulus.voltage);
  for (const SignalData& signal : run.signals) {
    const auto c = static_cast<size_t>(signal.channel);
    curves.curves.push_back(
        {signal.channel, thin(signal.values), thin(before.values[c]), thin(after.values[c])});
  }
  return curves;
}

}  // namespace

std::vector<SignalGap> SignalGaps(const SearchContext& context, const Explanation& given,
                                  const Explanation& refit, const Explanation& best) {
  const Explanation* const all[] = {&given, &refit, &best};
  CurveSums fit[3], held_out[3];
  for (size_t i = 0; i < 3; ++i) {
    fit[i] = OfFit(context, *all[i]);
    held_out[i] = OfHeldOut(context, *all[i]);
  }
  std::vector<SignalGap> gaps;
  for (size_t c = 0; c < model::kChannels; ++c) {
    if (fit[0].count[c] == 0 && held_out[0].count[c] == 0) continue;
    SignalGap gap;
    gap.channel = static_cast<model::Channel>(c);
    double square = 0;
    double runs = 0;
    for (const auto* list : {&context.runs, &context.held_out}) {
      for (const RunData* run : *list) {
        const SignalData* signal = run->Find(gap.channel);
        if (signal == nullptr) continue;
        square += signal->noise * signal->noise;
        runs += 1;
      }
    }
    gap.noise = runs > 0 ? std::sqrt(square / runs) : 0;
    gap.fit = {fit[0].Rms(c), fit[1].Rms(c), fit[2].Rms(c)};
    gap.held_out = {held_out[0].Rms(c), held_out[1].Rms(c), held_out[2].Rms(c)};
    gaps.push_back(gap);
  }
  return gaps;
}

std::vector<RunCurves> CurvesOf(const SearchContext& context, const Explanation& given,
                                const Explanation& best) {
  std::vector<RunCurves> curves;
  const bool in_turn = context.held_out.empty();
  for (size_t r = 0; r < context.runs.size(); ++r) {
    curves.push_back(Curves(*context.runs[r], in_turn, given.fitted.hypothesis.model,
                            given.fitted.runs[r].start,
                            in_turn ? best.held_out.models[r] : best.fitted.hypothesis.model,
                            in_turn ? best.held_out.starts[r] : best.fitted.runs[r].start));
  }
  for (size_t r = 0; r < context.held_out.size(); ++r) {
    curves.push_back(Curves(*context.held_out[r], true, given.held_out.models[r], given.held_out.starts[r],
                            best.held_out.models[r], best.held_out.starts[r]));
  }
  return curves;
}

}  // namespace hydro::diagnose
