#include "diagnose/report/terminal_summary.h"

#include <cmath>

#include "base/number_text.h"
#include "base/word_list.h"
#include "diagnose/data/run_data.h"
#include "diagnose/report/diagnosis_in_si.h"
#include "diagnose/report/report_json.h"

namespace hydro::diagnose {
namespace {

std::string GapLine(const std::string& what, const BeforeAfter& gap) {
  return what + ShortNumber(gap.before) + " before, " + ShortNumber(gap.refit_only) + " refitted only, " +
         ShortNumber(gap.after) + " after, in noise units (1 is the noise floor)\n";
}

std::string Percent(double part) { return ShortNumber(std::round(100 * part)) + " %"; }

std::string HorizonLine(const Diagnosis& diagnosis) {
  std::vector<std::string> parts;
  for (const HorizonGap& horizon : diagnosis.horizons) {
    parts.push_back(ShortNumber(horizon.held_out.before, 3) + " -> " +
                    ShortNumber(horizon.held_out.after, 3) + " over " + ShortNumber(horizon.seconds, 2) +
                    " s");
  }
  return parts.empty() ? "" : "horizons:   held out, " + Joined(parts, "; ") + "\n";
}

std::string EffectText(const FoundEffect& effect) {
  std::vector<std::string> parts;
  for (const Estimated& parameter : effect.parameters) parts.push_back(WithInterval(parameter));
  parts.insert(parts.end(), effect.names.begin(), effect.names.end());
  std::string text = effect.id + " (" + effect.summary + ")";
  if (!parts.empty()) text += ": " + Joined(parts);
  if (effect.weight > 0) text += "; likely to " + Percent(effect.weight) + " among what was tried (weight)";
  if (std::isfinite(effect.share)) text += ", without it " + Percent(effect.share) + " of the gap comes back";
  if (!effect.tied_with.empty()) text += "; tied with " + Joined(effect.tied_with);
  return text;
}

std::string SignalsLine(const Diagnosis& diagnosis, bool si) {
  std::vector<std::string> parts;
  for (const SignalGap& signal : diagnosis.signals) {
    const ShownUnit unit = UnitOf(signal.channel, diagnosis.model.units, si);
    parts.push_back(ChannelName(signal.channel) + " " + ShortNumber(signal.held_out.before * unit.factor) +
                    " -> " + ShortNumber(signal.held_out.after * unit.factor) + " " + unit.unit + " (noise " +
                    ShortNumber(signal.noise * unit.factor) + ")");
  }
  return parts.empty() ? "" : "signals:    " + Joined(parts, "; ") + "\n";
}

}  // namespace

std::string WithInterval(const Estimated& estimated) {
  std::string text = estimated.name + " " + ShortNumber(estimated.value);
  if (std::isfinite(estimated.low) || std::isfinite(estimated.high)) {
    text += " [" + ShortNumber(estimated.low) + ", " + ShortNumber(estimated.high) + "]";
  }
  return estimated.unit == "1" || estimated.unit.empty() ? text : text + " " + estimated.unit;
}

std::string TerminalSummary(const Diagnosis& given, const std::string& folder, bool si) {
  const Diagnosis diagnosis = si ? InSi(given) : given;
  std::string out = VerdictName(diagnosis.verdict) + ": " + diagnosis.sentence + "\n";
  std::vector<std::string> effects;
  for (const FoundEffect& effect : diagnosis.effects) effects.push_back(EffectText(effect));
  if (!effects.empty()) out += "effects:    " + Joined(effects, "; ") + "\n";
  std::vector<std::string> parameters;
  for (const ChangedParameter& parameter : diagnosis.parameters) {
    parameters.push_back(WithInterval(parameter.fitted) + ", was " + ShortNumber(parameter.model) +
                         (parameter.implausible ? " (implausible)" : ""));
  }
  if (!parameters.empty()) out += "parameters: " + Joined(parameters, "; ") + "\n";
  out += GapLine("held out:   ", diagnosis.held_out);
  out += GapLine("fitted:     ", diagnosis.fit);
  out += HorizonLine(diagnosis);
  out += SignalsLine(diagnosis, si);
  if (!diagnosis.location.empty()) {
    const Location& first = diagnosis.location.front();
    out += "where:      " + first.balance + ", " + Percent(first.share) + " of the disagreement" +
           (first.where.empty() ? "" : ": " + first.where) + "\n";
  }
  if (!diagnosis.next.why.empty()) out += "next:       " + diagnosis.next.why + "\n";
  if (!diagnosis.remarks.empty()) {
    out += "remarks:    " + diagnosis.remarks.front();
    const size_t more = diagnosis.remarks.size() - 1;
    if (more > 0) out += " (and " + std::to_string(more) + " more in the report)";
    out += "\n";
  }
  return out + "written:    " + folder + "/report.html, report.json, model.toml" +
         (diagnosis.next.config.empty() ? "" : ", next.toml") + "\n";
}

}  // namespace hydro::diagnose
