"""The functions of a block, compiled from block.c alone and called with flat lists of numbers."""

import ctypes
import subprocess

from fmublocks.native.compiler import host_compiler
from fmublocks.native.packaging import C_FILES
from fmublocks.native.source import block_sources
from fmublocks.native.trace import trace

EXPORTED = """
__attribute__((visibility("default"))) void *address_of_{name}(void);
void *address_of_{name}(void) {{ return (void *)(size_t)&{name}; }}
"""

ROOM = 200
"""Numbers behind the parameters for what depends on them alone."""


class Functions:
    """Calls `derivative`, `output` and so on by name, as C computes them."""

    def __init__(self, fmu, folder):
        sources = block_sources(fmu) | {"operators.h": (C_FILES / "operators.h").read_text()}
        traced = trace(fmu.block)
        self._sizes = {function.name: len(function.values) for function in traced}
        self._parameters = {function.name: function.arguments.index("p") for function in traced}
        exported = "".join(EXPORTED.format(name=name) for name in (*self._sizes, "compute_terms"))
        sources["exported.c"] = f'#include "block.c"\n#include <stddef.h>\n{exported}'
        for name, text in sources.items():
            (folder / name).write_text(text)
        command = [host_compiler(), "-std=c99", "-O2", "-ffp-contract=off", "-shared", "-fPIC", "-o", "block.so"]
        subprocess.run([*command, "exported.c", "-lm"], cwd=folder, check=True)
        self._library = ctypes.CDLL(str(folder / "block.so"))

    def __call__(self, name, *arguments):
        vectors = [(ctypes.c_double * (len(a) + ROOM))(*map(float, a)) for a in arguments]
        self._address("compute_terms", 1)(vectors[self._parameters[name]])
        result = (ctypes.c_double * self._sizes[name])()
        self._address(name, len(vectors) + 1)(*vectors, result)
        return list(result)

    def _address(self, name, arguments):
        address = self._library[f"address_of_{name}"]
        address.restype = ctypes.c_void_p
        return ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * arguments)(address())
