"""The run under coverage goes on behind a test that does not end."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

MUTATION = Path(__file__).parent

WATCH = """
import sys
from pathlib import Path
sys.path.insert(0, sys.argv[1])
import touched
touched.ROOT, touched.KEPT = Path.cwd(), Path.cwd() / "kept"
touched.WAITED = 1
touched.code_files = lambda: []
touched.watch()
"""

TESTS = {
    "a": "def test_before(): pass",
    "b": "import threading\ndef test_first(): pass\ndef test_hangs(): threading.Event().wait()\ndef test_last(): pass",
    "c": "def test_after(): pass\ndef test_fails(): assert False",
}


@pytest.mark.slow
def test_a_test_that_does_not_end_is_left_out_and_the_others_are_watched(tmp_path: Path) -> None:
    (tmp_path / "pytest.ini").write_text("[pytest]\n")
    (tmp_path / "tests").mkdir()
    for name, code in TESTS.items():
        (tmp_path / "tests" / f"test_{name}.py").write_text(code)
    command = [sys.executable, "-c", WATCH, MUTATION]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=100, check=True)
    assert "does not end: tests/test_b.py::test_hangs\n" in done.stdout
    records = [json.loads((tmp_path / "kept" / run / "tests.json").read_text()) for run in ("0_0", "0_1")]
    passed = [[name.partition("::")[2] for name, *_ in record["tests"]] for record in records]
    assert passed == [["test_before"], ["test_first", "test_last", "test_after"]]
    assert [record["left_out"] for record in records] == [[], ["tests/test_c.py::test_fails"]]
