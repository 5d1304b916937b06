"""The page docs/target.md."""

from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from ....fmus.target.deviations import LARGEST_STACK, Finding, reason
from ....fmus.target.image import CODE, PACKAGES, PROCESSOR
from ....fmus.target.link import LIMIT
from ...loop.places import T_S
from ...manoeuvres.catalogue import USUAL_MANOEUVRES
from ...views.markdown import markdown_table
from .comparison import ABSOLUTE, RELATIVE, Comparison
from .in_loop import InLoop
from .offline_cases import WIDER
from .offline_results import TYPICAL, Part, Record
from .size import Size

CLOCK = 120e6
"""In Hz, of the part of which the share of a period is told."""

PAGE = Path(__file__).with_suffix(".md").read_text(encoding="utf-8")

IDENTITY = """\
In all {samples} samples of all cases outputs and states are the same bits as those of the same C in single precision on
this machine. Contraction to fused multiply-add is switched off on both (`-ffp-contract=off`)."""

DIFFERENT = """\
In {differing} of {samples} samples a bit of outputs or state differs from the same C in single precision on this
machine, first in {first}."""


def page(found: Record, controller: str, plant: str) -> str:
    """The page as Markdown."""
    comparisons, schedule, size = found.comparisons, found.schedule, found.size
    samples = sum(len(each.case.inputs) for each in comparisons)
    differing = [each for each in comparisons if each.differing]
    identity = IDENTITY.format(samples=samples)
    if differing:
        count = sum(each.differing for each in differing)
        identity = DIFFERENT.format(differing=count, samples=samples, first=differing[0].case.name)
    return PAGE.format(
        packages=" ".join(PACKAGES),
        period=T_S * 1e3,
        controller=controller,
        plant=plant,
        manoeuvres=len(USUAL_MANOEUVRES),
        wider=WIDER,
        compiler="arm-none-eabi-gcc",
        flags=" ".join((*PROCESSOR, *CODE)),
        identity=identity,
        cases=cases_table(comparisons),
        absolute=ABSOLUTE,
        relative=RELATIVE,
        loops=loops_table(found.loops),
        limit=LIMIT,
        schedule=schedule,
        kept=f"{schedule.samples - schedule.missed} of {schedule.samples}",
        latency=f"{schedule.latency / schedule.period:.1%}",
        response=f"{schedule.response / schedule.period:.1%}",
        costs=costs_table(comparisons, size),
        typical=TYPICAL,
        parts=parts_table(found.parts),
        stack=LARGEST_STACK,
        deviations=deviations_table(found.findings),
        clock=CLOCK / 1e6,
        library=" and ".join(f"`{name}`" for name in size.library) or "nothing",
    )


def cases_table(comparisons: Sequence[Comparison]) -> str:
    """What each case gave."""
    headings = (
        "case",
        "samples",
        "samples with a differing bit",
        "`T_ref` off by (N·m)",
        "of the allowed",
        "`T_gear_hat` off by (N·m)",
    )
    headings += ("largest `T_ref` (N·m)", "instructions, mean", "most")
    rows = [
        (
            each.case.name,
            f"{len(each.case.inputs)}",
            f"{each.differing}",
            f"{each.T_ref:.1g}",
            f"{each.margin:.0%}",
            f"{each.T_gear_hat:.1g}",
            f"{each.largest:.0f}",
            f"{each.instructions[0]:.0f}",
            f"{each.instructions[1]}",
        )
        for each in comparisons
    ]
    return markdown_table(headings, rows, 1)


def loops_table(loops: Sequence[InLoop]) -> str:
    """What each manoeuvre gave in the loop."""
    headings = ("manoeuvre", "differing", "`T_ref` off by (N·m)", "rms", "`T_gear` off by (N·m)")
    rows = [
        (each.manoeuvre, f"{each.differing}", *(f"{value:.1g}" for value in (each.T_ref, each.rms, each.T_gear)))
        for each in loops
    ]
    return markdown_table(headings, rows, 1)


def costs_table(comparisons: Sequence[Comparison], size: Size) -> str:
    """What the controller takes."""
    most, drawn = (
        max(each.instructions[1] for each in comparisons if each.case.drawn is is_drawn) for is_drawn in (False, True)
    )
    rows = [
        ("instructions a sample, the most in manoeuvres and drives", f"{most}"),
        ("the most from inputs and states drawn at random", f"{drawn}"),
        ("share of the period", f"{max(most, drawn) / (T_S * CLOCK):.2%}"),
        ("flash of the controller", f"{size.flash} B"),
        ("flash of the image", f"{size.image} B"),
        ("RAM", f"{size.ram} B"),
        ("parameters, if in RAM", f"{size.calibration} B"),
        ("stack, as compiled", f"{size.stack} B"),
        ("stack, as used", f"{max(each.stack for each in comparisons)} B"),
    ]
    return markdown_table(("", "takes"), rows, 1)


def parts_table(parts: Sequence[Part]) -> str:
    """What controllers with less under the same supervision take."""
    rows = [(each.controller, f"{each.instructions}", f"{each.flash} B") for each in parts]
    return markdown_table(("controller", "instructions, the most", "flash"), rows, 1)


def deviations_table(findings: Sequence[Finding]) -> str:
    """What is found in the C, and why it stays."""
    counts = Counter((each.rule, each.file, reason(each) or "") for each in findings)
    rows = [(rule, f"{count}", file, why) for (rule, file, why), count in sorted(counts.items())]
    return markdown_table(("rule", "found", "where", "why"), rows, 0)
