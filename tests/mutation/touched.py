"""Which tests touch which line: one run of the fast tests under coverage, kept until the tests or the code change.

    python tests/mutation/touched.py [SHARD SHARDS]  # of so many runs side by side, counted from 0

What a test does is told apart from what is made once for many of them: the lines of a fixture of a module or of the
session are touched by all tests that use it. Slow tests are left out. No test is interrupted, for what it was waiting
for may then never end: one that is still running after WAITED ends its process, and another one goes on behind it.
"""

import ast
import json
import os
import re
import shutil
import signal
import sys
from collections.abc import Collection, Generator, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cached_property
from hashlib import sha256
from pathlib import Path
from time import process_time
from typing import Any, NamedTuple

import pytest
from coverage import Coverage, CoverageData
from hypothesis import Phase, settings
from mutants import CODE, ROOT, Mutant, code_files

KEPT = ROOT / "build" / "mutation"
"""Folder of what a run has shown of this machine's checkout; not under version control."""

WAITED = 180
"""Time in s that a test may take with the programs that it waits for."""

EXAMPLES = 25
"""Of a property, unless the test says how many: further ones hardly touch other lines."""

OWN = 10.0
"""As often as another test a test of the module itself finds a fault in it, at the same cost."""

RUNNING = "running"
"""File with the name of the test that is running."""

OPTIONS = "-q", "--tb=no", "-m", "not slow", "--hypothesis-profile=watched"

CONFIGURATION = """\
[run]
parallel = true
patch = subprocess
context = ${MUTATION_TEST-}
"""
"""Programs that a test starts are watched too, and know for whom they run."""


class Test(NamedTuple):
    """A test as it was watched.

    Attributes:
        name: as pytest selects it.
        time: that it computed, in s.
        fixtures: what it uses that is made once for many tests.
    """

    name: str
    time: float
    fixtures: tuple[str, ...]

    @property
    def file(self) -> str:
        return self.name.partition("::")[0]


class Watch:
    """Plugin of pytest that says to coverage what is running, and notes it for the process that waits."""

    def __init__(self, coverage: Coverage, folder: Path, digests: Mapping[str, str]) -> None:
        self.coverage, self.folder, self.digests = coverage, folder, digests
        self.running = [""]
        self.tests: list[Test] = []
        self.passed: set[str] = set()

    @contextmanager
    def of(self, name: str) -> Iterator[None]:
        """What runs within belongs to a test or to a fixture."""
        self.running.append(name)
        self._now()
        try:
            yield
        finally:
            self.running.pop()
            self._now()

    def _now(self) -> None:
        os.environ["MUTATION_TEST"] = self.running[-1]
        self.coverage.switch_context(self.running[-1])

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(self, fixturedef: Any) -> Generator[None, Any, Any]:
        if fixturedef.scope == "function":
            return (yield)
        with self.of(_wide(fixturedef)):
            return (yield)

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: Any, nextitem: Any) -> Generator[None, Any, Any]:
        began = process_time()
        (self.folder / RUNNING).write_text(item.nodeid, encoding="utf-8")
        signal.alarm(WAITED)  # ends the process
        definitions = [each[-1] for each in item._fixtureinfo.name2fixturedefs.values()]
        wide = tuple(_wide(each) for each in definitions if each.scope != "function")
        with self.of(item.nodeid):
            result = yield
        self.tests.append(Test(item.nodeid, process_time() - began, wide))
        if nextitem is None or nextitem.path != item.path:
            self.keep()
        return result

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.when == "call" and report.passed:
            self.passed.add(report.nodeid)

    def keep(self) -> None:
        """What was seen until now."""
        self.coverage.save()
        passed = [test for test in self.tests if test.name in self.passed]
        others = [test.name for test in self.tests if test.name not in self.passed]
        record = {"tests": passed, "left_out": others, "digests": self.digests}
        (self.folder / "tests.json").write_text(json.dumps(record), encoding="utf-8")


def _wide(definition: Any) -> str:
    """Name of a fixture that is made for more than one test."""
    return f"{definition.baseid or '.'} {definition.argname}"


def bytes_of(path: Path) -> str:
    return sha256(path.read_bytes()).hexdigest()[:16]


