"""The smallest controller that the documentation of the loop has, without units: a washout of the motor speed."""

from pythonfmu import Fmi2Causality, Fmi2Slave, Real


class SmallestController(Fmi2Slave):
    def __init__(self, **arguments) -> None:
        super().__init__(**arguments)
        self.T_driver = self.omega_1_meas = self.T_ref = 0.0
        self.slow = None
        for name in ("T_driver", "omega_1_meas"):
            self.register_variable(Real(name, causality=Fmi2Causality.input, start=0.0))
        self.register_variable(Real("T_ref", causality=Fmi2Causality.output))

    def do_step(self, t, dt) -> bool:
        self.slow = self.omega_1_meas if self.slow is None else self.slow
        self.slow += 20.0 * dt * (self.omega_1_meas - self.slow)
        self.T_ref = self.T_driver - 2.0 * (self.omega_1_meas - self.slow)
        return True
