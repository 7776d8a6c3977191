// A diagnosis as plain text: for a terminal, and in model.toml.
#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "base/number_text.h"
#include "base/text_file.h"
#include "base/word_list.h"
#include "diagnose/recording/run_data.h"
#include "diagnose/report/diagnosis_in_si.h"
#include "diagnose/report/report.h"
#include "diagnose/say/sentence.h"
#include "model/terms/parameter_info.h"
#include "settings/command_line.h"
#include "settings/model_file.h"

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
  return parts.empty() ? "" : "horizons:   held out, root mean squares: " + Joined(parts, "; ") + "\n";
}

std::string EffectText(const FoundEffect& effect) {
  std::vector<std::string> parts;
  for (const Estimated& parameter : effect.parameters) parts.push_back(WithInterval(parameter));
  parts.insert(parts.end(), effect.names.begin(), effect.names.end());
  std::string text = effect.id + " (" + effect.summary + ")";
  if (!parts.empty()) text += ": " + Joined(parts);
  if (effect.weight > 0) text += "; weight " + Percent(effect.weight);
  if (std::isfinite(effect.share)) text += ", without it " + Percent(effect.share) + " of the gap comes back";
  if (!effect.tied_with.empty()) text += "; tied with " + Joined(InWords(effect.tied_with));
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

// The likeliest explanations that together hold the truth nine times in ten, as many as fit on a line.
std::string LikelyLine(const Diagnosis& diagnosis) {
  constexpr size_t kMost = 4;
  const size_t shown =
      std::min({std::max<size_t>(diagnosis.set_90, 2), kMost, diagnosis.explanations.size()});
  std::vector<std::string> parts;
  for (size_t i = 0; i < shown; ++i) {
    const WeightedSet& one = diagnosis.explanations[i];
    if (i < diagnosis.set_90 || std::round(100 * one.weight) > 0)
      parts.push_back(InWords(one) + " " + Percent(one.weight));
  }
  const size_t more = diagnosis.set_90 - std::min(diagnosis.set_90, shown);
  return parts.empty() ? ""
                       : "likely:     " + Joined(parts) +
                             (more > 0 ? ", and " + std::to_string(more) + " more in the report" : "") + "\n";
}

std::string IntervalText(const Estimated& estimated) {
  if (!std::isfinite(estimated.low) && !std::isfinite(estimated.high)) return "no interval";
  const bool plain = estimated.unit.empty() || estimated.unit == "1";
  return "95 %: " + ShortNumber(estimated.low) + " to " + ShortNumber(estimated.high) +
         (plain ? "" : " " + estimated.unit) + (estimated.shown ? "" : ", so not shown by these runs");
}

// Comments by the key of their line: "parameters.b", "effects.pump.stribeck.speed"; for the effect itself, by
// that of its heading: "effects.pump.stribeck".
using Comments = std::map<std::string, std::string>;

void CommentOnValues(const Diagnosis& diagnosis, const model::ModelDescription& given, Comments* comments) {
  for (const model::BaseParameter& base : model::BaseParameters()) {
    const double now = diagnosis.model.parameters.*base.member, was = given.parameters.*base.member;
    if (now == was) continue;
    (*comments)["parameters." + base.info.name] =
        "refitted with the others; was " + ShortNumber(was) + ", which these runs do not exclude";
  }
  for (const ChangedParameter& changed : diagnosis.parameters) {
    const std::string& name = changed.fitted.name;
    const bool of_an_effect = name.find('.') != std::string::npos;
    std::string& comment = (*comments)[(of_an_effect ? "effects." : "parameters.") + name];
    comment = IntervalText(changed.fitted) + ", fitted to the runs; was " + ShortNumber(changed.model);
    if (changed.resting) comment += "; it rests on how well the model's values are known";
    if (changed.implausible) comment += "; implausible";
  }
  for (const std::string& name : diagnosis.by_run) {
    (*comments)["parameters." + name] =
        "between the runs' own values, which the report lists; was " +
        ShortNumber(given.parameters.*model::BaseParameters()[model::BasePlace(name)].member);
  }
  for (const ValueByRun& value : diagnosis.per_run) {
    std::string& comment = (*comments)["parameters." + value.name];
    comment += (comment.empty() ? "" : "; ") +
               ("differs from run to run by " + ShortNumber(100 * value.Spread(), 2) + " %");
  }
}

void CommentOnEffects(const Diagnosis& diagnosis, Comments* comments) {
  for (const FoundEffect& effect : diagnosis.effects) {
    std::string& comment = (*comments)["effects." + effect.id];
    comment = "found in the runs: " + effect.summary;
    if (!effect.tied_with.empty())
      comment += "; these runs cannot tell it from " + Joined(InWords(effect.tied_with));
    for (const Estimated& parameter : effect.parameters) {
      (*comments)["effects." + effect.id + "." + parameter.name] =
          IntervalText(parameter) + ", found in the runs";
    }
  }
  for (const Closure& closure : diagnosis.closures) {
    (*comments)["effects." + closure.id] = "a curve through what no known effect explains; it names no cause";
  }
}

// Turns [effects."pump.stribeck"] into effects.pump.stribeck.
std::string SectionOf(std::string heading) {
  std::erase_if(heading, [](char c) { return c == '[' || c == ']' || c == '"'; });
  return heading;
}

}  // namespace

