"""Verdicts as JUnit XML, which CI servers show."""

from collections.abc import Iterable, Mapping
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from .rule import Verdict


def junit(verdicts_of: Mapping[str, Iterable[Verdict]], failing: Iterable[str]) -> str:
    """A test suite for each FMU and a test case for each rule.

    Args:
        found: file of the FMU -> verdicts.
        failing: severities of the rules that count as failed; what the others find is output of their test case.
    """
    failing = set(failing)
    root = Element("testsuites", name="driveline check")
    for name, verdicts in verdicts_of.items():
        suite = SubElement(root, "testsuite", name=name)
        tests = [_test_case(suite, name, verdict, verdict.severity in failing) for verdict in verdicts]
        suite.set("tests", str(len(tests)))
        suite.set("failures", str(sum(tests)))
        suite.set("skipped", str(len(suite.findall("testcase/skipped"))))
    indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + tostring(root, encoding="unicode")


def _test_case(suite: Element, name: str, verdict: Verdict, fails: bool) -> bool:
    case = SubElement(suite, "testcase", classname=name, name=f"{verdict.rule}: {verdict.title}")
    text = "\n".join(verdict.problems)
    if not verdict.tried:
        SubElement(case, "skipped", message="not tried")
    elif verdict.problems and fails:
        SubElement(case, "failure", message=verdict.problems[0], type=verdict.severity).text = text
    elif verdict.problems:
        SubElement(case, "system-out").text = f"{verdict.severity}:\n{text}"
    return bool(verdict.problems and fails)
