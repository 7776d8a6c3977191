"""A step of the arm by the paper's equations in plain Python: nothing of the project's programs is in it.

Eqs. (1) to (15) with the pump's Coulomb friction and the one-way valves, under the laws (16) and (17) as config/retuned.toml asks for
them, one tick of command delay. Classical Runge-Kutta with fixed steps; a switch (the pump stops, a valve opens) takes place at the
end of the step in which it is met, so that results are right to about a step's length.
"""

import math

RATE = 5000  # Hz, the plant's ticks
INTERVAL = 25  # ticks between samples of the position loop
C1, C2 = 10000.0, 900.0  # psi/rad, psi s/rad
NATURAL_FREQUENCY, DAMPING = 150.0, 0.5


def pressure_law(p):
    """k_p, k_v, feed-forward, c/D and the voltage's limit for parameters p: what a controller makes of the model it knows."""
    stiffness = 2 * p["beta"] * p["D"] / p["V_ms"]  # psi/rad: dp per angle of the pump, both sides compressing
    k_p = (p["J"] * NATURAL_FREQUENCY**2 / stiffness - p["D"]) / p["k_1"]
    k_v = (2 * DAMPING * NATURAL_FREQUENCY * p["J"] - p["b"]) / (p["k_1"] * k_p)
    creep = (p["c_I"] + p["c_E"]) / p["D"]  # rad/s per psi, one side at p_3
    feedforward = p["D"] / p["k_1"] + creep * (p["b"] / p["k_1"] + k_p * k_v)
    return k_p, k_v, feedforward, p["c"] / p["D"], p["T_pmax"] / p["k_1"]


class Machine:
    def __init__(self, p):
        self.p = p
        self.speed = self.angle = self.arm_speed = 0.0
        self.p1 = self.p2 = p["p_3"]

    def rates(self, torque, y):
        p = self.p
        speed, p1, p2, angle, arm_speed = y
        dp = p2 - p1
        net = torque - p["D"] * dp
        if speed == 0 and abs(net) <= p["T_s"]:
            acceleration = 0.0
        else:
            direction = math.copysign(1, speed if speed != 0 else net)
            acceleration = (net - p["b"] * speed - p["T_s"] * direction) / p["J"]
        flow = p["D"] * speed - p["c_I"] * dp
        q1 = flow + p["c_E"] * (p1 - p["p_3"]) - p["c"] * arm_speed
        q2 = -flow + p["c_E"] * (p2 - p["p_3"]) + p["c"] * arm_speed
        rate1 = -p["beta"] / (p["V_ms"] - p["c"] * angle) * q1
        rate2 = -p["beta"] / (p["V_ms"] + p["c"] * angle) * q2
        if p1 <= p["p_3"]:
            rate1 = max(rate1, 0.0)
        if p2 <= p["p_3"]:
            rate2 = max(rate2, 0.0)
        return acceleration, rate1, rate2, arm_speed, (p["k_2"] * dp - p["mgl"] * math.cos(angle)) / p["J_a"]

    def advance(self, voltage, step):
        p = self.p
        torque = max(-p["T_pmax"], min(p["T_pmax"], p["k_1"] * voltage))
        y = (self.speed, self.p1, self.p2, self.angle, self.arm_speed)
        a = self.rates(torque, y)
        b = self.rates(torque, [v + step / 2 * r for v, r in zip(y, a)])
        c = self.rates(torque, [v + step / 2 * r for v, r in zip(y, b)])
        d = self.rates(torque, [v + step * r for v, r in zip(y, c)])
        speed, p1, p2, self.angle, self.arm_speed = (
            v + step / 6 * (r + 2 * s + 2 * t + u) for v, r, s, t, u in zip(y, a, b, c, d))
        # A pump that reverses stops first. In the next step, friction decides whether it continues.
        self.speed = 0.0 if speed * self.speed < 0 else speed
        self.p1, self.p2 = max(p1, p["p_3"]), max(p2, p["p_3"])


def step_response(known, machine, step, duration, substeps):
    """The arm's angle at each tick from the step on; the controllers know `known`, the plant is `machine`."""
    k_p, k_v, feedforward, ratio, limit = pressure_law(known)
    plant = Machine(machine)
    angles = []
    previous_angle = 0.0
    reference = next_reference = voltage = next_voltage = 0.0
    for tick in range(round(duration * RATE) + 1):
        angles.append(plant.angle)
        voltage, reference = next_voltage, next_reference
        if tick % INTERVAL == 0:
            next_reference = -C1 * (plant.angle - step) - C2 * RATE / INTERVAL * (plant.angle - previous_angle)
            previous_angle = plant.angle
        dp = plant.p2 - plant.p1
        asked = k_p * (reference - dp - k_v * (plant.speed - ratio * plant.arm_speed)) + feedforward * reference
        next_voltage = max(-limit, min(limit, asked))
        for _ in range(substeps):
            plant.advance(voltage, 1 / RATE / substeps)
    return angles


def measure(angles, step):
    """Settling time (2 %; None: never) and overshoot, in percent."""
    outside = [i for i, angle in enumerate(angles) if abs(angle - step) > 0.02 * step]
    settling = (outside[-1] + 1) / RATE if outside and outside[-1] + 1 < len(angles) else None
    return settling, max(0.0, 100 * (max(angles) / step - 1))
