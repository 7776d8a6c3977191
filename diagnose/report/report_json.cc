// report.json.
#include <nlohmann/json.hpp>

#include "base/json_text.h"
#include "diagnose/recording/run_data.h"
#include "diagnose/report/report.h"
#include "settings/command_line.h"

namespace hydro::diagnose {
namespace {

using Json = nlohmann::ordered_json;

template <class Item, class Of>
Json List(const std::vector<Item>& items, const Of& of) {
  Json list = Json::array();
  for (const Item& item : items) list.push_back(of(item));
  return list;
}

Json IntervalJson(const Estimated& estimated) { return Json::array({estimated.low, estimated.high}); }

Json PlaceJson(const Location& location) {
  const Json windows = List(location.windows, [](const Window& window) {
    return Json{{"run", window.run}, {"from_s", window.from}, {"to_s", window.to}};
  });
  return {{"balance", location.balance},
          {"share", location.share},
          {"where", location.where},
          {"windows", windows}};
}

Json TermJson(const MeasuredCurve& term) {
  return {{"balance", term.balance},           {"unit", term.unit}, {"against", term.against},
          {"against_unit", term.against_unit}, {"at", term.at},     {"mean", term.measured},
          {"standard_error", term.error}};
}

Json EffectJson(const FoundEffect& effect) {
  Json parameters = Json::object();
  for (const Estimated& parameter : effect.parameters) {
    parameters[parameter.name] = {
        {"value", parameter.value}, {"ci95", IntervalJson(parameter)}, {"unit", parameter.unit}};
    if (!parameter.shown) parameters[parameter.name]["shown"] = false;
  }
  return {{"id", effect.id},
          {"says", effect.summary},
          {"equation", effect.equation},
          {"parameters", std::move(parameters)},
          {"share", effect.share},
          {"weight", effect.weight},
          {"names", effect.names},
          {"tied_with", effect.tied_with}};
}

// A list by a closure's knots; for a surface, by rows.
Json ByKnots(const Closure& closure, const Json& list) {
  if (closure.knots.size() == 1) return list;
  Json rows = Json::array();
  for (size_t i = 0; i < list.size(); ++i) {
    if (i % closure.knots[1].size() == 0) rows.push_back(Json::array());
    rows.back().push_back(list[i]);
  }
  return rows;
}

Json ClosureJson(const Closure& closure) {
  Json band = Json::array();
  for (size_t i = 0; i < closure.value.size(); ++i) band.push_back({closure.low[i], closure.high[i]});
  return {{"id", closure.id},
          {"against", closure.against},
          {"against_units", closure.against_units},
          {"unit", closure.unit},
          {"at", closure.knots.size() == 1 ? Json(closure.knots[0]) : Json(closure.knots)},
          {"value", ByKnots(closure, closure.value)},
          {"ci95", ByKnots(closure, band)},
          {"held_out", {{"before", closure.before}, {"after", closure.after}}},
          {"seconds", closure.seconds},
          {"resembles", closure.resembles}};
}

// The largest closure, with the closures of other balances that belong to it under "also"; null without any.
Json Closures(const Diagnosis& diagnosis) {
  Json all = List(diagnosis.closures, ClosureJson);
  if (all.empty()) return nullptr;
  Json first = all[0];
  for (size_t i = 1; i < all.size(); ++i) first["also"].push_back(all[i]);
  return first;
}

Json ClockJson(const ClockDelay& clock) {
  return {{"run", clock.run},
          {"signals", clock.signals},
          {"late_s", clock.delay},
          {"ci95", {clock.delay - clock.error, clock.delay + clock.error}}};
}

Json ParameterJson(const ChangedParameter& parameter) {
  Json json = {{"name", parameter.fitted.name},    {"model", parameter.model},
               {"fitted", parameter.fitted.value}, {"ci95", IntervalJson(parameter.fitted)},
               {"unit", parameter.fitted.unit},    {"implausible", parameter.implausible}};
  if (!parameter.fitted.shown) json["shown"] = false;
  if (!parameter.why.empty()) json["why"] = parameter.why;
  return json;
}

Json GapJson(const BeforeAfter& gap) {
  return {{"before", gap.before}, {"refit_only", gap.refit_only}, {"after", gap.after}};
}

Json SignalGaps(const std::vector<SignalGap>& gaps, const UnitSystem& units) {
  Json signals = Json::object();
  for (const SignalGap& signal : gaps) {
    signals[ChannelName(signal.channel)] = {{"unit", ChannelUnit(signal.channel, units)},
                                            {"noise", signal.noise},
                                            {"fit", GapJson(signal.fit)},
                                            {"held_out", GapJson(signal.held_out)}};
  }
  return signals;
}

Json PerRunJson(const ValueByRun& value) {
  Json values = Json::object(), intervals = Json::object();
  for (const Estimated& run : value.values) {
    values[run.name] = run.value;
    intervals[run.name] = IntervalJson(run);
  }
  return {{"name", value.name},           {"values", std::move(values)},
          {"ci95", std::move(intervals)}, {"unit", value.unit},
          {"spread", value.Spread()},     {"windows", {{"before", value.before}, {"after", value.after}}}};
}

Json Gaps(const Diagnosis& diagnosis) {
  const UnitSystem& units = diagnosis.model.units;
  const Json horizons = List(diagnosis.horizons, [&](const HorizonGap& horizon) {
    return Json{{"seconds", horizon.seconds},
                {"signals", SignalGaps(horizon.signals, units)},
                {"fit", GapJson(horizon.fit)},
                {"held_out", GapJson(horizon.held_out)},
                {"typical", GapJson(horizon.typical)}};
  });
  return {{"signals", SignalGaps(diagnosis.signals, units)},
          {"fit", GapJson(diagnosis.fit)},
          {"held_out", GapJson(diagnosis.held_out)},
          {"horizons", horizons}};
}

Json NextExperimentOf(const NextExperiment& next, const std::string& next_config) {
  if (next.why.empty() && next_config.empty()) return nullptr;
  return {{"why", next.why},
          {"config", next_config.empty() ? Json(nullptr) : Json(next_config)},
          {"expected_separation", next.expected_separation}};
}

Json ChoiceJson(const ChoiceWithout& choice) {
  return {{"run", choice.run}, {"chosen", choice.chosen}, {"same", choice.same}};
}

Json ExplanationJson(const WeightedSet& one) { return {{"changes", one.changes}, {"weight", one.weight}}; }

Json CandidateJson(const Candidate& candidate) {
  return {{"id", candidate.id},
          {"score", candidate.score},
          {"held_out", candidate.held_out},
          {"p_value", candidate.p_value},
          {"weight", candidate.weight},
          {"rejected_because", candidate.rejected_because}};
}

Json UnjudgedJson(const Unjudged& one) { return {{"effects", one.effects}, {"because", one.because}}; }

}  // namespace

const std::string& VerdictName(Verdict verdict) {
  static const std::string names[] = {"named",      "tied",        "partly",
                                      "parameters", "unexplained", "nothing_missing"};
  return names[static_cast<size_t>(verdict)];
}

std::string ReportJson(const Diagnosis& diagnosis, const std::string& next_config, double elapsed_s) {
  const Json report = {{"verdict", VerdictName(diagnosis.verdict)},
                       {"sentence", diagnosis.sentence},
                       {"recording", List(diagnosis.recording, ClockJson)},
                       {"location", List(diagnosis.location, PlaceJson)},
                       {"missing_terms", List(diagnosis.missing, TermJson)},
                       {"effects", List(diagnosis.effects, EffectJson)},
                       {"closure", Closures(diagnosis)},
                       {"parameters", List(diagnosis.parameters, ParameterJson)},
                       {"per_run", List(diagnosis.per_run, PerRunJson)},
                       {"gap", Gaps(diagnosis)},
                       {"next_experiment", NextExperimentOf(diagnosis.next, next_config)},
                       {"candidates", List(diagnosis.candidates, CandidateJson)},
                       {"explanations", List(diagnosis.explanations, ExplanationJson)},
                       {"set_90", diagnosis.set_90},
                       {"cannot_judge", List(diagnosis.unjudged, UnjudgedJson)},
                       {"remarks", diagnosis.remarks},
                       {"runs", diagnosis.runs},
                       {"held_out_runs", diagnosis.held_out_runs},
                       {"chosen_without", List(diagnosis.choices, ChoiceJson)},
                       {"samples", diagnosis.samples},
                       {"version", settings::ProgramVersion()},
                       {"elapsed_s", elapsed_s}};
  return JsonText(report, 2) + "\n";
}

}  // namespace hydro::diagnose
