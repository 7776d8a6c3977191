#!/usr/bin/env python3
"""A position loop of one's own in the place of hydro-position-ctrl: docs/own_controller.md. Started by hand: pid.py BUS_URL"""
import sys

import hydro_bus
from hydro import pressure_command_t

TARGET, C1, C2, MOST = 0.3, 6000.0, 1200.0, 135.0  # rad, psi/rad, psi s/rad; psi, below limits.arm_torque / k_2


def answer(state, command):  # state: arm_angle, arm_speed, motor_speed, p1, p2, time, tick, ...
    asked = -C1 * (state.arm_angle - TARGET) - C2 * state.arm_speed
    command.pressure_ref = max(-MOST, min(MOST, asked))


bus = hydro_bus.Bus(*sys.argv[1:2])
sys.exit(hydro_bus.Loop(bus, "position_ctrl", "HYDRO_PRESSURE_COMMAND", pressure_command_t, answer, every=5,
                        reference=lambda state: TARGET).run())
