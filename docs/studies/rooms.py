"""The rooms of the code in their order; `python -m docs.studies rooms` draws it for docs/architecture.md."""

from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from docs.studies.imports import ROOT, imports, source

ORDER = (
    "models.block",
    "models.physics",
    "models.controller",
    "models.comparators",
    "models",
    "fmus",
    "fmus.description",
    "fmus.native",
    "fmus.python",
    "fmus.target",
    "fmus.building",
    "harness.base",
    "harness.cosimulation",
    "harness.loop",
    "harness.recordings",
    "harness.manoeuvres",
    "harness.metrics",
    "harness.simulation",
    "harness.views",
    "harness.views.html",
    "harness.design",
    "harness.design.search",
    "harness.identification",
    "harness.studies.compare",
    "harness.studies.drives",
    "harness.studies.margins",
    "harness.studies.coupling",
    "harness.studies.back_to_back",
    "harness.studies.bound",
    "harness.studies.faults",
    "harness.studies.robustness",
    "harness.exchange.ssp",
    "harness.exchange.bus",
    "harness.exchange.target",
    "harness.exchange.compliance",
    "harness.explorer",
    "harness.commands",
    "docs.studies",
    "docs.site",
)
"""A room imports only from itself and from those before it; a folder that holds others is a room of its own."""


def modules() -> Iterator[str]:
    """Names of all modules in rooms, without that of the package `driveline`."""
    for folder in ("models", "fmus", "harness", "docs"):
        for path in sorted((ROOT / folder).rglob("*.py")):
            if path.name != "__init__.py":
                yield ".".join(path.relative_to(ROOT).with_suffix("").parts)


def room(module: str) -> str:
    """The room of a module; of something in a package's `__init__.py`, that package."""
    return module if source(module).with_suffix("").is_dir() else module.rpartition(".")[0]


def arrows() -> Counter[tuple[str, str]]:
    """How many modules of a room import from another: by the two rooms."""
    found = (
        (room(module), other)
        for module in modules()
        for other in {room(name) for name in imports(module)}
        if other in ORDER and other != room(module)
    )
    return Counter(found)


def lines() -> Counter[str]:
    """Lines of Python in each room."""
    return Counter(
        {
            name: sum(len(source(module).read_bytes().splitlines()) for module in modules() if room(module) == name)
            for name in ORDER
        }
    )


def make(folder: Path) -> None:
    from matplotlib import pyplot as plt
    from matplotlib import style

    from driveline.harness.views.colours import BLUE
    from driveline.harness.views.figure_style import STYLE

    counted, long = arrows(), lines()
    with style.context([STYLE, {"font.size": 7.0}]):
        figure, axes = plt.subplots(figsize=(7.6, 7.2), layout="constrained")
        for (above, below), count in counted.items():
            x, y = ORDER.index(below), ORDER.index(above)
            axes.scatter(x, y, s=12.0 + 6.0 * count, color=BLUE, zorder=2)
        places = range(len(ORDER))
        axes.plot(places, places, color="0.6", linewidth=0.8)
        axes.set_yticks(places, [f"{name.replace('.', '/')}  {long[name]}" for name in ORDER])
        axes.set_xticks(places, [name.replace(".", "/") for name in ORDER], rotation=90)
        axes.set_xlim(-0.7, len(ORDER) - 0.3)
        axes.set_ylim(len(ORDER) - 0.3, -0.7)
        axes.set_ylabel("room that imports, with its lines of Python")
        axes.set_xlabel("room that it imports from")
        axes.grid(linewidth=0.3)
        figure.savefig(folder / "rooms.png", dpi=150, metadata={"Software": None})
        plt.close(figure)