def watch(shard: int = 0, shards: int = 1) -> None:
    """Runs every so manieth file of the tests, and keeps what was seen."""
    for old in KEPT.glob(f"{shard}_*"):
        shutil.rmtree(old)
    left, stuck = test_files()[shard::shards], []
    while left:
        folder = KEPT / f"{shard}_{len(stuck)}"
        folder.mkdir(parents=True)
        child = os.fork()
        if child == 0:
            _watch(left, stuck, folder)
        if not os.WIFSIGNALED(os.waitpid(child, 0)[1]):
            return
        stuck.append((folder / RUNNING).read_text(encoding="utf-8"))
        print(f"does not end: {stuck[-1]}", flush=True)
        left = left[left.index(stuck[-1].partition("::")[0]) :]


def _watch(files: Sequence[str], stuck: Sequence[str], folder: Path) -> None:
    """Runs files of tests but those that do not end; ends the process."""
    os.chdir(ROOT)
    sys.path[0] = str(ROOT)
    watched = {"deadline": None, "derandomize": True, "max_examples": EXAMPLES}
    settings.register_profile("watched", phases=(Phase.explicit, Phase.generate), **watched)
    configuration = folder / "coverage.ini"
    configuration.write_text(CONFIGURATION + f"source = {','.join(str(ROOT / each) for each in CODE)}\n")
    seen = Coverage(data_file=str(folder / "lines"), config_file=str(configuration))
    plugin = Watch(seen, folder, {file: bytes_of(ROOT / file) for file in (*files, *code_files())})
    seen.start()
    pytest.main([*OPTIONS, *files, *(f"--deselect={test}" for test in stuck)], plugins=[plugin])
    plugin.keep()
    os._exit(0)  # whatever the tests have left running


def test_files() -> list[str]:
    """Those that need no FMUs first."""
    paths = sorted((ROOT / "tests").rglob("test_*.py"))
    needs = {
        path: bool(re.search(r"\b(native|built|both_built)\b", path.read_text(encoding="utf-8"))) for path in paths
    }
    return [str(path.relative_to(ROOT)) for path in sorted(paths, key=lambda path: (needs[path], path))]


class Touched:
    """What the runs under coverage have shown, as far as it still holds."""

    def __init__(self) -> None:
        """Of no test if there was no run."""
        self.tests: dict[str, Test] = {}
        self.left_out: list[str] = []
        self.seen: list[CoverageData] = []
        self.digests: dict[str, str] = {}
        for folder in sorted(each.parent for each in KEPT.glob("*/tests.json")):
            record = json.loads((folder / "tests.json").read_text(encoding="utf-8"))
            self.digests |= record["digests"]
            self.left_out += record["left_out"]
            found = [Test(name, time, tuple(fixtures)) for name, time, fixtures in record["tests"]]
            self.tests |= {test.name: test for test in found}
            combined = Coverage(data_file=str(folder / "combined"), config_file=str(folder / "coverage.ini"))
            combined.combine([str(each) for each in folder.glob("lines*")], keep=True)
            self.seen.append(combined.get_data())

    @cached_property
    def users(self) -> dict[str, list[Test]]:
        """Tests by the fixture that they use."""
        found: dict[str, list[Test]] = {}
        for test in self.tests.values():
            for fixture in test.fixtures:
                found.setdefault(fixture, []).append(test)
        return found

    @cached_property
    def unseen(self) -> list[str]:
        """Files of tests that are new, have changed since, or were not watched."""
        seen = {test.file for test in self.tests.values()}
        return [file for file in test_files() if file not in seen or self.digests[file] != bytes_of(ROOT / file)]

    @property
    def sound(self) -> set[str]:
        """Tests that have passed as they are."""
        return {name for name, test in self.tests.items() if test.file not in self.unseen}

    def naming(self, file: str) -> list[str]:
        """Those of them that name a module, its own first, then tests of files that do which did not pass here."""
        files = self.naming_files(file)
        left_out = [test for test in self.left_out if test.partition("::")[0] in {*files} - {*self.unseen}]
        return [each for each in files if each in self.unseen] + left_out

    def naming_files(self, file: str) -> list[str]:
        """All files of tests that name a module, its own first."""
        stem = Path(file).stem
        name = re.compile(rf"[./]{stem}\b|import .*\b{stem}\b")
        own = own_tests(file)
        return own + [e for e in test_files() if e not in own and name.search((ROOT / e).read_text(encoding="utf-8"))]

    def by(self, mutant: Mutant) -> list[Test]:
        """The tests that touch the place of a fault, the cheapest and its own first and those of one function apart.

        What is computed while a module is imported is touched by whoever touches a function that names it, else by who
        touches the file; so is what stands in a file that has changed since.
        """
        path = str(ROOT / mutant.file)
        places = {path: None}
        if self.digests.get(mutant.file) == bytes_of(ROOT / mutant.file):
            lines, names = _place(ast.parse((ROOT / mutant.file).read_bytes()), mutant.line)
            places = {path: lines} if lines else _where(names) or places
        contexts = {context for file, lines in places.items() for context in self._contexts(file, lines)}
        found = {test for name in contexts for test in (self.users.get(name) or [self.tests.get(name)]) if test}
        return _spread(found, own_tests(mutant.file))

    def _contexts(self, file: str, lines: set[int] | None) -> Iterator[str]:
        for data in self.seen:
            for line, contexts in data.contexts_by_lineno(file).items():
                if lines is None or line in lines:
                    yield from contexts


