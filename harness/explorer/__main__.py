"""Makes the module of all loops of the project for a package: `python -m driveline.harness.explorer`."""

from .module import PACKAGED, write_standard

if __name__ == "__main__":
    write_standard()
    print(PACKAGED)
