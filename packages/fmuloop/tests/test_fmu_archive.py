"""Archives and model descriptions of strangers: one line that says what is wrong, and nothing is unpacked outside."""

import sys
from collections import Counter
from shutil import copyfile
from zipfile import ZIP_DEFLATED, ZipFile

import pytest
from fmutesting.foreign import tampered
from fmutesting.foreign.archives import HOSTILE
from fmutesting.foreign.stranger import build_stranger

from fmuloop import description, fmu_archive
from fmuloop.errors import WiringError
from fmuloop.experiment import Experiment
from fmuloop.interface import Interface
from fmuloop.limits import Limits
from fmuloop.runs import run
from fmuloop.system import System
from toolground.errors import UserError


@pytest.fixture(scope="module")
def stranger(tmp_path_factory):
    return build_stranger(tmp_path_factory.mktemp("stranger"))


@pytest.mark.parametrize("kind", HOSTILE)
def test_a_hostile_archive_is_named_and_not_unpacked(stranger, tmp_path, unpacked, kind):
    spoil, _, message = HOSTILE[kind]
    path = tmp_path / "hostile.fmu"
    copyfile(stranger, path)
    spoil(path)
    with pytest.raises(UserError, match=message) as error:
        run(System({"a": path}), Experiment(0.01))
    assert str(error.value).isprintable()
    assert "hostile.fmu" in str(error.value)
    assert list(unpacked.iterdir()) == []


def test_an_archive_may_unpack_to_the_limit_and_no_further(stranger, tmp_path):
    path = tmp_path / "bomb.fmu"
    copyfile(stranger, path)
    with ZipFile(path, "a", ZIP_DEFLATED) as archive:
        archive.writestr("resources/zeros", bytes(10**7))
    with ZipFile(path) as archive:
        size = sum(entry.file_size for entry in archive.infolist())
    Interface(path, Limits(unpacked=size))
    with pytest.raises(
        WiringError, match=rf"is not unpacked: it unpacks to {size / 1e6} MB; {(size - 1) / 1e6} MB are allowed"
    ):
        Interface(path, Limits(unpacked=size - 1))


SMALL = """<fmiModelDescription fmiVersion="3.0" modelName="m" instantiationToken="g">
<CoSimulation modelIdentifier="m"/>
<ModelVariables><Float64 name="velocity" valueReference="0" causality="output"/></ModelVariables>
<ModelStructure><Output valueReference="0" dependencies="0 0"/></ModelStructure></fmiModelDescription>"""


def written(path, xml, *others):
    with ZipFile(path, "w", ZIP_DEFLATED) as archive:
        for name in ("modelDescription.xml", *others):
            archive.writestr(name, xml)
    return path


@pytest.mark.parametrize(
    ("module", "limit", "most", "refusal"),
    [
        (fmu_archive, "LARGEST_DESCRIPTION", len(SMALL), r"modelDescription.xml unpacks to .* MB; .* MB are allowed"),
        (fmu_archive, "MOST_ENTRIES", 2, "it has 2 entries; 1 are allowed"),
        (fmu_archive, "LARGEST_DIRECTORY", 2 * 46 + len("modelDescription.xmlx"), "the list of its entries has .* MB"),
        (description, "MOST_PARTS", 6 + 9 + 1, "it has more than 15 elements, attributes and references"),
        (description, "LONGEST_ATTRIBUTE", len("velocity"), "name has 8 characters; 7 are allowed"),
        (description, "DEEPEST_XML", 3, "it has more than 2 elements in one another"),
    ],
)
def test_each_limit_is_reached_and_not_passed(tmp_path, monkeypatch, module, limit, most, refusal):
    monkeypatch.setattr(module, limit, most)
    Interface(written(tmp_path / "small.fmu", SMALL, "x"))
    monkeypatch.setattr(module, limit, most - 1)
    with pytest.raises(WiringError, match=refusal):
        Interface(written(tmp_path / "too_large.fmu", SMALL, "x"))


