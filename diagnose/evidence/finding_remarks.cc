#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/word_list.h"
#include "diagnose/evidence/recording_check.h"
#include "diagnose/recording/sidecar_lines.h"

namespace hydro::diagnose {
namespace {

using Run = runs::MeasuredRun;
using Mistakes = std::vector<RecordingMistake>;

std::string WhatIsWrong(const Mistakes& mistakes) {
  std::vector<std::string> parts;
  for (const RecordingMistake& mistake : mistakes) parts.push_back(mistake.what);
  return Enumerated(parts);
}

// One remark that applies to several runs.
struct Remark {
  const RecordingFinding* finding;
  std::string lines;
  std::vector<Mistakes> tied;  // those that other sidecar lines correct
  std::vector<std::string> tied_lines;
  std::vector<std::string> names, sidecars;

  bool Takes(const Remark& other) const {
    return finding->mistakes == other.finding->mistakes && tied == other.tied && lines == other.lines &&
           tied_lines == other.tied_lines;
  }
};

// "in run1.toml and run2.toml, under [columns],"
std::string Where(const std::vector<std::string>& sidecars, const Mistakes& mistakes) {
  const bool columns = std::ranges::any_of(
      mistakes, [](const RecordingMistake& mistake) { return !mistake.shaft.has_value(); });
  return "in " + (sidecars.empty() ? "the sidecar" : Enumerated(sidecars)) +
         (columns ? ", under [columns]," : "");
}

// Units and a value of the model look alike where the same terms of a balance are too large.
bool HasAFactor(const Mistakes& mistakes) {
  return std::ranges::any_of(mistakes, [](const RecordingMistake& mistake) {
    return !mistake.IsSign() && !mistake.factors.empty();
  });
}

std::string Text(const Remark& remark) {
  const Mistakes& mistakes = remark.finding->mistakes;
  const std::string where = Where(remark.sidecars, mistakes);
  std::string text = WhatIsWrong(mistakes);
  bool even = false;
  for (const Mistakes& other : remark.tied) even = even || other.size() <= mistakes.size();
  if (even) text = "either " + text;
  for (const Mistakes& other : remark.tied) {
    if (other.size() <= mistakes.size()) text += ", or " + WhatIsWrong(other);
  }
  if (even) text += " (the runs cannot tell which)";
  if (remark.lines.empty()) return text;
  text += ": this " + where + " mends it: " + remark.lines;
  for (size_t t = 0; t < remark.tied.size(); ++t) {
    const Mistakes& other = remark.tied[t];
    if (other.size() > mistakes.size()) {
      text += ". It might also be that " + WhatIsWrong(other) + ", which would explain the runs as well";
    }
    text += (other.size() > mistakes.size() ? ": " : "; or this: ") + remark.tied_lines[t];
  }
  if (HasAFactor(mistakes)) text += ". Where the unit is right, a value of the model is off by as much";
  return text;
}

void AddOnce(const std::string& text, std::vector<std::string>* list) {
  if (!text.empty() && std::ranges::find(*list, text) == list->end()) list->push_back(text);
}

}  // namespace

std::vector<std::string> FindingRemarks(const std::vector<RecordingFinding>& findings,
                                        const std::vector<Run>& runs) {
  std::vector<Remark> remarks;  // in the order of the first run
  for (const RecordingFinding& finding : findings) {
    const Run& run = runs[finding.run];
    Remark next{&finding, SidecarLines(finding.mistakes, run), {}, {}, {run.name}, {}};
    for (const Mistakes& other : finding.tied) {
      std::string lines = SidecarLines(other, run);
      const bool same =
          !lines.empty() && lines == next.lines;  // signs of two sensors, separately or together
      if (same || std::ranges::find(next.tied_lines, lines) != next.tied_lines.end()) continue;
      next.tied.push_back(other);
      next.tied_lines.push_back(std::move(lines));
    }
    const std::string sidecar = std::filesystem::path(run.sidecar).filename().string();
    const auto same = std::ranges::find_if(remarks, [&](const Remark& remark) { return remark.Takes(next); });
    Remark& remark = same == remarks.end() ? remarks.emplace_back(std::move(next)) : *same;
    if (same != remarks.end() && remark.names.back() != run.name) remark.names.push_back(run.name);
    AddOnce(sidecar, &remark.sidecars);
  }
  // The remark that says most comes first.
  std::ranges::stable_sort(remarks, [](const Remark& a, const Remark& b) {
    return a.finding->mistakes.size() > b.finding->mistakes.size();
  });
  std::vector<std::string> lines;
  lines.reserve(remarks.size());
  for (const Remark& remark : remarks) {
    lines.push_back(RunsNamed(remark.names, runs.size()) + ": " + Text(remark));
  }
  return lines;
}

}  // namespace hydro::diagnose
