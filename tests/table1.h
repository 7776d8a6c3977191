// Table 1 of the paper, for tests.
#pragma once

#include "model/terms/description.h"

namespace hydro::testing {

inline model::Parameters Table1() {
  model::Parameters p;
  p.k_1 = 4.0;
  p.T_pmax = 40.0;
  p.D = 0.00796;
  p.J = 0.03;
  p.b = 0.01455;
  p.T_s = 4.0;
  p.f = 0;
  p.beta = 247000;
  p.V_ms = 3.16;
  p.c = 1.83 * 1.83 * 2.20 / 2;
  p.c_E = 6.5e-6;
  p.c_I = 1.0e-6;
  p.p_3 = 100;
  p.k_2 = 3.68;
  p.J_a = 23.3;
  p.mgl = 0;
  return p;
}

}  // namespace hydro::testing
