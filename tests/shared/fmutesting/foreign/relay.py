"""A foreign FMU for the tests of the master: passes on what it is given, refuses what is too large."""

from pythonfmu import Boolean, Fmi2Causality, Fmi2Initial, Fmi2Slave, Fmi2Variability, Integer, Real


class Relay(Fmi2Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.u, self.n, self.b = 0.0, 0, False
        self.y, self.n_out, self.b_out = 0.0, 0, False
        self.gain, self.count, self.t, self.limit = 1.0, 0, 0.0, 1e6
        self.flag = False
        for name, kind in {"u": Real, "n": Integer, "b": Boolean}.items():
            variability = Fmi2Variability.continuous if kind is Real else Fmi2Variability.discrete
            self.register_variable(kind(name, causality=Fmi2Causality.input, variability=variability))
        for name, kind in {"y": Real, "t": Real, "n_out": Integer, "b_out": Boolean}.items():
            variability = Fmi2Variability.continuous if kind is Real else Fmi2Variability.discrete
            self.register_variable(
                kind(name, causality=Fmi2Causality.output, variability=variability, initial=Fmi2Initial.calculated)
            )
        for name, kind in {"gain": Real, "limit": Real, "count": Integer, "flag": Boolean}.items():
            self.register_variable(kind(name, causality=Fmi2Causality.parameter, variability=Fmi2Variability.fixed))

    def _pass_on(self):
        self.y, self.n_out, self.b_out = self.gain * self.u, self.n + self.count, self.b != self.flag

    def exit_initialization_mode(self):
        self._pass_on()

    def do_step(self, current_time, step_size):
        if abs(self.u) > self.limit:
            raise ValueError(f"u = {self.u} is beyond the limit of {self.limit}")
        self._pass_on()
        self.t = current_time + step_size
        return True
