// The verdict in one sentence, and other things that a diagnosis says in words.
#pragma once

#include <string>
#include <vector>

#include "diagnose/recording/diagnosis.h"

namespace hydro::diagnose {

std::string Sentence(const Diagnosis& diagnosis, const ComparedGap& compared);

// What a part of an explanation changes, in words: "closure.pump_torque(motor_speed)" is "an unknown curve over motor speed in pump
// torque", "value.b" "another value of b", "run.T_s" "T_s that differs by run"; an effect's id stays.
std::string ChangeInWords(const std::string& change);

// What `tied_with` has, in words: "amp.delay", "other values of J and b", "other values of the model's parameters".
std::vector<std::string> InWords(const std::vector<std::string>& rivals);

// What an experiment would tell apart; "" where nothing is tied.
std::string WhyNext(const std::vector<FoundEffect>& effects);

// What the choices without each run make of predictions of each run from the others.
std::string ChoiceRemark(const std::vector<ChoiceWithout>& choices);

}  // namespace hydro::diagnose
