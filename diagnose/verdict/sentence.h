// The verdict in one sentence.
#pragma once

#include <string>
#include <vector>

#include "diagnose/data/diagnosis.h"

namespace hydro::diagnose {

// The gap that a sentence states.
struct ComparedGap {
  BeforeAfter gap;
  double seconds = 0;  // that the predictions reach; 0: whole runs
};

// `doubts`: why what closes the gap cannot be called the cause.
std::string Sentence(const Diagnosis& diagnosis, const std::vector<std::string>& doubts,
                     const ComparedGap& compared);

// What `tied_with` has, in words: "amp.delay", "other values of J and b", "other values of the model's parameters".
std::vector<std::string> InWords(const std::vector<std::string>& rivals);

// What an experiment would tell apart; "" where nothing is tied.
std::string WhyNext(const std::vector<FoundEffect>& effects);

}  // namespace hydro::diagnose