def test_the_time_for_a_description_grows_with_its_variables_alone(tmp_path):
    """A set of all references made for each output would be 4e6 calls."""
    many = "".join(f'<Float64 name="q{k}" valueReference="{k}" causality="output"/>' for k in range(1, 2000))
    listed = "".join(f'<Output valueReference="{k}" dependencies="0 {k}"/>' for k in range(1, 2000))
    wide = SMALL.replace("</ModelVariables>", f"{many}</ModelVariables>").replace("<Output", f"{listed}<Output")
    calls = Counter()
    sys.setprofile(lambda _, event, called: calls.update([called]) if event == "c_call" else None)
    try:
        assert len(Interface(written(tmp_path / "wide.fmu", wide)).variables) == 2000
    finally:
        sys.setprofile(None)
    assert calls.total() < 100 * 2000


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (' guid="stranger"', "", "has no guid"),
        (' fmiVersion="2.0"', "", "of FMI None"),
        (' modelIdentifier="stranger"', "", "has no modelIdentifier"),
        ('modelIdentifier="stranger"', 'modelIdentifier="../../bin/stranger"', r"modelIdentifier is '\.\./\.\./bin"),
        ('name="T_mot" ', "", "the variable number 1 has no name"),
        ('name="T_mot" valueReference="0"', 'name="T_mot"', "T_mot has no valueReference"),
        ('valueReference="0"', 'valueReference="zero"', "valueReference of T_mot is 'zero'"),
        ('valueReference="0"', 'valueReference="4294967296"', "valueReference of T_mot is '4294967296'"),
        ('<Real unit="N.m" start="0"/>', '<Real unit="N.m" start="none"/>', "start of T_mot is 'none'"),
        ('<Real unit="N.m" start="0"/>', '<Real unit="N.m" start="NaN"/>', "start of T_mot is 'NaN'"),
        ('<Real unit="N.m" start="0"/>', "", "T_mot has no type"),
        ('<Real unit="N.m" start="0"/>', '<Integer start="1.5"/>', "start of T_mot is '1.5'"),
        ('<Real unit="N.m" start="0"/>', '<Integer start="+-1"/>', r"start of T_mot is '\+-1'"),
        ('<Real unit="N.m" start="0"/>', '<Boolean start="maybe"/>', "start of T_mot is 'maybe'"),
        (
            '<Real unit="N.m" start="0"/>',
            '<Real declaredType="None"/>',
            r'declaredType="None" which has not been defined',
        ),
        ('stepSize="0.001"', 'stepSize="often"', "stepSize of DefaultExperiment is 'often'"),
        ('stepSize="0.001"', 'stepSize="0"', "stepSize of DefaultExperiment is '0'"),
        ('stepSize="0.001"', 'stepSize="1e999"', "stepSize of DefaultExperiment is '1e999'"),
        ('stopTime="0.2"', 'stopTime="1e999"', "stopTime of DefaultExperiment is '1e999'"),
        ('<Real unit="N.m" start="0"/>', '<Real unit="N.m" nominal="INF"/>', "nominal of T_mot is 'INF'"),
        (
            'index="12"',
            f'index="12" dependencies="{"9" * 5000}"',
            "dependencies of an Unknown in ModelStructure is '999",
        ),
        ('index="12"', 'index="600"', "index of an Unknown in ModelStructure is '600'; there are 18"),
        ("<ModelVariables>", "<ModelVariables", "cannot be read"),
        ("<fmiModelDescription", "<!DOCTYPE x><fmiModelDescription", "declares a document type"),
    ],
)
def test_a_description_that_cannot_be_used_is_named(stranger, tmp_path, old, new, message):
    path = tampered(stranger, tmp_path / "faulty.fmu", lambda xml: xml.replace(old, new, 1))
    with pytest.raises(WiringError, match=message) as error:
        Interface(path)
    assert "faulty.fmu" in str(error.value)
    assert str(error.value).isprintable()


def test_a_document_type_is_found_in_any_encoding_and_a_description_must_be_there(tmp_path):
    xml = '<?xml version="1.0" encoding="UTF-16"?><!DOCTYPE x [<!ENTITY y "z">]><fmiModelDescription guid="&y;"/>'
    with ZipFile(tmp_path / "faulty.fmu", "w") as archive:
        archive.writestr("modelDescription.xml", xml.encode("utf-16"))
    with pytest.raises(WiringError, match="declares a document type"):
        Interface(tmp_path / "faulty.fmu")
    with ZipFile(tmp_path / "empty.fmu", "w") as archive:
        archive.writestr("something.txt", "")
    with pytest.raises(WiringError, match=r"there is no modelDescription\.xml in it"):
        Interface(tmp_path / "empty.fmu")
