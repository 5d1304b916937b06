"""Which release this is."""

import ast
from pathlib import Path

from driveline.fmus import release


def test_the_installer_reads_the_version_without_running_anything():
    assignments = [node for node in ast.parse(Path(release.__file__).read_text()).body if isinstance(node, ast.Assign)]
    found = [node.value for node in assignments if [ast.unparse(target) for target in node.targets] == ["VERSION"]]
    assert [ast.literal_eval(value) for value in found] == [release.VERSION]
