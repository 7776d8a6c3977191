#include "diagnose/report/report_json.h"

#include <nlohmann/json.hpp>

#include "diagnose/data/run_data.h"
#include "diagnose/report/closure_json.h"
#include "settings/command_line.h"

namespace hydro::diagnose {
namespace {

using Json = nlohmann::ordered_json;

Json Interval(const Estimated& estimated) { return Json::array({estimated.low, estimated.high}); }

Json PlacesAsJson(const Diagnosis& diagnosis) {
  Json places = Json::array();
  for (const Location& location : diagnosis.location) {
    Json windows = Json::array();
    for (const Window& window : location.windows) {
      windows.push_back({{"run", window.run}, {"from_s", window.from}, {"to_s", window.to}});
    }
    places.push_back({{"balance", location.balance},
                      {"share", location.share},
                      {"where", location.where},
                      {"windows", std::move(windows)}});
  }
  return places;
}

Json MissingTermsAsJson(const Diagnosis& diagnosis) {
  Json terms = Json::array();
  for (const MissingTerm& term : diagnosis.missing) {
    terms.push_back({{"balance", term.balance},
                     {"unit", term.unit},
                     {"against", term.against},
                     {"against_unit", term.against_unit},
                     {"at", term.at},
                     {"mean", term.mean},
                     {"standard_error", term.error}});
  }
  return terms;
}

Json Effects(const Diagnosis& diagnosis) {
  Json effects = Json::array();
  for (const FoundEffect& effect : diagnosis.effects) {
    Json parameters = Json::object();
    for (const Estimated& parameter : effect.parameters) {
      parameters[parameter.name] = {
          {"value", parameter.value}, {"ci95", Interval(parameter)}, {"unit", parameter.unit}};
    }
    effects.push_back({{"id", effect.id},
                       {"says", effect.summary},
                       {"equation", effect.equation},
                       {"parameters", std::move(parameters)},
                       {"share", effect.share},
                       {"weight", effect.weight},
                       {"names", effect.names},
                       {"tied_with", effect.tied_with}});
  }
  return effects;
}

Json Recording(const Diagnosis& diagnosis) {
  Json clocks = Json::array();
  for (const ClockDelay& clock : diagnosis.recording) {
    clocks.push_back({{"run", clock.run},
                      {"signals", clock.signals},
                      {"late_s", clock.delay},
                      {"ci95", {clock.delay - clock.error, clock.delay + clock.error}}});
  }
  return clocks;
}

Json ChangedParameters(const Diagnosis& diagnosis) {
  Json parameters = Json::array();
  for (const ChangedParameter& parameter : diagnosis.parameters) {
    parameters.push_back({{"name", parameter.fitted.name},
                          {"model", parameter.model},
                          {"fitted", parameter.fitted.value},
                          {"ci95", Interval(parameter.fitted)},
                          {"unit", parameter.fitted.unit},
                          {"implausible", parameter.implausible}});
    if (!parameter.why.empty()) parameters.back()["why"] = parameter.why;
  }
  return parameters;
}

Json Gap(const BeforeAfter& gap) {
  return {{"before", gap.before}, {"refit_only", gap.refit_only}, {"after", gap.after}};
}

Json SignalGaps(const std::vector<SignalGap>& gaps, const UnitSystem& units) {
  Json signals = Json::object();
  for (const SignalGap& signal : gaps) {
    signals[ChannelName(signal.channel)] = {{"unit", ChannelUnit(signal.channel, units)},
                                            {"noise", signal.noise},
                                            {"fit", Gap(signal.fit)},
                                            {"held_out", Gap(signal.held_out)}};
  }
  return signals;
}

Json PerRun(const Diagnosis& diagnosis) {
  Json all = Json::array();
  for (const ValueByRun& value : diagnosis.per_run) {
    Json values = Json::object(), intervals = Json::object();
    for (const Estimated& run : value.values) {
      values[run.name] = run.value;
      intervals[run.name] = {run.low, run.high};
    }
    all.push_back({{"name", value.name},
                   {"values", std::move(values)},
                   {"ci95", std::move(intervals)},
                   {"unit", value.unit},
                   {"spread", value.Spread()},
                   {"windows", {{"before", value.before}, {"after", value.after}}}});
  }
  return all;
}

Json Gaps(const Diagnosis& diagnosis) {
  Json horizons = Json::array();
  for (const HorizonGap& horizon : diagnosis.horizons) {
    horizons.push_back({{"seconds", horizon.seconds},
                        {"signals", SignalGaps(horizon.signals, diagnosis.model.units)},
                        {"fit", Gap(horizon.fit)},
                        {"held_out", Gap(horizon.held_out)},
                        {"typical", Gap(horizon.typical)}});
  }
  return {{"signals", SignalGaps(diagnosis.signals, diagnosis.model.units)},
          {"fit", Gap(diagnosis.fit)},
          {"held_out", Gap(diagnosis.held_out)},
          {"horizons", std::move(horizons)}};
}

Json NextExperimentOf(const Diagnosis& diagnosis, const std::string& next_config) {
  const NextExperiment& next = diagnosis.next;
  if (next.why.empty() && next_config.empty()) return nullptr;
  return {{"why", next.why},
          {"config", next_config.empty() ? Json(nullptr) : Json(next_config)},
          {"expected_separation", next.expected_separation}};
}

Json ChosenWithout(const Diagnosis& diagnosis) {
  Json choices = Json::array();
  for (const ChoiceWithout& choice : diagnosis.choices)
    choices.push_back({{"run", choice.run}, {"chosen", choice.chosen}, {"same", choice.same}});
  return choices;
}

Json Explanations(const Diagnosis& diagnosis) {
  Json explanations = Json::array();
  for (const WeightedSet& one : diagnosis.explanations)
    explanations.push_back({{"changes", one.changes}, {"weight", one.weight}});
  return explanations;
}

Json Candidates(const Diagnosis& diagnosis) {
  Json candidates = Json::array();
  for (const Candidate& candidate : diagnosis.candidates) {
    candidates.push_back({{"id", candidate.id},
                          {"score", candidate.score},
                          {"held_out", candidate.held_out},
                          {"p_value", candidate.p_value},
                          {"weight", candidate.weight},
                          {"rejected_because", candidate.rejected_because}});
  }
  return candidates;
}

}  // namespace

const std::string& VerdictName(Verdict verdict) {
  static const std::string names[] = {"named",      "tied",        "partly",
                                      "parameters", "unexplained", "nothing_missing"};
  return names[static_cast<size_t>(verdict)];
}

std::string ReportJson(const Diagnosis& diagnosis, const std::string& next_config, double elapsed_s) {
  const Json report = {{"verdict", VerdictName(diagnosis.verdict)},
                       {"sentence", diagnosis.sentence},
                       {"recording", Recording(diagnosis)},
                       {"location", PlacesAsJson(diagnosis)},
                       {"missing_terms", MissingTermsAsJson(diagnosis)},
                       {"effects", Effects(diagnosis)},
                       {"closure", ClosureJson(diagnosis)},
                       {"parameters", ChangedParameters(diagnosis)},
                       {"per_run", PerRun(diagnosis)},
                       {"gap", Gaps(diagnosis)},
                       {"next_experiment", NextExperimentOf(diagnosis, next_config)},
                       {"candidates", Candidates(diagnosis)},
                       {"explanations", Explanations(diagnosis)},
                       {"set_90", diagnosis.set_90},
                       {"remarks", diagnosis.remarks},
                       {"runs", diagnosis.runs},
                       {"held_out_runs", diagnosis.held_out_runs},
                       {"chosen_without", ChosenWithout(diagnosis)},
                       {"samples", diagnosis.samples},
                       {"version", settings::ProgramVersion()},
                       {"elapsed_s", elapsed_s}};
  // Names come from files: bytes that are not UTF-8 are replaced, not refused.
  return report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace hydro::diagnose
