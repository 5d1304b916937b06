"""What pyproject.toml cannot declare: the library that makes the steps of the master has the digest of its source."""

from hashlib import sha256
from pathlib import Path

from setuptools import Extension, setup

SOURCE = "src/fmuloop/steps.c"

setup(
    ext_modules=[
        Extension(
            "fmuloop._steps",
            [SOURCE],
            define_macros=[("DIGEST", f'"{sha256((Path(__file__).parent / SOURCE).read_bytes()).hexdigest()}"')],
            extra_compile_args=["-ffp-contract=off"],  # the same bits as in Python
            optional=True,  # without a C compiler the master makes its steps in Python
        )
    ]
)
