"""Which outputs follow from which inputs within the same instant, as the FMUs declare it."""

from collections.abc import Iterator, Mapping

from fmpy.model_description import ModelVariable

from .errors import WiringError
from .interface import Interface
from .system import System


class Feedthrough:
    """The declared dependencies of the outputs of a system, all named `instance.variable`.

    An output whose dependencies are not declared may follow from every input, as FMI has it.

    Attributes:
        inputs: output -> inputs of its FMU that it follows from.
        sources: output -> outputs that feed these inputs.
        undeclared: outputs of which nothing is declared.
    """

    def __init__(self, system: System, interfaces: Mapping[str, Interface]) -> None:
        self.inputs: dict[str, frozenset[str]] = {}
        self.undeclared: set[str] = set()
        for instance, interface in interfaces.items():
            everything = frozenset(v.name for v in interface.of_causality("input"))
            for output, inputs in declared(interface).items():
                name = f"{instance}.{output}"
                if inputs is None:
                    self.undeclared.add(name)
                self.inputs[name] = frozenset(f"{instance}.{i}" for i in (everything if inputs is None else inputs))
        feeds = {target: source for source, target, _ in system.connections}
        self.sources = {name: frozenset(feeds[i] for i in inputs if i in feeds) for name, inputs in self.inputs.items()}

    def propagation(self, known: set[str]) -> Iterator[list[str]]:
        """The other outputs in an order in which each follows from what is known of its instant.

        Outputs of one FMU that can be read together come together. Where dependencies that are not
        declared would close a loop, they are taken not to exist.

        Raises:
            WiringError: declared dependencies form an algebraic loop.
        """
        undetermined = [name for name in self.inputs if name not in known]
        while undetermined:
            ready = [name for name in undetermined if self.sources[name] <= known]
            ready = ready or [name for name in undetermined if name in self.undeclared]
            if not ready:
                raise WiringError(self._loop(undetermined))
            together = [name for name in ready if _instance(name) == _instance(ready[0])]
            yield together
            known = known.union(together)
            undetermined = [name for name in undetermined if name not in known]

    def _loop(self, undetermined: list[str]) -> str:
        """What to say of an algebraic loop; each of the outputs left follows from another of them."""
        path = [undetermined[0]]
        while path.count(path[-1]) == 1:
            path.append(min(self.sources[path[-1]].intersection(undetermined)))
        loop = path[path.index(path[-1]) :]
        return (
            f"algebraic loop: {' follows from '.join(loop)} within the same instant; "
            "the schemes gauss-seidel and jacobi put a step of delay into it"
        )


def declared(interface: Interface) -> dict[str, frozenset[str] | None]:
    """Output -> inputs that it follows from within the same instant, or None if that is not declared."""
    inputs = {_identity(v): v.name for v in interface.of_causality("input")}
    unknowns = {_identity(u.variable): u.dependencies for u in interface.description.outputs if u.variable}
    knowns_of = {v.name: unknowns.get(_identity(v)) for v in interface.of_causality("output")}
    return {
        name: None if knowns is None else frozenset(inputs[_identity(v)] for v in knowns if _identity(v) in inputs)
        for name, knowns in knowns_of.items()
    }


def _identity(variable: ModelVariable) -> tuple[str, int]:
    """What a variable keeps when it is mapped."""
    return variable.type, variable.valueReference


def _instance(name: str) -> str:
    return name.partition(".")[0]