def is_in_function(mutant: Mutant) -> bool:
    """Whether a fault is in what runs when a function is called, and not while the module is imported."""
    return bool(_place(ast.parse((ROOT / mutant.file).read_bytes()), mutant.line)[0])


def own_tests(file: str) -> list[str]:
    """The files of the tests of a module."""
    return [each for each in test_files() if Path(each).stem == f"test_{Path(file).stem}"]


def _spread(tests: Collection[Test], own: Collection[str]) -> list[Test]:
    """Cheap ones and those of the files `own` first, but of many cases of the same test one after the other."""
    cases: dict[str, int] = {}
    ranked = []
    for test in sorted(tests, key=_cost):
        function = test.name.partition("[")[0]
        cases[function] = cases.get(function, 0) + 1
        dear = (_cost(test) + 0.02) / (OWN if test.file in own else 1.0)
        ranked.append((cases[function] * dear, test.name, test))
    return [test for *_, test in sorted(ranked)]


def _cost(test: Test) -> float:
    """In s, with what is made for many tests and may have to be made again."""
    return test.time + sum(10.0 if fixture.startswith(("tests ", ". ")) else 1.0 for fixture in test.fixtures)


def _place(tree: ast.AST, line: int) -> tuple[set[int], set[str]]:
    """The lines of the statement of a function in which a line stands; outside of functions none, but the names under
    which others find what is computed there."""
    lines: set[int] = set()
    names: set[str] = set()
    inside = False
    for node in ast.walk(tree):  # from the outside to the inside
        if not isinstance(node, ast.stmt) or not node.lineno <= line <= (node.end_lineno or 0):
            continue
        body = getattr(node, "body", None)
        end = body[0].lineno - 1 if body and line < body[0].lineno else node.end_lineno or 0
        is_definition = isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef)
        if inside and (end < (node.end_lineno or 0) or not body):
            lines = set(range(node.lineno, end + 1))
        if is_definition or not inside:
            names |= _names_of(node)
        inside = inside or (isinstance(node, ast.FunctionDef) and body is not None and line >= body[0].lineno)
    return lines, names


def _names_of(node: ast.stmt) -> set[str]:
    match node:
        case ast.FunctionDef(name=name) | ast.ClassDef(name=name) if not name.startswith("__"):
            return {name}
        case ast.Assign(targets=targets):
            return {part.id for target in targets for part in ast.walk(target) if isinstance(part, ast.Name)}
        case ast.AnnAssign(target=ast.Name(id=name)):
            return {name}
    return set()


def _where(names: Collection[str]) -> dict[str, set[int] | None]:
    """The lines of the code at which one of these names stands, by file."""
    found: dict[str, set[int] | None] = {}
    for path in (ROOT / file for file in code_files()):
        text = path.read_text(encoding="utf-8")
        if any(name in text for name in names):
            nodes = ast.walk(ast.parse(text))
            at = {n.lineno for n in nodes if isinstance(n, ast.Name | ast.Attribute) and _name(n) in names}
            if at:
                found[str(path)] = at
    return found


def _name(node: ast.Name | ast.Attribute) -> str:
    return node.id if isinstance(node, ast.Name) else node.attr


if __name__ == "__main__":
    watch(*map(int, sys.argv[1:]))
