"""What a command that builds FMUs can be given, and what it says of those that it has built."""

from collections.abc import Generator
from contextlib import closing
from pathlib import Path

from toolground.argument_types import output_folder
from toolground.arguments import option, record
from toolground.atomic_files import unchanged_if_stopped
from toolground.printing import Printing

from ..builds import BUILDS, FMI3_FOLDER, FMIS, PLATFORMS
from ..origin import NATIVE_FOLDER


@record
class BuildOptions(Printing):
    """Which builds, and where they go."""

    build: str | None = option(None, "which build (default: each that is possible here)", choices=BUILDS)
    platform: str = option("host", "of the native build (default: %(default)s)", choices=PLATFORMS)
    fmi: str = option(str(FMIS[0]), "2.0 or 3.0 (default: %(default)s)", choices=[str(fmi) for fmi in FMIS])
    output: Path = option(Path("build"), "(default: %(default)s)", output_folder, metavar="FOLDER")

    def write(self, built: Generator[Path, None, None]) -> None:
        """Builds the FMUs and says how large they are; stopped, it leaves what was there before."""
        folders = (self.output / folder for folder in ("", NATIVE_FOLDER, FMI3_FOLDER))
        paths: list[Path] = []
        try:
            with unchanged_if_stopped("*.fmu", *folders), closing(built):
                paths.extend(built)
        except KeyboardInterrupt:
            paths.clear()
            raise
        finally:  # of one that cannot be built the others stay
            for path in paths:
                self.say(f"{path}  {path.stat().st_size / 1024:.0f} kB")
