"""The package in an FMU has the name of its content."""

from itertools import combinations

from driveline.fmus.catalogue import FMUS
from driveline.fmus.python.bundle import package_name


def test_packages_with_other_files_have_other_names() -> None:
    """Wherever one file ends and the next begins."""
    fmu = FMUS["DampingController"]
    contents = [
        {},
        {"a.py": b"1"},
        {"a.py": b"2"},
        {"b.py": b"1"},
        {"a.py": b"1", "b.py": b""},
        {"a.py": b"1\0b.py\x000\0"},
    ]
    names = [package_name(fmu, content) for content in contents]
    assert all(one != other for one, other in combinations(names, 2))
    assert package_name(fmu, {"b.py": b"2", "a.py": b"1"}) == package_name(fmu, {"a.py": b"1", "b.py": b"2"})
