// The differences between a model's two sides, for example of a cylinder with its rod on one side, for laws,
// design and limits. The equations take them from the effects themselves.
#pragma once

#include "model/terms/description.h"

namespace hydro::model {

// Each is (side 2 - side 1)/(side 1 + side 2). The base parameters are the means of both sides.
struct Differences {
  double areas = 0;          // actuator.unequal_areas: c_1 = c (1 - areas), c_2 = c (1 + areas); k_2 likewise
  double volumes = 0;        // actuator.unequal_volumes
  double displacements = 0;  // pump.unequal_displacements

  bool operator==(const Differences&) const = default;
};

Differences DifferencesOf(const ModelDescription& model);

// How far a free arm can move from 0 before a side has no volume left, in the arm's coordinate.
struct Travel {
  double least = 0, most = 0;

  double nearer() const { return -least < most ? -least : most; }
};

Travel TravelOf(const ModelDescription& model);

// The pressure difference that would give a symmetric actuator the same torque: (c_2 p2 - c_1 p1)/c. The
// pressure loop controls it, and k_2 times it is the arm's torque.
inline double LoadPressure(double areas, double p1, double p2) {
  const double difference = p2 - p1;
  return areas == 0 ? difference : difference + areas * (p1 + p2);
}

}  // namespace hydro::model
