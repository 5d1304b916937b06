"""Which builds can be asked for."""

import pytest

from driveline.fmus.building.builds import build_fmus
from driveline.fmus.errors import BuildError


def test_a_platform_is_none_of_a_python_build(tmp_path):
    with pytest.raises(BuildError, match="--platform all is for native builds; a Python build runs wherever"):
        list(build_fmus((), tmp_path, "python", "all"))
    assert list(tmp_path.iterdir()) == []
