% The position loop of ../pid.py as a function: what is asked of the pressure loop, in psi.
function pressure_ref = pd_law(arm_angle, arm_speed)
  target = 0.3; c1 = 6000; c2 = 1200; most = 135;  % rad, psi/rad, psi s/rad, psi
  asked = -c1 .* (arm_angle - target) - c2 .* arm_speed;
  pressure_ref = max(-most, min(most, asked));
end
