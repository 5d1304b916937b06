"""What stands in for the C compiler in tests makes what the compiler makes, and makes it once."""

import shutil
import subprocess
from pathlib import Path

import pytest
from fmutesting import compiling

COUNTING = """#!/bin/sh
case " $* " in *" -E "*) ;; *) echo >> '{made}' ;; esac
exec '{compiler}' "$@"
"""


class Cached:
    """A compiler behind the cache, and how often it has made something."""

    def __init__(self, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        compiler = shutil.which(compiling.COMPILER)
        if compiler is None:
            pytest.skip("there is no C compiler")
        self.folder, self.kept, self._made, counting = folder, folder / "kept", folder / "made", folder / "counting"
        self.kept.mkdir()
        counting.write_text(COUNTING.format(made=self._made, compiler=compiler))
        counting.chmod(0o755)
        monkeypatch.setattr(compiling, "COMPILER", str(counting))
        self.command = compiling.caching_compiler(self.kept)
        (folder / "value.h").write_text("#define VALUE 7\n")
        (folder / "program.c").write_text('#include "value.h"\nint main(void) { return VALUE; }\n')

    def __call__(self, *options: str, output: str = "program") -> subprocess.CompletedProcess[str]:
        command = [str(self.command), "program.c", *options, "-o", output]
        return subprocess.run(command, cwd=self.folder, capture_output=True, text=True, check=False)

    @property
    def made(self) -> int:
        return len(self._made.read_text().splitlines())

    def answer(self, program: str = "program") -> int:
        return subprocess.run([self.folder / program], check=False).returncode


@pytest.fixture
def cached(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Cached:
    return Cached(tmp_path, monkeypatch)


def test_the_same_is_made_once_under_whatever_name(cached: Cached) -> None:
    assert cached().returncode == cached(output="again").returncode == 0
    assert cached.answer() == cached.answer("again") == 7
    assert cached.made == 1


@pytest.mark.parametrize("change", ["source", "header", "option", "compiler"])
def test_what_differs_in_anything_is_made_again(cached: Cached, change: str) -> None:
    cached()
    file, content = {
        "source": ("program.c", "int main(void) { return 8; }\n"),
        "header": ("value.h", "#define VALUE 8\n"),
        "option": ("unused", ""),
        "compiler": ("counting", (cached.folder / "counting").read_text() + "\n"),
    }[change]
    (cached.folder / file).write_text(content)
    cached(*(["-O2"] if change == "option" else []))
    assert (cached.made, cached.answer()) == (2, 8 if change in ("source", "header") else 7)


def test_an_object_that_changed_is_linked_again(cached: Cached) -> None:
    for value in (7, 8):
        (cached.folder / "value.h").write_text(f"#define VALUE {value}\n")
        cached("-c", output="program.o")
        subprocess.run([str(cached.command), "program.o", "-o", "linked"], cwd=cached.folder, check=True)
        assert cached.answer("linked") == value


def test_what_is_not_as_it_was_written_is_made_again(cached: Cached) -> None:
    cached()
    (entry,) = cached.kept.glob("*.made")
    whole = entry.read_bytes()
    for k, damaged in enumerate((whole[:100], b"", whole + b"\0"), 2):
        entry.write_bytes(damaged)
        assert cached().returncode == 0
        assert (cached.made, cached.answer(), entry.read_bytes()) == (k, 7, whole)
