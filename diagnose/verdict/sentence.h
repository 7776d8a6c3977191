// The verdict in one sentence.
#pragma once

#include <string>
#include <vector>

#include "diagnose/data/diagnosis.h"

namespace hydro::diagnose {

// `doubts`: why what closes the gap cannot be called the cause.
std::string Sentence(const Diagnosis& diagnosis, const std::vector<std::string>& doubts);

// What an experiment would tell apart; "" where nothing is tied.
std::string WhyNext(const std::vector<FoundEffect>& effects);

}  // namespace hydro::diagnose
