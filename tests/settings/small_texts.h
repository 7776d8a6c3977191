// A small valid configuration and model.
#pragma once

namespace hydro::settings {

inline const char kModelText[] = R"(name = "Table 1"
[parameters]
k_1 = 4.0
T_pmax = 40.0
D = 0.00796
J = 0.03
b = 0.01455
T_s = 4.0
f = 0.0
beta = 247000
V_ms = 3.16
r = 1.83
d = 2.20
c_E = 6.5e-6
c_I = 1.0e-6
p_3 = 100.0
k_2 = 3.68
J_a = 23.3
mgl = 0.0
)";

inline const char kConfigText[] = R"([model]
file = "model.toml"
[plant]
rate_hz = 1000
[pressure]
natural_frequency_rad_s = 150
damping_ratio = 0.5
[position]
c1 = 10500
c2 = 350
[reference]
signal = "arm_angle"
kind = "steps"
steps = [[0.1, 0.1]]
)";

}  // namespace hydro::settings
