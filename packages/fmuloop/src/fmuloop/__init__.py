"""FMUs wired, stepped and recorded: one by one, in the lanes of the processor, on cores or a cluster.

    from pathlib import Path
    from fmuloop import Connection, Experiment, Port, System, run

    system = System(
        instances={"controller": Path("PiController.fmu"), "plant": Path("Lag.fmu")},
        connections=(Connection("controller.u", "plant.u"), Connection("plant.y", "controller.y")),
        inputs=(Port("controller.r", "1"),),
    )
    results = run(system, Experiment(duration=2.0, step_size=0.01, inputs={"controller.r": 1.0}))
    print(results["plant.y"][-1])

Names, units and causality of the wiring are checked before the run (`WiringError`); what an FMU refuses is a
`SimulationError`. What stands in `__init__.pyi` is public.
"""

from toolground.public_names import public_names

__getattr__, __dir__ = public_names(__name__, __file__)
