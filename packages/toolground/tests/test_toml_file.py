"""TOML files of anybody: read as they are, or refused before they take long."""

import os
import sys
from pathlib import Path

import pytest
from fmutesting.together import together

from toolground.digest import digest
from toolground.file_limits import DEEPEST_TOML, LARGEST_TOML, MOST_DIGITS
from toolground.toml_file import toml_entries


def read(folder: Path, text: str) -> dict:
    path = folder / "file.toml"
    path.write_text(text, encoding="utf-8")
    return toml_entries(path)


@together("part", ["a", "1", '"a b"', "'='", r'"\""', "a "])
def test_a_key_has_ten_parts_at_the_most(tmp_path: Path, part: str) -> None:
    assert read(tmp_path, f"{'.'.join([part] * DEEPEST_TOML)} = 1")
    assert read(tmp_path, f"[{'.'.join([part] * DEEPEST_TOML)}]")
    for text in (f"{'.'.join([part] * (DEEPEST_TOML + 1))} = 1", f"x = {{{'.'.join([part] * 20_000)} = 1}}"):
        with pytest.raises(ValueError, match=r"^the key .* has more than 10 parts$"):
            read(tmp_path, text)


@together("number", ["9{}", "0x{}", "-1{}", "0.{}", "1e{}"])
def test_a_number_has_three_hundred_digits_at_the_most(tmp_path: Path, number: str) -> None:
    assert read(tmp_path, f"x = {number.format('1' * (MOST_DIGITS - 2))}")
    for digits in ("1" * 100_000, "1_" * 50_000 + "1"):
        with pytest.raises(ValueError, match=r"^the number .* has more than 300 digits$"):
            read(tmp_path, f"x = {number.format(digits)}")


def test_a_list_of_points_is_no_key(tmp_path: Path) -> None:
    points = [[0.001 * k, 1.5] for k in range(10_000)]
    assert read(tmp_path, f"points = {points}")["points"] == points


def test_a_file_has_a_megabyte_at_the_most(tmp_path: Path) -> None:
    assert read(tmp_path, "x = 1".ljust(LARGEST_TOML)) == {"x": 1}
    with pytest.raises(ValueError, match=r"^1\.0 MB is too long; at most 1 MB$"):
        read(tmp_path, "x = 1".ljust(LARGEST_TOML + 1))


@together("text", ["x", "x = [", "x = '[", "\ud800", "i = 10\tr = 0.34", "i = 10 r\x07"])
def test_what_is_no_toml_is_said(tmp_path: Path, text: str) -> None:
    (tmp_path / "file.toml").write_bytes(text.encode("utf-8", "surrogatepass"))
    with pytest.raises(ValueError, match=r"^not TOML: [^;]+$"):
        toml_entries(tmp_path / "file.toml")
    with pytest.raises(ValueError, match=r'at line 2.*; a number with a unit stands in quotes, m = "1887 kg"$'):
        read(tmp_path, "r = 0.3\nm = 1887 kg  # of the data sheet")
    with pytest.raises(ValueError, match=r"^not TOML: [^;]+line 2[^;]+$"):
        read(tmp_path, "m = 1e3\nJ_1 = = 2")


@together("opens, closes", [("[", "]"), ("{a = ", "}"), ("[{a = ", "}]")])
def test_brackets_are_ten_deep_at_the_most(tmp_path: Path, opens: str, closes: str) -> None:
    pairs = DEEPEST_TOML // len(closes)
    assert read(tmp_path, f"x = {opens * pairs}{closes[:0] if '=' not in opens else '1'}{closes * pairs}")
    for count in (pairs + 1, 20_000):
        with pytest.raises(ValueError, match=r"^line 2 has brackets in brackets, more than 10 deep$"):
            read(tmp_path, f"y = 1\nx = {opens * count}")


@together("text", ['"""\n{}\\""" {}"""', "'''{}\\'''", '"{}\\""', "'{}'", '1 # " {}', "1 # {}"])
def test_brackets_in_texts_and_comments_are_none(tmp_path: Path, text: str) -> None:
    brackets = "[" * (DEEPEST_TOML + 1)
    assert "x" in read(tmp_path, f"x = {text.replace('{}', brackets)}\ny = [1]")


def test_what_is_no_file_is_said(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    for path, message in (
        (tmp_path, "it is a folder, not a file"),
        (tmp_path / "absent.toml", "there is no such file"),
        (pipe, "it is no regular file"),
    ):
        with pytest.raises(ValueError, match=f"^{message}$"):
            toml_entries(path)


@pytest.mark.skipif(sys.platform != "linux", reason="of Linux")
def test_a_file_of_no_size_that_waits_for_its_next_line_is_empty(tmp_path: Path) -> None:
    (tmp_path / "empty").touch()
    endless = Path("/proc/kmsg")
    assert toml_entries(endless) == {}
    assert digest(endless) == digest(tmp_path / "empty")