std::string InWords(const WeightedSet& explanation) {
  if (explanation.changes.empty()) return "no effect (other values at most)";
  std::vector<std::string> parts;
  for (const std::string& change : explanation.changes) parts.push_back(ChangeInWords(change));
  return Joined(parts, " + ");
}

std::string UnjudgedText(const Unjudged& unjudged) {
  return "Cannot be judged from these runs: " + Enumerated(unjudged.effects) + ", because " +
         unjudged.because;
}

std::string CommentedModel(const Diagnosis& diagnosis, const model::ModelDescription& given) {
  Comments comments;
  CommentOnValues(diagnosis, given, &comments);
  CommentOnEffects(diagnosis, &comments);
  const std::string text = settings::FormatModel(diagnosis.model);
  std::string out = "# Written by hydro-diagnose " + settings::ProgramVersion() +
                    ". What it changed has a comment; report.html has the reasons.\n";
  std::string section;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    const std::string line = text.substr(begin, end - begin);
    begin = end + 1;
    std::string key = section + "." + line.substr(0, line.find(" = "));
    if (line.starts_with('[')) key = section = SectionOf(line);
    const auto comment = comments.find(key);
    out += line + (comment == comments.end() ? "" : "  # " + Printable(comment->second)) + "\n";
  }
  return out;
}

std::string WithInterval(const Estimated& estimated) {
  std::string text = estimated.name + " " + ShortNumber(estimated.value);
  if (std::isfinite(estimated.low) || std::isfinite(estimated.high)) {
    text += " [" + ShortNumber(estimated.low) + ", " + ShortNumber(estimated.high) + "]";
  }
  if (estimated.unit != "1" && !estimated.unit.empty()) text += " " + estimated.unit;
  return estimated.shown ? text : text + " (not shown by these runs)";
}

std::string TerminalSummary(const Diagnosis& given, const std::string& folder, bool si) {
  const Diagnosis diagnosis = si ? InSi(given) : given;
  std::string out = VerdictName(diagnosis.verdict) + ": " + diagnosis.sentence + "\n";
  out += LikelyLine(diagnosis);
  std::vector<std::string> effects;
  for (const FoundEffect& effect : diagnosis.effects) effects.push_back(EffectText(effect));
  if (!effects.empty()) out += "effects:    " + Joined(effects, "; ") + "\n";
  std::vector<std::string> parameters;
  for (const ChangedParameter& parameter : diagnosis.parameters) {
    parameters.push_back(WithInterval(parameter.fitted) + ", was " + ShortNumber(parameter.model) +
                         (parameter.implausible ? " (implausible)" : ""));
  }
  if (!parameters.empty()) out += "parameters: " + Joined(parameters, "; ") + "\n";
  out +=
      GapLine(diagnosis.half_fitted ? "held out:   half of each run: " : "held out:   ", diagnosis.held_out);
  out += GapLine("fitted:     ", diagnosis.fit);
  out += HorizonLine(diagnosis);
  out += SignalsLine(diagnosis, si);
  if (!diagnosis.location.empty()) {
    const Location& first = diagnosis.location.front();
    out += "where:      " + first.balance + ", " + Percent(first.share) + " of the disagreement" +
           (first.where.empty() ? "" : ": " + first.where) + "\n";
  }
  for (const Unjudged& one : diagnosis.unjudged) out += UnjudgedText(one) + "\n";
  if (!diagnosis.next.why.empty()) out += "next:       " + diagnosis.next.why + "\n";
  if (!diagnosis.remarks.empty()) {
    out += "remarks:    " + diagnosis.remarks.front();
    const size_t more = diagnosis.remarks.size() - 1;
    if (more > 0) out += " (and " + std::to_string(more) + " more in the report)";
    out += "\n";
  }
  out += "written:    " + folder + "/report.html, report.json, model.toml" +
         (diagnosis.next.config.empty() ? "" : ", next.toml") + "\n";
  return PrintableLines(out);
}

}  // namespace hydro::diagnose
