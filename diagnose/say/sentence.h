// The verdict in one sentence, and other parts of a diagnosis in words.
#pragma once

#include <string>
#include <vector>

#include "diagnose/recording/diagnosis.h"

namespace hydro::diagnose {

std::string Sentence(const Diagnosis& diagnosis, const ComparedGap& compared);

// What a part of an explanation changes, in words: "closure.pump_torque(motor_speed)" becomes "an unknown
// curve over motor speed in pump torque", "value.b" becomes "another value of b", "run.T_s" becomes "T_s that
// differs by run". The id of an effect stays.
std::string ChangeInWords(const std::string& change);

// Puts the entries of `tied_with` into words: "amp.delay", "other values of J and b", "other values of the
// model's parameters".
std::vector<std::string> InWords(const std::vector<std::string>& rivals);

// What an experiment would distinguish; "" where nothing is tied.
std::string WhyNext(const std::vector<FoundEffect>& effects);

// Says how well the choices made without each run predict that run from the others.
std::string ChoiceRemark(const Diagnosis& d);

}  // namespace hydro::diagnose
