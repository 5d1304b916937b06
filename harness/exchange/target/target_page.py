"""The page docs/target.md."""

from collections import Counter
from collections.abc import Sequence

from ....fmus.target.deviations import LARGEST_STACK, Finding, reason
from ....fmus.target.image import CODE, PACKAGES, PROCESSOR
from ....fmus.target.link import LIMIT
from ...manoeuvres.catalogue import MANOEUVRES
from ...metrics.evaluate import T_S
from ...views.markdown import markdown_table
from .comparison import ABSOLUTE, RELATIVE, Comparison
from .in_loop import InLoop
from .offline_cases import WIDER
from .offline_results import TYPICAL, Part, Record
from .size import Size

CLOCK = 120e6
"""In Hz, of the part of which the share of a period is told."""

PAGE = """\
# The controller on a processor

```sh
driveline target export                                              # its C in single precision, into build/target
driveline target export --precision double --output build/double
driveline target export --vehicle car.toml --parameters gains.toml   # for a car, see control.md
driveline target export --controller SpeedWashout                    # any controller of the catalogue
driveline target build                                               # its FMU, on an emulated Cortex-M4F
driveline target image                                               # that image, and its A2L description
driveline target record                                              # off-line and in the loop, compared
```

The last three need a compiler for the target and an emulator,
`apt-get install {packages}`. `make test-target` runs all tests that do.

## The C

`damping_controller.h` and `damping_controller.c` are C99 that needs `fabsf` and `sqrtf` of the library, allocates
nothing, has no global variable and no loop. It is the same traced arithmetic as in the FMU. `controller.h` has the same
under names that do not tell which controller it is. A project calls it so, the last part every {period:g} ms:

```c
static DampingControllerState states[2], *x = &states[0], *next = &states[1];

/* once, with the first inputs */
damping_controller_start(&u, &damping_controller_parameters, x);

/* at each sample, u holding what was measured */
damping_controller_output(x, &u, &damping_controller_parameters, &y); /* y.T_ref for the motor, by the sample before */
damping_controller_update(x, &u, &damping_controller_parameters, next);
DampingControllerState *past = x;
x = next;
next = past;
```

Parameters are declared in the header with units and meanings; a project with other values passes its own record.
Measurements that are lost may be NaN, so do not compile with `-ffast-math`. The counter of the messages only has to
change from one to the next; it is a `float` too, so let it wrap before 2^24.

## Off-line on the target

`driveline target record` is the paper's second test of the software: the C runs in its embedded environment, its
responses to recorded and artificial inputs are recorded and compared. {controller} is compiled with `{compiler}` for a
Cortex-M4F (`{flags}`)
and runs in QEMU, machine `mps2-an386`. It is fed with what the controller got in the loop on {plant}, sample by
sample, in {manoeuvres} manoeuvres and on the recorded drive `town_drive`; then with inputs drawn at random from their
ranges, with NaN, infinities, denormal and huge numbers among these, and from random states out of {wider:g} times
the range in which they were.

{identity}

![torque reference of target and model](figures/target.png)

{cases}

Distances are those from the C in double precision on this machine, which is the model. At every sample `T_ref` is
allowed {absolute:g} N·m + {relative:g} |`T_ref`|; "of the allowed" is the largest share of that. In `launch_brake` the
teeth float in the gap for seconds under the brakes, where no measurement corrects the twist; what its rounding adds up
to is small, as the estimated speeds are counted from the measured one ([derivation.md](derivation.md#prediction)). A
fault may be recognised one sample earlier or later than in double precision, as times are added up sample by sample.
That is also why a comparator can be further off: `SpeedDifference` is up to 0.08 N·m in `creep` and `launch_brake`. Its
fallback ends one sample later in single precision, where 75 times 0.002 s are a little less than `t_proof`, and so its
damping fades in one sample later.

## In the loop on the target

`driveline target build` writes an ordinary controller FMU, `build/on_target/DampingController.fmu`, with the image in
it. Its start, update and outputs are computed on an emulator of its own for every instance. It takes the place of the
ordinary one in any host that runs Python, as in
`driveline simulate --controller build/on_target/DampingController.fmu`, and has saved states, parameters and all else
of it; the rest of the loop is unchanged. The state stays on the target, and is sent there when another one is restored.

{loops}

"Differing" are the samples in which `T_ref` is not, bit by bit, what the same C on this machine makes of the same
inputs off-line. The distances are those from the loop with the model in double precision. The measured motor speed is
rounded by the resolver; where a difference of 1e-5 N·m falls on the edge of one of its steps, the two loops go on with
another measurement. In `prbs` and `prbs15`, where the teeth land at every pulse, a landing then comes a sample earlier
or later, and for that sample the torques are far apart.

A target that does not answer within {limit:g} s, is lost or has a fault of the processor ends the run with an error
that names it, and no process is left, even if the host is killed. The link is semihosting on two pipes. An exchange
with inputs, outputs and the whole state takes about 0.15 ms: 20 s of `drive` took 3.6 s with `driveline simulate`,
5.6 times faster than real time.

## What it takes

{costs}

Instructions are those of `update` and `output` of a sample, counted by the emulator (`-icount`), the most in all cases.
The share is that of a period of {period:g} ms on a part of {clock:g} MHz, if each took one cycle; on a real one loads,
branches, divisions and square roots take more, and so does flash that waits. RAM is two states, inputs and outputs; the
parameters may stay in flash. The stack is what the compiler says of the hungriest function, none of which calls
another, and what was found overwritten with the caller's part. The image calls {library} of the C library, to copy and
to clear, and nothing else.

### Where it goes

{parts}

These are the most in `{typical}`. `NoDamping` is the supervision alone: its checks of the motor signals, of the
messages and of their direction, the trust in them, rest and limits. `LinearObserver` adds an estimator, `PaperObserver`
one that knows the gap; ours adds the prediction and the landing. The supervision of the signals alone takes most of
1000 instructions and of 6 kB, so neither is reached with an estimator beside it. A comparison of two numbers and what
depends on it is about four instructions on this processor (compare, fetch the flags, branch or conditional move, the
value), and a sample makes about 150. Of its operations 76 depend on parameters alone; they are made at every sample all
the same, so that there is nothing to bring up to date when a parameter is calibrated.

## Rules of the C

`cppcheck --addon=misra` (MISRA C:2012) and the warnings `-Wconversion -Wdouble-promotion -Wfloat-equal
-Wstack-usage={stack}` look at the C of the controller and at the programs with it on the emulated board; the first two
are silent. No function of the controller calls itself, no stack depends on data, and the controller has no loop. What
stays has its reason in `fmus/target/deviations.py`, and a test fails on anything else that is found:

{deviations}

cppcheck runs without its analysis of values (`DISABLE_VALUEFLOW=1`), which takes minutes on the controller.

## Under a timer

`scheduler.c` in `fmus/target/c` is an example of a main on a board: a timer's interrupt every {period:g} ms runs the
controller, under a watchdog of two periods, with stand-ins for the bus and for the torque interface, over a background
that shuts interrupts out now and then. In the emulator, whose processor makes 7.8 million instructions a second of its
own time, {kept} samples were kept; the interrupt's function began {latency} of a period after the timer at the latest,
and the sample was done after {response}.

## Calibration by A2L

`driveline target image` writes `controller.elf` and `controller.a2l`, an ASAM MCD-2 MC description from the same
declaration as everything else: every parameter with unit, limits, meaning and its address in that image, every input
and output likewise, the status with its words. The parameters lie in one record in RAM, `calibration` of `link.c`; what
is written there acts from the next sample on. A test reads the file with a public parser (pya2l), and changes `k_d` in
the running loop by its address: the torques are, bit by bit, those with `k_d` set.

## A board of your own

`fmus/target/c` has the program around the controller: `link.c`, which takes commands and answers them, and a file for
the board, `board_mps2.c` with the linker's script `mps2_an386.ld`. Another board needs another such file, with a start
that enables the floating-point unit (CPACR), copies `.data`, clears `.bss` and calls `main`, and four functions
(`board.h`):

| function | what it does | on the emulator |
|---|---|---|
| `board_receive` | takes so many bytes from the link; 0 when it was closed | semihosting, standard input |
| `board_send` | gives so many bytes to the link | semihosting, standard output |
| `board_count` | a counter that runs on: instructions, or cycles (DWT CYCCNT) | SysTick under `-icount` |
| `board_stack` | bytes of stack used below its caller since the last call | painted words |

On a real board the link is a serial port at the same bytes: a letter and the numbers as they lie in memory, little
endian, see `link.c`. A project that only wants the controller needs none of this.

Made by `driveline target record`; do not edit.
"""

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
        manoeuvres=len(MANOEUVRES),
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
    most = max(each.instructions[1] for each in comparisons)
    rows = [
        ("instructions a sample, the most", f"{most}"),
        ("share of the period", f"{most / (T_S * CLOCK):.2%}"),
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
