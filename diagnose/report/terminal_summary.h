// A diagnosis as plain text: about ten lines for a terminal, and model.toml with what was found beside its values.
#pragma once

#include <string>

#include "diagnose/data/diagnosis.h"

namespace hydro::diagnose {

// `folder`: where the report is. With `si`, figures are in SI.
std::string TerminalSummary(const Diagnosis& diagnosis, const std::string& folder, bool si);

// "b 0.0203 [0.0199, 0.0207] in-lbf-s"
std::string WithInterval(const Estimated& estimated);

// What an explanation changes, in words: "pump.stribeck + another value of b", "nothing is missing".
std::string InWords(const WeightedSet& explanation);

// "Cannot be judged from these runs: valve.relief and line.wave, because p1 and p2 were not recorded"
std::string UnjudgedText(const Unjudged& unjudged);

// The text of model.toml: what settings::FormatModel writes, with a comment at each value that is not as in `given`: its 95 %
// interval, where it comes from and what it was. Reads back as the same description.
std::string CommentedModel(const Diagnosis& diagnosis, const model::ModelDescription& given);

}  // namespace hydro::diagnose
