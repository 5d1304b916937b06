"""Which tests cover a file, by the names of files, by what tests import and by the folders in which they lie."""

import re
from functools import cache
from pathlib import Path

from tests.mutation.mutants import ROOT, rooms

NOWHERE = "packages/fmublocks/tests/native/test_no_step_to_nowhere.py"
CALLS_IN_C = "places", "calls", "same_words", "as_python", "rates", "content"
CALLS = (
    *(f"tests/fmus/native/test_{name}.py" for name in CALLS_IN_C),
    NOWHERE,
    "tests/test_fuzz.py::test_odd_input_is_answered_as_promised[calls]",
)
INTEGRATOR = (
    *(f"tests/fmus/native/test_{name}.py" for name in ("integrator", "rates")),
    NOWHERE,
    "tests/fmus/test_stiff_plants.py",
)
IN_C = {
    "sampled": ("tests/fmus/native/test_runner.py",),
    **dict.fromkeys(("integrator", "explicit", "implicit"), INTEGRATOR),
    "operators": ("tests/fmus/native/test_functions.py",),
    "content": ("tests/fmus/test_state.py",),
    **dict.fromkeys(
        (f"fmi3{part}" for part in ("", "_instance", "_model_exchange", "_refused", "_terminal")),
        ("tests/fmus/native/test_fmi3.py", "tests/fmus/native/test_terminal.py"),
    ),
    **dict.fromkeys(("lanes", "lane_loop"), ("tests/fmuloop/test_lanes.py",)),
    "frames": ("tests/fmus/native/test_terminal.py",),
    **dict.fromkeys(("model_exchange", "fmi2_model_exchange"), ("tests/fmus/native/test_model_exchange.py",)),
}
"""The tests of files of the C core that find their faults before those of the calls do."""

LAST = {
    "models/": "tests/docs/studies/test_study.py",
    "packages/fmublocks/src/fmublocks/description/": "tests/fmus/native/test_fmi3.py",
    "packages/fmublocks/src/fmublocks/python/": "tests/fmus/native/test_same_words.py",
}
"""By folder: for models the sentinels of the studies, for descriptions what a validator says of one of FMI 3.0, and
that FMUs that run Python say what native ones do."""


def rounds(file: str) -> list[list[str]]:
    """Files of tests in the order in which they are run: those of the file itself, those that import it from its room,
    those that name it, those that belong to what imports it, all of the room, and those of LAST."""
    path, found = Path(file), []
    if path.suffix == ".py":
        last = [tests for folder, tests in LAST.items() if file.startswith(folder)]
        stages = [own(file), naming(f"{path.parent.name}.{path.stem}"), naming(path.stem), near(path), room(path), last]
    else:
        stages = [[name for name in IN_C.get(path.stem, ()) if (ROOT / name).exists()], list(CALLS)]
    for names in stages:
        found.append([name for name in names if not any(name in earlier for earlier in found)])
    return [names for names in found if names]


def own(file: str) -> list[str]:
    """The files of the tests of a module."""
    return [test for test in tests() if Path(test).stem == f"test_{Path(file).stem}"]


def slow(file: str) -> list[str]:
    """Files of tests of which the slow ones are run for what the others miss: those of a module, and that import it
    from its room; if there are none those of its folder and of the folders above."""
    path = Path(file)
    if path.suffix != ".py":
        return [*IN_C.get(path.stem, ()), *CALLS]
    return list(dict.fromkeys([*own(file), *naming(f"{path.parent.name}.{path.stem}")])) or room(path)


def naming(module: str) -> list[str]:
    """Files of tests that name a module, or it with its room."""
    return [test for test, named in tests().items() if module in named]


def near(path: Path) -> list[str]:
    """Files of the tests of modules that import this one."""
    return [test for file, named in modules().items() if path.stem in named for test in own(file)]


def room(path: Path) -> list[str]:
    """Files of tests in the folders that belong to that of a module, and in those above it, but not in tests/; those of
    a package lie beside it, and where they need more than it in tests/ by its name."""
    within = path.parent.relative_to(Path(*path.parts[:3])) if path.parts[0] == "packages" else path.parent
    places = [Path("tests", within)]
    if path.parts[0] == "packages":
        places.insert(0, Path(*path.parts[:2], "tests", *within.parts[1:]))
    folders = [folder for here in places for folder in (here, *here.parents) if len(folder.parts) > 1]
    return [test for folder in folders for test in tests() if Path(test).parent == folder]


@cache
def tests() -> dict[str, set[str]]:
    """Files of tests, with the names in them that may be those of modules."""
    every = (path for pattern in ("tests/**/test_*.py", "packages/*/tests/**/test_*.py") for path in ROOT.glob(pattern))
    paths = [path for path in every if path.parent != Path(__file__).parent]
    both = r"[./](\w+)", r"(?=\b(\w+\.\w+))"
    return {
        path.relative_to(ROOT).as_posix(): set().union(*(_names(path, each) for each in both)) for path in sorted(paths)
    }


@cache
def modules() -> dict[str, set[str]]:
    """Files of the code, with the names that they import."""
    return {
        file: _names(ROOT / file, r"^ *from \.+[\w.]*?(\w+) import") for files in rooms().values() for file in files
    }


def _names(path: Path, pattern: str) -> set[str]:
    text = path.read_text(encoding="utf-8")
    imported = re.findall(r"^ *(?:from .*)?import (.*)", text, re.M)
    return {*re.findall(pattern, text, re.M), *re.findall(r"\w+", " ".join(imported))}
