// One run: machine, loops and sensors together.
#pragma once

#include <cstdint>
#include <vector>

#include "loops.h"
#include "machine.h"
#include "plan.h"
#include "recorder.h"

namespace foreign_rig {

struct Row {
  double time, volts;
  Sample sample;
};

std::vector<Row> Record(const Rig& rig, const Plan& plan, const Recorder& recorder, double seconds,
                        uint64_t seed);

}  // namespace foreign_rig
