"""Archives and model descriptions of strangers: one line that says what is wrong, and nothing is unpacked outside."""

from shutil import copyfile
from zipfile import ZIP_DEFLATED, ZipFile

import pytest

from driveline.harness.base.errors import DrivelineError, WiringError
from driveline.harness.cosimulation import fmu_archive
from driveline.harness.cosimulation.experiment import Experiment
from driveline.harness.cosimulation.fmu_archive import described
from driveline.harness.cosimulation.interface import Interface
from driveline.harness.cosimulation.limits import Limits
from driveline.harness.cosimulation.runs import run
from driveline.harness.cosimulation.system import System
from tests.foreign import tampered
from tests.foreign.archives import HOSTILE
from tests.foreign.stranger import build_stranger


@pytest.fixture(scope="module")
def stranger(tmp_path_factory):
    return build_stranger(tmp_path_factory.mktemp("stranger"))


@pytest.mark.parametrize("kind", HOSTILE)
def test_a_hostile_archive_is_named_and_not_unpacked(stranger, tmp_path, unpacked, kind):
    spoil, _, message = HOSTILE[kind]
    path = tmp_path / "hostile.fmu"
    copyfile(stranger, path)
    spoil(path)
    with pytest.raises(DrivelineError, match=message) as error:
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


def test_a_model_description_has_so_many_bytes_at_the_most(stranger, monkeypatch):
    size = len(described(stranger))
    monkeypatch.setattr(fmu_archive, "LARGEST_DESCRIPTION", size)
    assert len(described(stranger)) == size
    monkeypatch.setattr(fmu_archive, "LARGEST_DESCRIPTION", size - 1)
    with pytest.raises(WiringError, match=rf"modelDescription.xml has {size / 1e6} MB$"):
        described(stranger)


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


def test_a_document_type_is_found_in_any_encoding(tmp_path):
    xml = '<?xml version="1.0" encoding="UTF-16"?><!DOCTYPE x [<!ENTITY y "z">]><fmiModelDescription guid="&y;"/>'
    with ZipFile(tmp_path / "faulty.fmu", "w") as archive:
        archive.writestr("modelDescription.xml", xml.encode("utf-16"))
    with pytest.raises(WiringError, match="declares a document type"):
        Interface(tmp_path / "faulty.fmu")


def test_an_archive_without_a_description_is_none(tmp_path):
    with ZipFile(tmp_path / "empty.fmu", "w") as archive:
        archive.writestr("something.txt", "")
    with pytest.raises(WiringError, match=r"there is no modelDescription\.xml in it"):
        Interface(tmp_path / "empty.fmu")
