"""The table of the main job, and the files."""

import csv
import io
import math
import os
import re
from errno import ENOSPC
from pathlib import Path

import pytest
from rich.console import Console
from rich.table import Table

from driveline.harness.commands.settings import dampings
from driveline.harness.metrics.declaration import declared
from driveline.harness.metrics.run_metrics import Metrics, RideMetrics
from driveline.harness.views.metrics_table import (
    SHOWN,
    Row,
    cells,
    legend,
    reasons,
    values,
    write_markdown,
    write_metrics,
)
from driveline.harness.views.terminal import rides_reasons, rides_table, runs_table
from toolground.atomic_files import complete, remove, write_text
from toolground.plain_text import reason
from toolground.tables import plain_table, print_table


def metrics(absent=None, **values):
    return Metrics(
        **(dict.fromkeys((metric.name for metric in declared(Metrics)), math.nan) | values), absent=absent or {}
    )


OFF = Row(
    "Plant",
    "tipin15",
    "off",
    metrics(settling_time=1.758, overshoot=1.16, gear_torque_rms=26.5, stationary_torque_change=-1e-9),
)
WHY = {"response_delay": "no step", "overshoot": "no step"}
ON = Row("Plant", "tipin15", "on", metrics(settling_time=0.114, withheld_time=0.012, absent=WHY))


def shown(row):
    return dict(zip([metric.name for metric, _ in SHOWN], cells(row)[2:], strict=True))


def printed(table):
    text = io.StringIO()
    Console(width=200, file=text).print(table)
    return text.getvalue()


def test_a_row_shows_milliseconds_and_percent():
    found = shown(OFF)
    assert (found["settling_time"], found["overshoot"], found["gear_torque_rms"]) == ("1758", "116", "26.5")
    assert cells(ON)[:2] == ["tipin15", "on"]


def test_what_has_no_meaning_is_a_dash_and_a_rounded_zero_has_no_sign():
    found = shown(OFF)
    assert found["response_delay"] == "-"
    assert found["stationary_torque_change"] == "0.00"


def test_below_a_table_stands_why_it_has_dashes(tmp_path):
    assert reasons([OFF, ON]) == ["- overshoot, delay to 90 %: no step (Plant tipin15 on)"]
    both = [row._replace(metrics=metrics(absent=WHY)) for row in (OFF, ON)]
    assert reasons(both) == ["- overshoot, delay to 90 %: no step (tipin15)"]
    write_markdown(both, tmp_path / "table.md")
    assert (tmp_path / "table.md").read_text(encoding="utf-8").split("\n\n")[1] == reasons(both)[0]


def test_a_ride_without_damage_has_a_dash_and_no_ratio():
    off, on = RideMetrics(2.0, math.nan, 4.0, 0.0, {"gear_damage": "not finite"}), RideMetrics(1.0, 1.0, 3.0, 0.5)
    rides = {"without damping": off, "mine": on}
    lines = [line.split() for line in printed(rides_table(rides, "a drive")).splitlines()]
    assert [line for line in lines if "mine" in line or "without" in line] == [
        ["without", "damping", "2", "(1.000)", "-", "4", "(1.000)", "0", "(-)"],
        ["mine", "1", "(0.500)", "1", "(-)", "3", "(0.750)", "1.8", "(-)"],  # km/h
    ]
    assert rides_reasons(rides) == ["- gear damage: not finite (without damping)"]


def test_the_terminal_table_names_plant_units_and_runs():
    text = printed(runs_table([OFF, ON]))
    assert all(part in text for part in ("Plant", "tipin15", "ms", "N·m", "1758", "114"))


def test_the_title_names_a_controller_that_is_not_the_usual_one(tmp_path):
    title = dampings(["SpeedWashout"])
    assert title.endswith(" by SpeedWashout")
    assert printed(runs_table([OFF, ON], title)).splitlines()[0].strip() == title
    write_markdown([OFF, ON], tmp_path / "table.md", title)
    assert (tmp_path / "table.md").read_text(encoding="utf-8").splitlines()[0] == title
    assert " by " not in dampings(["DampingController"])
    assert dampings(["DampingController", "SpeedWashout"]) == "without damping (off) and with each controller"


