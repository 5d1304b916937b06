"""A plant that somebody else wrote: a rotor turns an elastic shaft that pushes a car.

NAMES is filled in before it is built.
"""

from math import tanh

from pythonfmu import Fmi2Causality, Fmi2Initial, Fmi2Slave, Fmi2Variability, Real

NAMES = {}
"""What the loop calls a variable -> what this FMU calls it, and what it is multiplied by to be in SI units."""

INPUTS = ("T_mot", "T_brake", "slope")
PARAMETERS = {"v_0": 0.0, "T_0": 0.0, "m": 1450.0}
OUTPUTS = ("omega_1", "omega_2", "omega_wheel_L", "omega_wheel_R", "T_gear", "v", "a_body")

J_1, C, D, RATIO, RADIUS, G = 0.055, 117.4, 0.2, 9.0, 0.29, 9.81
SUBSTEP = 1e-4


class Car(Fmi2Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.x = dict.fromkeys((*INPUTS, *OUTPUTS), 0.0) | PARAMETERS
        self.phi = 0.0
        for name in INPUTS:
            self._register(name, Fmi2Causality.input, Fmi2Variability.continuous)
        for name in PARAMETERS:
            self._register(name, Fmi2Causality.parameter, Fmi2Variability.fixed)
        for name in OUTPUTS:
            self._register(name, Fmi2Causality.output, Fmi2Variability.continuous, Fmi2Initial.calculated)

    def _register(self, ours, causality, variability, initial=None):
        name, factor = NAMES.get(ours, (ours, 1.0))

        def give():
            return self.x[ours] / factor

        def take(value):
            self.x[ours] = value * factor

        self.register_variable(
            Real(name, causality=causality, variability=variability, initial=initial, getter=give, setter=take)
        )

    def enter_initialization_mode(self):
        self.x["v"], self.x["T_gear"], self.phi = self.x["v_0"], self.x["T_0"], self.x["T_0"] / C
        self.x["omega_1"] = self.x["v"] * RATIO / RADIUS
        self._show()

    def do_step(self, current_time, step_size):
        x = self.x
        for _ in range(round(step_size / SUBSTEP)):
            slip = x["omega_1"] - x["v"] * RATIO / RADIUS
            x["T_gear"] = C * self.phi + D * slip
            brake = x["T_brake"] / RADIUS * tanh(x["v"] / 0.1)
            x["a_body"] = (x["T_gear"] * RATIO / RADIUS - brake) / x["m"] - G * x["slope"]
            self.phi += SUBSTEP * slip
            x["omega_1"] += SUBSTEP * (x["T_mot"] - x["T_gear"]) / J_1
            x["v"] += SUBSTEP * x["a_body"]
        self._show()
        return True

    def _show(self):
        wheel = self.x["v"] / RADIUS
        self.x |= {"omega_2": RATIO * wheel, "omega_wheel_L": wheel, "omega_wheel_R": wheel}
