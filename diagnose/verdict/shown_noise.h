// The gap by the noise that the recordings themselves show, where the noise that they state is much smaller.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnose/data/diagnosis.h"
#include "diagnose/fit/held_out.h"

namespace hydro::diagnose {

// The root-mean-square residual of the predicted runs in units of the noise that the samples show, of the signals
// that are noisier than stated; of the others as ever. None where no signal is, or a run cannot be simulated.
std::optional<double> GapInShownNoise(const std::vector<const RunData*>& runs, const HeldOut& predicted);

// The sentence that says so beside a verdict that leaves a gap: the stated noise counts, but a reader should know
// that it may be all that is wrong. Empty for other verdicts, and where there is no such gap.
std::string ShownNoiseSentence(Verdict verdict, std::optional<double> gap);

}  // namespace hydro::diagnose