def test_rides_stand_one_below_the_other_with_their_ratio_to_the_first():
    rides = {"none": RideMetrics(2.0, 32.0, 4.0, 0.5)} | dict.fromkeys("ab", RideMetrics(1.0, 1.0, 3.0, 0.5))
    lines = printed(rides_table(rides, "a drive")).splitlines()
    assert lines[0].strip() == "a drive"
    assert [line.split()[1:5] for line in lines if line.startswith(("  a ", "  b "))] == [
        ["1", "(0.500)", "1", "(0.031)"]
    ] * 2


@pytest.mark.parametrize("record", [Metrics, RideMetrics])
def test_the_legend_explains_every_column(record):
    text = " ".join(legend(record).split())
    for metric in declared(record):
        assert metric.column is None or f"{metric.column.plain_heading} {metric.description}" in text


def test_markdown_has_one_line_a_run_and_explains_every_metric(tmp_path):
    path = tmp_path / "table.md"
    write_markdown([OFF, ON], path)
    table, *_, meanings = path.read_text(encoding="utf-8").split("\n\n")
    assert len(table.splitlines()) == 4
    assert len({line.count("|") for line in table.splitlines()}) == 1
    for metric in declared(Metrics):
        assert f"`{metric.key}` | {metric.description} |" in meanings


def test_the_csv_file_has_all_metrics_in_si_units(tmp_path):
    path = tmp_path / "metrics.csv"
    write_metrics([{"control": row.control, **values(row.metrics)} for row in (OFF, ON)], path)
    with path.open(newline="", encoding="utf-8") as file:
        off, on = csv.DictReader(file)
    assert float(off["settling_time_s"]) == 1.758
    assert off["response_delay_s"] == ""
    assert (on["control"], float(on["withheld_time_s"])) == ("1", 0.012)
    assert set(off) == {"control", "absent", *(metric.key for metric in declared(Metrics))}
    assert on["absent"] == "overshoot_1, response_delay_s: no step"
    assert {"overshoot_1", "impact_speed_rad_per_s", "jerk_rms_m_per_s3", "gear_torque_rms_N_m"} <= set(off)


def interrupted(path):
    with complete(path) as unfinished:
        unfinished.write_text("new")
        raise KeyboardInterrupt


def test_a_file_that_is_not_finished_leaves_the_old_one_and_nothing_else(tmp_path):
    path = tmp_path / "results" / "table.md"
    with complete(path) as unfinished:
        unfinished.write_text("old")
    with pytest.raises(KeyboardInterrupt):
        interrupted(path)
    assert [file.read_text() for file in path.parent.iterdir()] == ["old"]


def test_a_link_stays_one_and_its_file_is_replaced(tmp_path):
    (tmp_path / "link.csv").symlink_to(tmp_path / "file.csv")
    for text in ("old", "new"):
        write_text(text, tmp_path / "link.csv")
        assert (tmp_path / "link.csv").is_symlink()
        assert (tmp_path / "file.csv").read_text() == text


def test_what_is_no_regular_file_is_written_to_and_not_replaced(tmp_path):
    pipe = tmp_path / "signals.csv"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    write_text("new", pipe)
    assert (os.read(reader, 10), pipe.is_fifo()) == (b"new", True)
    os.close(reader)
    with complete(Path(os.devnull)) as unfinished:
        assert str(unfinished) == os.devnull


def test_a_pipe_that_nobody_reads_is_refused_and_not_waited_for(tmp_path):
    pipe = tmp_path / "signals.csv"
    os.mkfifo(pipe)
    with pytest.raises(OSError, match="nobody reads") as refusal:
        write_text("new", pipe)
    assert reason(refusal.value) == f"{pipe}: it is a pipe that nobody reads"
    assert pipe.is_fifo()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no device that is always full")
def test_what_cannot_be_written_is_told_in_words_with_the_name_that_was_asked_for(tmp_path):
    (tmp_path / "full.csv").symlink_to("/dev/full")
    for path, words in (
        (tmp_path / "full.csv", "No space left on device"),
        (Path("/proc/new.csv"), "No such file or directory"),
    ):
        with pytest.raises(OSError, match=words) as refusal:
            write_text("new", path)
        assert reason(refusal.value) == f"{path}: {words}"


