"""One drive as loggers, test benches and spreadsheets write it, a row for each habit.

Most are from public reports and the documentation of vendors: asammdf and pandas issues, INCA, CANape, CANoe, VBOX,
LabVIEW, MATLAB timetables, Excel in German, French and Swiss, DIAdem, PCAN-View, candump.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

COUNT = 61
TIME = np.round(0.1 * np.arange(COUNT), 10)
V = np.round(36.0 + 3.0 * np.sin(0.05 * np.arange(COUNT)), 2)
T = np.round(20.0 + 30.0 * np.sin(0.3 * np.arange(COUNT)), 1)
NAMES = ("Time [s]", "Velocity [km/h]", "Motor Torque [Nm]")

Line = Callable[[int], str]


@dataclass(frozen=True)
class Habit:
    """A text, and what reading it must give.

    Attributes:
        content: of the file.
        kept: indices of the samples that are read.
        refused: what is said of a text that is not read.
        said: what the finding says.
        columns: `--column`.
    """

    content: bytes
    kept: Sequence[int] = range(COUNT)
    refused: str = ""
    said: str = ""
    columns: tuple[tuple[str, str], ...] = ()


def cells(k: int) -> list[str]:
    return [f"{TIME[k]:.1f}", f"{V[k]:.2f}", f"{T[k]:.1f}"]


def plain(k: int) -> str:
    return ",".join(cells(k))


def german(k: int) -> str:
    return ";".join(cells(k)).replace(".", ",")


def text(
    line: Line = plain,
    names: str = ",".join(NAMES),
    above: str = "",
    below: str = "",
    end: str = "\n",
    count: int = COUNT,
    coding: str = "utf-8",
    **expected: object,
) -> Habit:
    rows = [names, *map(line, range(count))]
    return Habit((above + end.join(rows) + end + below).encode(coding), **expected)  # type: ignore[arg-type]


def replaced(row: int, column: int, cell: str, separator: str = ",", **how: object) -> Habit:
    """With another text in one cell."""

    def line(k: int) -> str:
        row_cells = cells(k)
        if k == row:
            row_cells[column] = cell
        return separator.join(row_cells)

    return text(line, separator.join(NAMES), **how)  # type: ignore[arg-type]


def at(row: int, other: str, line: Line = plain) -> Line:
    """With another line before one."""
    return lambda k: f"{other}\n{line(k)}" if k == row else line(k)


def timed(stamp: Callable[[float], str], name: str = "Time", **how: object) -> Habit:
    return text(
        lambda k: ";".join([stamp(float(TIME[k])), *cells(k)[1:]]),
        ";".join((name, *NAMES[1:])),
        **how,  # type: ignore[arg-type]
    )


def clock(t: float) -> str:
    return f"{int(t // 60):02}:{t % 60:06.3f}"


def half(t: float) -> str:
    """From 11:59:57 on, so that noon is passed."""
    hour, second = (11, 57.0 + t) if t < 3.0 else (12, t - 3.0)
    return f"{hour}:{59 if hour == 11 else 0:02}:{second:06.3f} {'AM' if hour == 11 else 'PM'}"


FEW = [*range(30), *range(31, COUNT)]

NO_VALUE = (
    "",
    "--",
    "NaN",
    "n/a",
    "#N/A",
    "1.#QNAN00",
    "ungültig",
    "Not a Number",
    "\N{EN DASH}",
    "9.9E+34",
    "3.402823E+38",
)


def labview(columns: str = "One", mark: str = ".") -> Habit:
    """A text of LabVIEW, with a head for the file and one for the channels."""
    head = (
        f"LabVIEW Measurement\t\nSeparator\tTab\nDecimal_Separator\t{mark}\nMulti_Headings\tNo\nX_Columns\t{columns}\n"
        f"Time\t10:15:30,123\n***End_of_Header***\t\n\t\nChannels\t2\t\t\t\nSamples\t{COUNT}\t{COUNT}\t\t\n"
        "Y_Unit_Label\tkm/h\tNm\t\t\nX_Dimension\tTime\tTime\t\t\nDelta_X\t0.1\t0.1\t\t\n***End_of_Header***\t\t\t\t"
    )
    rows = ["\t".join([*cells(k), ""]).replace(".", mark) for k in range(COUNT)]
    refused = (
        "" if columns == "One" else "has no time that is that of all its channels; save it with `X Value Columns: One`"
    )
    names = "X_Value\tVelocity\tMotor Torque\tComment"
    return Habit("\n".join([head, names, *rows]).encode() + b"\n", refused=refused)


def vbox() -> Habit:
    """A text of VBOX, whose times are those of a clock without colons, here around a full minute."""
    head = (
        "File created on 05/01/2026 at 10:15:30\n\n[header]\nsatellites\ntime\nvelocity kmh\nMotor_Torque\n\n"
        "[channel units]\nNm\n\n[comments]\nVBOX 3i\n\n[column names]\nsats time velocity Motor_Torque \n\n[data]"
    )
    stamps = (f"1015{57.0 + t:05.2f}" if t < 3.0 else f"1016{t - 3.0:05.2f}" for t in TIME)
    rows = [f"008 {stamp} {V[k]:07.3f} {T[k]:+.6E}" for k, stamp in enumerate(stamps)]
    return Habit("\n".join([head, *rows]).replace("\n", "\r\n").encode() + b"\r\n")


TWO_LINES = "Time,Velocity 1,Motor Torque\ns,km/h,Nm"

HABITS: dict[str, Habit] = {
    **{f"no value: {word!r}": replaced(30, 2, word, ";", said="no value") for word in NO_VALUE},
    "no value in the first cells": text(
        lambda k: f'"{"#N/A" if 20 < k < 40 else k}";"' + german(k).replace(";", '";"') + '"',
        ";".join(("Lap", *NAMES)),
    ),
    "no value: quoted": replaced(30, 2, '""', said="has no value"),
    "no value in the last rows": text(lambda k: plain(k) if k < 58 else f"{TIME[k]:.1f},,", kept=range(58)),
    "no value in the first rows": text(lambda k: plain(k) if k > 5 else f"{TIME[k]:.1f},NaN,NaN", kept=range(6, COUNT)),
    "no time in a row": replaced(30, 0, "", kept=FEW),
    "a hole of half a second": text(
        lambda k: plain(k) if not 30 <= k < 35 else f"{TIME[k]:.1f},,{T[k]:.1f}",
        refused=r"line 32: Velocity .* has no value for 0\.6 s after 2\.9 s; .* --from 0 --to 2\.9$",
    ),
    "a word in a needed column": replaced(
        30, 1, "fast", refused=r"line 32, column Velocity .* fast is not a finite number; .*--from 0 --to 2\.9$"
    ),
    "infinite": replaced(30, 1, "inf", refused=r"inf is not a finite number"),
    "a word in a column that nobody needs": text(
        lambda k: plain(k) + (",see note" if k == 3 else ",5"), f"{','.join(NAMES)},Gear"
    ),
    "no numbers at all in an optional column": text(lambda k: plain(k) + ",-", f"{','.join(NAMES)},Elevation [m]"),
    "inches in a comment": text(lambda k: plain(k) + ',"5" tyre' * (k == 7), f"{','.join(NAMES)},Note"),
    "a comment over two lines": text(lambda k: plain(k) + ',"gate\nopen"' * (k == 7), f"{','.join(NAMES)},Note"),
    "a quote without an end": text(lambda k: plain(k) + ',"gate' * (k == 7), f"{','.join(NAMES)},Note"),
    "a cell for each time": text(
        lambda k: f"{TIME[k]:.3f},{V[k]:.2f},\n{TIME[k] + 0.03:.3f},,{T[k]:.1f}", kept=[]
    ),
    "slow speed between": text(lambda k: plain(k) if k % 5 == 0 else f"{TIME[k]:.1f},,{T[k]:.1f}", kept=[]),
    "device": text(names="time [s],Velocity\\XCP:1 [km/h],Motor Torque\\XCP:1 [Nm]"),
    "device of INCA": text(
        lambda k: ";".join(cells(k)), "time;v_veh\\ETKC:1;T_mot\\ETKC:1\ns;km/h;Nm", count=COUNT
    ),
    "device before": text(names="time [s],ABS_1::Velocity [km/h],MCU::Motor Torque [Nm]"),
    **{
        f"path before: {path}": text(names=f"Time [s],{path}Velocity [km/h],{path}Motor Torque [Nm]")
        for path in ("CAN1.ABS.", "XCPsim.", "Model Root/Plant/", "Platform()://ASM/Model Root/")
    },
    **{
        f"in brackets: {what}": text(names=f"Time [s],Velocity {what} [km/h],Motor Torque {what} [Nm]")
        for what in ("(CAN 1)", "(0x1A0)", "[0]")
    },
    "the rate behind": text(names="Time [s],Velocity [km/h] (10 ms),Motor Torque [Nm] (10 ms)"),
    "another torque behind a path": text(
        names="Time [s],Velocity [km/h],Brake/Torque [Nm]", refused=r"no column Motor Torque"
    ),
    **{
        f"another torque: {name}": text(names=f"Time [s],Velocity [km/h],{name} [Nm]", refused="no column Motor Torque")
        for name in ("-Motor Torque", "Request/Motor Torque", "Max.Motor Torque", "Motor Torque (2)")
    },
    "a torque with its sign turned": text(
        lambda k: ",".join([*cells(k)[:2], f"{-T[k]:.1f}"]), "Time [s],Velocity [km/h],-Motor Torque [Nm]",
        columns=(("T_mot", "-Motor Torque [Nm]"),),
    ),
    "names as MATLAB spells them": text(names="Time__s_,Velocity__km_h_,MotorTorque__Nm_"),
    "names as R spells them": text(names="Time..s.,Velocity..km.h.,Motor.Torque..Nm."),
    "names with hyphens": text(names="Time [s]:,Velocity [km/h]:,Motor-Torque (unit: Nm):"),
    **{f"{mark} before units": text(names=f"Time{mark}s,Velocity{mark}km/h,Motor Torque{mark}Nm") for mark in "|@"},
    "names in French": text(german, "Temps [s];Vitesse [km/h];Couple moteur [Nm]"),
    "numbers of rows without a name": text(lambda k: f"{k},{plain(k)}"),
    "numbers of rows that may be a time, and a column without a name": text(
        lambda k: f"{k},{V[k]:.2f},{T[k]:.1f},7", "Time [ms],Velocity [km/h],Motor Torque [Nm]",
        refused="line 2 has 4 cells below 3 names, and the first counts the rows",
    ),
    "numbers of rows as R writes them": text(
        lambda k: f'"{k + 1}" {" ".join(cells(k))}', " ".join(f'"{name}"' for name in NAMES)
    ),
    "a time for each channel": text(
        lambda k: f"{TIME[k]:.1f};{V[k]:.2f};{TIME[k] + 0.03:.2f};{T[k]:.1f}",
        "Time [s];Velocity [km/h];Time [s];Motor Torque [Nm]",
        kept=[],
    ),
    "a time of day for each channel": text(
        lambda k: f"10:{clock(TIME[k])};{V[k]:.2f};10:{clock(TIME[k] + 0.03)};{T[k]:.1f}",
        "Time;Velocity [km/h];Time;Motor Torque [Nm]",
        kept=[],
    ),
    "two times side by side": text(
        lambda k: f"{TIME[k]:.1f},{plain(k)}", f"Time [s],{','.join(NAMES)}", refused="2 columns are called Time"
    ),
    "a time of day for one channel, seconds for another": text(
        lambda k: f"10:{clock(TIME[k])};{V[k]:.2f};{TIME[k] + 2.0:.1f};{T[k]:.1f}",
        "Time;Velocity [km/h];Time [s];Motor Torque [Nm]",
        refused=r"Time and Time \[s\] could each be time",
    ),
    "two devices": text(
        lambda k: f"{plain(k)},0",
        "time [s],Velocity\\XCP:1 [km/h],Motor Torque [Nm],Velocity\\ETKC:2 [km/h]",
        refused=r"could each be v .*--column v=",
    ),
    "thousands, German": text(
        lambda k: f"{german(k)};1.520,{k % 10}", ";".join((*NAMES, "Höhe [m]")), coding="utf-8-sig"
    ),
    "thousands, quoted": text(lambda k: f'{plain(k)},"1,520.5"', ",".join((*NAMES, "Height [m]"))),
    "thousands, no-break blank": text(lambda k: f"{german(k)};1\u00a0520,5", ";".join((*NAMES, "Height [m]"))),
    "thousands, Swiss": text(lambda k: f"{';'.join(cells(k))};1'520.5", ";".join((*NAMES, "Height [m]"))),
    "millions": text(lambda k: f"{german(k)};1.001.520,5", ";".join((*NAMES, "Note"))),
    **{f"minus {sign!r}": text(lambda k, sign=sign: plain(k).replace("-", sign)) for sign in "⁻‐—\u00ad"},
    "a minus behind": text(lambda k: ",".join(f"{c[1:]}-" if c[0] == "-" else c for c in cells(k))),
    "a minus apart": text(lambda k: plain(k).replace("-", "- ")),
    "brackets for a minus": text(lambda k: ",".join(f"({c[1:]})" if c[0] == "-" else c for c in cells(k))),
    "exponents of Fortran": text(lambda k: ",".join(f"{float(c):.6E}".replace("E", "D") for c in cells(k))),
    "no exponent of Fortran": replaced(30, 2, "1D2", refused="1D2 is not a finite number"),
    "a true minus sign": text(lambda k: plain(k).replace("-", "−")),
    "exponents, German": text(lambda k: f"{TIME[k]:.6E};{V[k]:.6E};{T[k]:+.6e}".replace(".", ","), ";".join(NAMES)),
    "points among commas": text(
        lambda k: german(k).replace(",", ".") if k == 30 else german(k),
        ";".join(NAMES),
        refused=r"line 32, column .* \(the decimal of this file is a comma\) is not a finite number",
    ),
    "commas among points": text(
        lambda k: ";".join(cells(k)).replace(".", ",") if k == 30 else ";".join(cells(k)),
        ";".join(NAMES),
        refused=r"line 32, column .* \(the decimal of this file is a point\) is not a finite number",
    ),
    "a last line cut off": text(below="6.1,3", kept=range(COUNT)),
    "a last line cut off after a mark": text(below="6.1,", kept=range(COUNT)),
    "a last number cut off": text(below="6.1,36.50,4"),
    "a last character cut off": Habit(text(coding="utf-16").content[:-1]),
    "a last number as short as others are": Habit(
        text(lambda k: ",".join(f"{float(cell):g}" for cell in cells(k)), below="6.1,36.5,4").content
    ),
    "a footer of rows": text(below="err,1,2\n" * 20),
    "no time in the last rows": text(
        below="err,1,2\n" * 21, refused=r"line 63: Time .* has no value, nor has it in the 20 rows below; .* --to 6$"
    ),
    "a unit in the last times": text(
        lambda k: plain(k).replace(",", "s,", 1) if k > 30 else plain(k), refused=r"3\.1s is not a finite number, nor"
    ),
    "another decimal in the first rows": text(
        lambda k: german(k) if k > 30 else ";".join(cells(k)),
        ";".join(NAMES),
        refused=r"3,1 \(the decimal of this file is a point\) is not .* in the 29 rows below; .* --to 3$",
    ),
    "names in the middle, as a comment": text(
        at(30, "# " + ";".join(NAMES) + ";", german), ";".join(NAMES), above="# a drive\n"
    ),
    "other names in the middle": text(
        at(30, ",".join((NAMES[0], NAMES[2], NAMES[1]))), refused=r"line 32 names other columns than line 1: Time"
    ),
    "a last line without an end": Habit(text().content.rstrip(b"\n")),
    "a footer": text(below="End of file\n"),
    "a footer with numbers": text(below="Min,0,-35\nMax,50,125\n"),
    "a footer of dashes": text(below="-----\n"),
    "a footer with a date": text(below="Created 2026-01-05 10:15:30\n"),
    "end-of-file byte": text(below="\x1a"),
    "end-of-file byte on the last line": Habit(text().content.rstrip(b"\n") + b"\x1a"),
    "zeros behind the end": text(below="\0" * 500),
    "zeros after a loss of power": text(lambda k: "\0" * 50 * (k == 30) + plain(k)),
    "a flash that was erased": Habit(
        text(names="Zeitstempel [s],Vitesse véhicule [km/h],Motor Torque [Nm]").content.rstrip(b"\n") + b"\xff" * 16
    ),
    "blank lines": text(at(30, "\n")),
    "blank cells in a line": text(at(30, ",,")),
    "names in the middle": text(at(30, ",".join(NAMES))),
    "names and units in the middle": text(
        at(30, TWO_LINES), TWO_LINES, columns=(("v", "Velocity 1"),)
    ),
    "a comment in the middle": text(at(30, "# gate 7 opened")),
    "an event in the middle": text(at(30, "Pause")),
    "marks of events before the time": text(
        lambda k: f"{'x' if k % 10 == 0 else ''};{german(k)};false", ";".join(("Marker", *NAMES, "Brake"))
    ),
    "signs of events before the time": text(
        lambda k: f"{'*' if k % 2 else '#1'},{plain(k)},false", ",".join(("Marker", *NAMES, "Brake"))
    ),
    "a comment with marks between cells": text(
        lambda k: at(9, "# gate 7, door 8", lambda k: f"{k},{plain(k)}")(k), f"k,{','.join(NAMES)}"
    ),
    "a mark at a time": text(lambda k: "*" * (k == 30) + plain(k), refused=r"line 32, column Time .*: \*3\.0 is not"),
    "a row with another mark": text(
        lambda k: plain(k).replace(",", ";") if k == 30 else plain(k), refused=r"line 32, column Time .* is not a fin"
    ),
    "a page in the middle": text(at(30, f"\nPage 2\n{','.join(NAMES)}\n")),
    **{f"{mark} before the names": text(names=f"{mark} {','.join(NAMES)}") for mark in (";", "!", "**", "--", "REM")},
    "comments with numbers above": text(above="# a, b, c\n# 1, 2, 3\n# 4, 5, 6\n"),
    "a long head": text(above="".join(f"# note {k}\n" for k in range(200))),
    "a long head of numbers": text(above="".join(f"p{k},{k}\n" for k in range(120))),
    "lines in quotes": text(lambda k: f'"{plain(k)}"', f'"{",".join(NAMES)}"'),
    "blanks around commas": text(lambda k: " , ".join(f"{cell:>9}" for cell in cells(k)), " , ".join(NAMES)),
    "a number where the time is a word": text(at(30, "Pause,1,2"), refused=r"line 32, column Time .*: Pause is not"),
    "# before the names": text(names="# " + ",".join(NAMES)),
    "// before the names": text(names="// " + ",".join(NAMES)),
    "# before names and units": text(names="# Time,Velocity,Motor Torque\n# s,km/h,Nm"),
    "types below the units": text(names="Time,Velocity,Motor Torque\ns,km/h,Nm\ndouble,double,float32"),
    "devices below the units": text(names="Time,Velocity,Motor Torque\ns,km/h,Nm\n,ETKC:1,ETKC:1"),
    "units of which some are empty": text(lambda k: plain(k) + ",D", "Time,Velocity,Motor Torque,Gear\ns,km/h,Nm,"),
    "units of which one is none": text(lambda k: plain(k) + ",D", "Time,Velocity,Motor Torque,Gear\ns,km/h,Nm,enum"),
    "a group above names that are units too": text(names="A,A,B\nt [s],v [km/h],T [Nm]"),
    "# over the number of the row": text(lambda k: f"{k},{plain(k)}", "#," + ",".join(NAMES)),
    "% and a blank before the names": text(lambda k: " ".join(cells(k)), "% t[s] v[km/h] T_mot[Nm]"),
    "units behind a comma": text(german, "Time, s;Velocity, km/h;Motor Torque, Nm"),
    "an index without a name": text(lambda k: f"{k},{plain(k)}", "," + ",".join(NAMES)),
    "milliseconds before a trigger": text(
        lambda k: f"{1e3 * TIME[k] - 2e3:.0f},{V[k]:.2f},{T[k]:.1f}", "Time [ms],Velocity [km/h],Motor Torque [Nm]"
    ),
    "columns of nothing": text(lambda k: plain(k) + ",,", ",".join(NAMES) + ",,"),
    "names over three lines": text(names="Car,Car,Motor\nTime,Velocity,Motor Torque\n[s],[km/h],[Nm]"),
    "percent of a torque": text(names="Time [s],Velocity [km/h],Motor Torque [%]", refused=r"in %, which does not"),
    "comments of an INI": text(above="; logger 7\n; rate 10 Hz\n"),
    "numpy.savetxt": text(lambda k: " ".join(cells(k)), "# t[s] v[km/h] T_mot[Nm]"),
    "blanks, many": text(lambda k: "   ".join(cells(k)) + " ", "t[s]   v[km/h]  T_mot[Nm]"),
    "blanks, names in quotes": text(lambda k: " ".join(cells(k)), " ".join(f'"{name}"' for name in NAMES)),
    "pipes": text(lambda k: "|".join(cells(k)), "|".join(NAMES)),
    "a table of Markdown": text(
        lambda k: f"| {' | '.join(cells(k))} |", f"| {' | '.join(NAMES)} |\n| --- | ---: | ---: |"
    ),
    "a line below the names": text(names=",".join(NAMES) + "\n=====,=====,====="),
    "an empty line below the names": text(names=",".join(NAMES) + "\n"),
    "a comma for all": text(
        lambda k: german(k).replace(";", ","),
        refused=r"line 2 has 6 cells below 3 names: the comma parts cells and decimals; save it with semicolons",
    ),
    "two units of a column": text(
        names=",".join(NAMES) + "\ns,m/s,Nm", refused=r"Velocity \[km/h\] is in 'km/h and m/s', which is not a known"
    ),
    "one unit of a column, twice": text(names=",".join(NAMES) + "\ns,kmh,N.m"),
    "two units of a column that nobody needs": text(
        lambda k: plain(k) + ",1", ",".join((*NAMES, "Gear [1]")) + "\ns,km/h,Nm,m"
    ),
    "seconds as a date has them": timed(lambda t: f"05.01.2026 10:15:{int(t + 30.7):02}"),
    "LabVIEW": labview(),
    "LabVIEW, German": labview(mark=","),
    "LabVIEW, a time for each channel": labview("Multi"),
    "LabVIEW, no times": labview("No"),
    "VBOX": vbox(),
    "old Macintosh": text(end="\r"),
    "UTF-16": text(coding="utf-16"),
    "Latin-1": text(lambda k: f"{plain(k)},20 °C", ",".join((*NAMES, "Öl")), coding="latin-1"),
    "sep=": text(above="sep=,\n"),
    "all quoted": text(lambda k: ",".join(f'"{cell}"' for cell in cells(k)), ",".join(f'"{name}"' for name in NAMES)),
    "texts of a spreadsheet": text(lambda k: ",".join(f'="{cell}"' for cell in cells(k))),
    "all quoted once": text(lambda k: ",".join(f"'{cell}'" for cell in cells(k)), ",".join(f"'{n}'" for n in NAMES)),
    "texts by an apostrophe": text(lambda k: ",".join(f"'{cell}" for cell in cells(k))),
    "units in other brackets": text(names="Time {s},Velocity <km/h>,Motor Torque {Nm}"),
    "units behind a dash": text(names="Time - s,Velocity: km/h,Motor Torque - Nm"),
    "records of INCA": text(
        lambda k: "\t".join(cells(k)), "time\tVelocity\\ETKC:1\tMotor Torque\\ETKC:1\ns\tkm/h\tNm\nf8\tf8\tf8",
        above="ETASAsciiItemFile record\nrecorder\ttime\nsampleCount\t61\n",
    ),
    "MoTeC": text(
        lambda k: ",".join(f'"{cell}"' for cell in cells(k)), '"Time","Velocity","Motor Torque"\n"s","km/h","Nm"\n',
        above='"Format","MoTeC CSV File",,,"Workbook",""\n"Sample Rate","10.000","Hz",,"Duration","6.0","s"\n\n',
    ),
    "a clock that is set back": timed(
        lambda t: f"2026-10-25 02:59:{57 + t:06.3f}+02:00" if t < 3 else f"2026-10-25 02:00:{t - 3:06.3f}+01:00"
    ),
    "an index before": text(lambda k: f"{k},{plain(k)}", f",{','.join(NAMES)}"),
    "the last row first": text(lambda k: plain(COUNT - 1 - k), refused=r"line 3: time 5\.9 s does not come after 6 s"),
    "a mark at each end of line": text(lambda k: plain(k) + ",", ",".join(NAMES) + ","),
    "more cells than names": text(lambda k: plain(k) + ",7,8"),
    "coarse clock": text(lambda k: f"{0.2 * (k // 2):.1f},{V[k]:.2f},{T[k]:.1f}"),
    "coarse clock of three": text(lambda k: f"{0.3 * (k // 3):.1f},{V[k]:.2f},{T[k]:.1f}"),
    "a row twice": text(at(30, plain(29))),
    "a time twice": text(
        at(30, "2.9,1,1"), refused=r"line 32: time 2\.9 s does not come after 2\.9 s; .* --from 3 --to 6$"
    ),
    "two recordings": text(below=f"{plain(0)}\n{plain(1)}\n", refused=r"line 63: time 0 s does not come after 6 s"),
    "a gap": text(
        lambda k: plain(k) if k < 40 else ",".join([f"{TIME[k] + 1.0:.1f}", *cells(k)[1:]]),
        refused=r"line 42: gap of 1\.1 s after 3\.9 s; .*; the longest piece without is --from 0 --to 3\.9$",
    ),
    "seconds with a unit": timed(lambda t: f"{t:g} sec"),
    "Timedelta of pandas": timed(lambda t: f"0 days 00:00:{t:09.6f}"),
    "hours with a unit": timed(lambda t: f"{t / 3600.0:.12g} hr"),
    "days with a unit": timed(lambda t: f"{t / 86400.0:.15g} days"),
    "duration of Python": timed(lambda t: f"1 day, 0:00:{t:09.6f}"),
    "duration of ISO": timed(lambda t: f"PT{t:g}S"),
    "duration of ISO, all parts": timed(lambda t: f"P0DT0H0M{t:.3f}S"),
    "duration in parts": timed(lambda t: f"0h 1m {t:.3f}s"),
    "before a trigger": timed(lambda t: f"{'-' * (t < 2.0)}00:00:{abs(t - 2.0):06.3f}"),
    "hours, minutes, seconds": timed(lambda t: f"00:{clock(t)}"),
    "minutes and seconds": timed(lambda t: f"{clock(t)}", "Time [mm:ss.S]"),
    "over the hour in minutes": timed(lambda t: clock((3598.0 + t) % 3600.0)),
    "colon before milliseconds": timed(lambda t: f"10:{clock(t)}".replace(".", ":")),
    "noon": timed(half),
    "noon, points": timed(lambda t: half(t).replace("AM", "a.m.").replace("PM", "p.m.")),
    "American date": timed(lambda t: f"1/5/2026 {half(t)}"),
    "date of MATLAB": timed(lambda t: f"05-Jan-2026 00:{clock(t)}"),
    "date in English": timed(lambda t: f"Jan 5, 2026 {half(t)}"),
    "date in German": timed(lambda t: f"05.01.2026 10:{clock(t)}"),
    "date with two digits": timed(lambda t: f"05.01.26 10:{clock(t)}"),
    **{
        f"date: {date}": timed(lambda t, date=date: date.format(f"10:{clock(t)}"), name)
        for date, name in (
            ("5 févr. 2026 {}", "Temps"), ("5 août 2026 {}", "Temps"), ("05-Jan-26 {}", "Time"),
            ("5 juil. 2026 {}", "Time"),
            ("Mo, 5. Jan. 2026 {}", "Zeit"), ("Mon Jan  5 {} 2026", "Time"), ("2026年1月5日 {}", "Time"),
            ("{} vorm.", "Zeit"), ("{} vorm", "Zeit"),
            ("20260105T{}", "Time"), ("2026-01-05 {} CET", "Time"), ("2026-01-05T{}+01:00[Europe/Berlin]", "Time"),
            ("05.01.2026 {} Uhr", "Zeit"), ("1/5/2026, {}\u202fAM", "Time"), ("2026-01-05 {}", ""),
        )
    },
    "ISO with comma": timed(lambda t: f"2026-01-05T10:{clock(t)}".replace(".", ",")),
    "ISO with zone": timed(lambda t: f"2026-01-05 10:{clock(t)}+01:00"),
    "over midnight": timed(lambda t: f"23:59:{57 + t:06.3f}" if t < 3.0 else f"00:{clock(t - 3.0)}"),
    "a date of its own": text(
        lambda k: f"2026-01-05;10:{clock(TIME[k])};{';'.join(cells(k)[1:])}", "Date;Time;" + ";".join(NAMES[1:])
    ),
    "epoch": timed(lambda t: f"{1.7e9 + t:.1f}", "Time [s]"),
    "milliseconds of the epoch": timed(lambda t: f"{1.7e12 + 1e3 * t:.0f}", "Time [ms]"),
    "code, 16 bits signed": replaced(30, 2, "-3276.8", said="is -3276.8, which loggers write where there is no value"),
    "code, 16 bits": replaced(30, 2, "6553.5", said="is 6553.5, which loggers"),
    "code, 32 bits": replaced(30, 1, "4294967295", said="which loggers"),
    "code, 12 bits": replaced(30, 2, "409.5", said="is 409.5, which loggers"),
    "a lone spike": replaced(30, 2, "1000", kept=[], said="a spike"),
}  # fmt: skip
