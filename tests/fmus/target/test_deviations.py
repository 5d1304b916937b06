"""What is found in the C of the target has a written reason, and every reason is needed."""

import shutil

import pytest
from fmutesting.skipping import skipped_if_impossible

from docs.studies.target_deviations import CHECKER, DEVIATIONS, GENERATED, Finding, findings, reason
from driveline.fmus.catalogue import CONTROLLERS
from fmublocks.native.compiler import CompilerError
from fmublocks.native.statements import SINGLE
from fmublocks.target.image import require_packages
from fmublocks.target.sources import target_sources

SOURCES = target_sources(CONTROLLERS["DampingController"], SINGLE)


@pytest.fixture(scope="module")
def _checkable() -> None:
    with skipped_if_impossible():
        require_packages(CHECKER)


@pytest.mark.slow
@pytest.mark.usefixtures("_checkable")
def test_every_finding_has_a_written_reason_and_every_reason_a_finding() -> None:
    found = findings(SOURCES)
    assert not [each for each in found if reason(each) is None]
    places = {(each.rule, each.file) for each in found}
    assert places == {(each.rule, file) for each in DEVIATIONS for file in each.files}


@pytest.mark.slow
@pytest.mark.usefixtures("_checkable")
def test_what_breaks_a_rule_is_found_and_has_no_reason() -> None:
    bad = "static float f(float a, int b) { float x[100]; x[0] = a; return a + x[0] * (float)b; }"
    text = SOURCES["damping_controller.c"].replace("#include <math.h>", f"#include <math.h>\n{bad}")
    rules = {each.rule for each in findings({**SOURCES, "damping_controller.c": text}) if reason(each) is None}
    assert "12.1" in rules


def test_a_reason_is_for_its_rule_and_files_alone() -> None:
    assert reason(Finding("-Wfloat-equal", GENERATED, "damping_controller.c:1"))
    assert reason(Finding("-Wfloat-equal", "link.c", "link.c:1")) is None
    assert reason(Finding("-Wstack-usage", GENERATED, "damping_controller.c:1")) is None


def test_without_the_checker_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    which = shutil.which
    monkeypatch.setattr(shutil, "which", lambda name: None if name == CHECKER else which(name))
    with pytest.raises(CompilerError, match=r"cppcheck: apt-get install .* cppcheck"):
        findings(SOURCES)
