"""The loop as a plain C program over the FMI functions, plain_loop.c: the limit for every master.

It sets what is connected, steps, gets what is connected, and does nothing else.
"""

import subprocess
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

import fmpy

from fmublocks.native.compiler import host_compiler
from fmuloop.interface import Interface, type_of
from fmuloop.system import System

SOURCE = Path(__file__).parent / "plain_loop.c"
FLAGS = ("-std=c99", "-Wall", "-Wextra", "-Werror", "-O2")
KINDS = ("Real", "Integer", "Boolean")


@contextmanager
def program(system: System, start: Mapping[str, float], traced: str) -> Iterator[Path]:
    """The loop compiled for this system; all FMUs hand on their outputs after the step, as Jacobi.

    It takes the number of steps and their size in s, and prints the processor time of a step in s, without loading and
    initialization, and the traced output in the end.

    Args:
        start: Real parameters and inputs `instance.variable`.
        traced: Real output `instance.variable`.

    Raises:
        CompilerError: there is no compiler.
        subprocess.CalledProcessError: it refuses the source.
    """
    with TemporaryDirectory() as name:
        folder = Path(name)
        interfaces = {instance: Interface(path) for instance, path in system.instances.items()}
        for instance, interface in interfaces.items():
            fmpy.extract(str(interface.path), unzipdir=str(folder / instance))
        (folder / "wiring.h").write_text(_header(system, interfaces, folder, start, traced), encoding="utf-8")
        made = folder / "loop"
        command = [host_compiler(), *FLAGS, f"-I{folder}", str(SOURCE), "-ldl", "-o", str(made)]
        subprocess.run(command, check=True)
        yield made


def run(system: System, steps: int, step_size: float, start: Mapping[str, float], traced: str) -> tuple[float, float]:
    """Processor time a step in s and the traced output in the end; arguments and errors as of `program`.

    Raises:
        subprocess.CalledProcessError: an FMU refuses a call.
    """
    with program(system, start, traced) as made:
        command = [str(made), str(steps), repr(step_size)]
        done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
    cost, value = map(float, done.stdout.split())
    return cost, value


def _header(
    system: System, interfaces: Mapping[str, Interface], folder: Path, start: Mapping[str, float], traced: str
) -> str:
    sources = {target: source for source, target, _ in system.connections}
    used = {*sources.values(), traced}
    outputs = dict(_ports(interfaces, "output", used))
    inputs = dict(_ports(interfaces, "input", sources))
    places = _places(outputs)
    numbers = {instance: number for number, instance in enumerate(interfaces)}

    def reference(name: str) -> int:
        instance, _, variable = name.partition(".")
        return interfaces[instance].variables[variable].valueReference

    def port(instance: str, kind: str, names: list[str]) -> str:
        references = ", ".join(str(reference(name)) for name in names)
        at = ", ".join(str(places[sources.get(name, name)]) for name in names)
        fields = f".fmu = {numbers[instance]}, .count = {len(names)}, .kind = {kind.upper()}"
        return f"{fields}, .references = {{{references}}}, .places = {{{at}}}"

    given = (f"{numbers[name.partition('.')[0]]}, {reference(name)}, {value!r}" for name, value in start.items())
    return "\n".join(
        (
            _array("Fmu fmus", (_fmu(name, interface, folder / name) for name, interface in interfaces.items())),
            _array("const Start starts", given),
            _array("Port inputs", (port(*key, names) for key, names in inputs.items())),
            _array("Port outputs", (port(*key, names) for key, names in outputs.items())),
            f"enum {{ WATCHED = {places[traced]} }};\n",
        )
    )


def _ports(
    interfaces: Mapping[str, Interface], causality: str, used: Iterable[str]
) -> Iterator[tuple[tuple[str, str], list[str]]]:
    """Instance and kind, and the names of the used variables of both."""
    for instance, interface in interfaces.items():
        for kind in KINDS:
            variables = (v for v in interface.of_causality(causality) if type_of(v) == kind)
            names = [name for v in variables if (name := f"{instance}.{v.name}") in used]
            if names:
                yield (instance, kind), names


def _places(outputs: Mapping[tuple[str, str], list[str]]) -> dict[str, int]:
    """Of each output among the Reals, or among all others."""
    reals = [name for (_, kind), names in outputs.items() if kind == "Real" for name in names]
    wholes = [name for (_, kind), names in outputs.items() if kind != "Real" for name in names]
    return {name: place for names in (reals, wholes) for place, name in enumerate(names)}


def _fmu(name: str, interface: Interface, folder: Path) -> str:
    library = folder / "binaries" / fmpy.platform / f"{interface.identifier}{fmpy.sharedLibraryExtension}"
    texts = {"library": library, "name": name, "guid": interface.description.guid}
    texts["resources"] = (folder / "resources").as_uri()
    return ", ".join(f'.{field} = "{text}"' for field, text in texts.items())


def _array(declaration: str, records: Iterable[str]) -> str:
    rows = "".join(f"    {{{record}}},\n" for record in records)
    return f"static {declaration}[] = {{\n{rows}}};\n"