def test_a_disk_that_is_full_is_told_with_the_file_and_not_the_unfinished_one(tmp_path):
    for name in (None, "unfinished"):
        with pytest.raises(OSError, match="No space") as refusal, complete(tmp_path / "signals.csv") as unfinished:
            raise OSError(ENOSPC, "No space left on device", name and str(unfinished))
        assert reason(refusal.value) == f"{tmp_path / 'signals.csv'}: No space left on device"
    with pytest.raises(FileNotFoundError, match="other"), complete(tmp_path / "signals.csv"):
        (tmp_path / "other").read_bytes()
    assert list(tmp_path.iterdir()) == []


def test_only_files_are_removed_before_new_ones_come(tmp_path):
    file, link, pipe = tmp_path / "file", tmp_path / "link", tmp_path / "pipe"
    file.touch()
    link.symlink_to(file)
    os.mkfifo(pipe)
    (tmp_path / "null").symlink_to(os.devnull)
    for path in (link, pipe, tmp_path / "null", tmp_path / "nothing"):
        remove(path)
    assert not file.exists()
    assert {path.name for path in tmp_path.iterdir()} == {"link", "pipe", "null"}
    assert Path(os.devnull).exists()


def test_a_folder_is_not_written_to_as_a_file(tmp_path):
    for folder in (tmp_path, Path()):
        with pytest.raises(IsADirectoryError, match="is a folder"):
            write_text("k_d = 1\n", folder)


def _on_a_terminal(width, table, monkeypatch, capsys):
    for name, value in {"COLUMNS": str(width), "TTY_COMPATIBLE": "1", "TERM": "xterm"}.items():
        monkeypatch.setenv(name, value)
    print_table(table)
    return re.sub(r"\x1b\[[0-9;]*m", "", capsys.readouterr().out).splitlines()


def _words(lines):
    return {word for line in lines for word in line.split() if "─" not in word}


def test_a_narrow_terminal_shows_a_wide_table_in_parts_with_whole_words(monkeypatch, capsys):
    whole = printed(runs_table([OFF, ON])).splitlines()
    lines = _on_a_terminal(60, runs_table([OFF, ON]), monkeypatch, capsys)
    assert max(map(len, lines)) <= 60 < max(map(len, whole))
    assert _words(lines) == _words(whole)
    parts = [line.split() for line in lines if " on " in line and "tipin" in line]
    assert len(parts) > 1
    assert all(part[:2] == cells(ON)[:2] for part in parts)
    assert [word for part in parts for word in part[2:]] == cells(ON)[2:]


def test_each_part_of_a_table_says_what_its_rows_are(monkeypatch, capsys):
    rows = [["car", speed, *["1.234567"] * 12] for speed in ("5", "15")]
    table = plain_table("margins", ["plant", "speed", *(f"value {k}" for k in range(12))], rows, labels=2)
    lines = [line.split() for line in _on_a_terminal(60, table, monkeypatch, capsys) if "car" in line]
    assert len(lines) > 2
    assert [line[1] for line in lines] == ["5", "15"] * (len(lines) // 2)


def test_no_heading_is_broken_where_a_table_is_shown_in_parts(monkeypatch, capsys):
    headings = [f"time of run {k}" for k in range(10, 22)]
    lines = _on_a_terminal(60, plain_table("times", ["car", *headings], [["van", *"1" * 12]]), monkeypatch, capsys)
    assert all(any(heading in line for line in lines) for heading in headings)


def test_a_terminal_that_is_wide_enough_shows_a_table_whole(monkeypatch, capsys):
    whole = printed(runs_table([OFF, ON])).splitlines()
    assert _on_a_terminal(max(map(len, whole)), runs_table([OFF, ON]), monkeypatch, capsys) == whole


def test_a_text_is_broken_between_words_before_a_table_is_parted(monkeypatch, capsys):
    table = Table("judge")
    table.add_column("measured", justify="right")
    table.add_column("what it measures")
    table.add_row("limited", "-72", "torque demanded beyond the largest of the motor, whatever its sign")
    lines = _on_a_terminal(60, table, monkeypatch, capsys)
    assert sum("limited" in line for line in lines) == 1
    assert max(map(len, lines)) <= 60
