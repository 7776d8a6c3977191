// The verdict in one sentence, and other things that a diagnosis says in words.
#pragma once

#include <string>
#include <vector>

#include "diagnose/recording/diagnosis.h"

namespace hydro::diagnose {

// The gap that a sentence states.
struct ComparedGap {
  BeforeAfter gap;
  double seconds = 0;  // that the predictions reach; 0: whole runs
};

std::string Sentence(const Diagnosis& diagnosis, const ComparedGap& compared);

// What `tied_with` has, in words: "amp.delay", "other values of J and b", "other values of the model's parameters".
std::vector<std::string> InWords(const std::vector<std::string>& rivals);

// What an experiment would tell apart; "" where nothing is tied.
std::string WhyNext(const std::vector<FoundEffect>& effects);

// What the choices without each run make of predictions of each run from the others.
std::string ChoiceRemark(const std::vector<ChoiceWithout>& choices);

}  // namespace hydro::diagnose
