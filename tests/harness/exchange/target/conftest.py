"""The emulated target: skipped where its packages are not installed; `make test-target` asks for them."""

from collections.abc import Iterator

import pytest

pytest.importorskip("casadi", reason="the extra `native` is not installed")

from driveline.fmus.native.compiler import CompilerError
from driveline.fmus.target.image import require_packages
from driveline.harness.exchange.target.programs import Programs, programs


@pytest.fixture(scope="session")
def target() -> Iterator[Programs]:
    """Our controller on the emulated target and on this machine."""
    try:
        require_packages()
    except CompilerError as reason:
        pytest.skip(str(reason))
    with programs("DampingController", {}) as made:
        yield made
