"""Synthetic raw logs: one writer per format, from its documented layout. No vendor's file is copied.

Each writer takes arrays in SI units (friction without a unit) and gives the bytes of a file. Numbers are
written with `digits` decimals in the unit of the format, so that a reader can be compared to the last digit.
"""

import numpy as np

CODES = {"utf-8-sig": b"", "utf-16-le-mark": b"\xff\xfe", "utf-16-be-mark": b"\xfe\xff"}


def anton_paar(
    friction, time, *, laps=None, nano=False, decimal=".", encoding="cp1252", newline="\r\n", missing=""
):
    """Anton Paar / CSM TRB: ``key : value [unit]`` lines, one line of headers, tabs between the columns."""
    distance, speed, load = time * 0.1, 0.1, 5.0
    laps = distance / (2 * np.pi * 0.015) if laps is None else laps
    force, unit = (1e3, "mN") if nano else (1.0, "N")
    head = [
        "Nano Tribometer" if nano else "TRB3 Tribometer",
        "Sample name\t: A1",
        "Radius\t: 15.00 [mm]",
        "Lin. Speed\t: 10.00 [cm/s]",
        f"Normal load\t: {load * force:.2f} [{unit}]",
        "Temperature\t: 22.00 [\u00b0C]",
        "Single-way mode",
        "",
    ]
    header = "Time [s]\tDistance [m]\tLaps\tSequence ID\tCycle ID\tMax Linear Speed [m/s]\t"
    header += (
        f"Nominal Load [{unit}]\t\u00b5\tAngle [\u00b0]\tFriction Force [{unit}]\tPenetration Depth [\u00b5m]"
    )
    one = np.ones_like(time)
    columns = [time, distance, laps, one, np.floor(laps), speed * one, load * force * one, friction]
    columns += [laps % 1.0 * 360.0, friction * load * force, time * 1e-3]
    text = rows(columns, "\t", 6, missing)
    head = [line.replace(".", decimal) if ":" in line else line for line in head]
    head[3] = head[3].replace(f"Lin{decimal}", "Lin.")
    return encoded([*head, header, *[line.replace(".", decimal) for line in text]], encoding, newline)


def rtec(friction, time, *, speed_rpm=120.0, steps=None, total="00:01:08.25"):
    """Rtec MFT: a line of keys over one of values, headers and rows that end in a comma, and a total time."""
    one = np.ones_like(time)
    number = one if steps is None else np.asarray(steps, float)
    head = ["Sample,Operator,Recipe", "disk 7,nobody,pin on disk"]
    header = "Step, Timestamp, RecipeStep, DAQ.Fz (N),DAQ.Fx (N),DAQ.COF (),"
    header += "Rotary.Velocity (rpm),XYZ.Z Depth (mm),"
    columns = [number, time, number, 10.0 * one, friction * 10.0, friction, speed_rpm * one, time * 1e-4]
    text = [line + "," for line in rows(columns, ",", 6, "")]
    tail = ["TotalTime", total] if total else []
    return encoded([*head, header, *text, *tail], "utf-8", "\r\n")


def umt(friction, time, *, reciprocating=False, steps=1, unit="g"):
    """Bruker (CETR) UMT: for each step its keys, headers, a line of units, an empty line, and the rows.

    Forces are in gram-force with compression negative; `steps` divides the rows evenly, time begins anew.
    """
    size = {"g": 9.80665e-3, "N": 1.0}[unit]
    head = ["Created by CETR Data Viewer ver.2.19 01/02/26 10:00:00", "Total number of runs - 1"]
    head += [f"Total number of steps = {steps}", "", "Run # 1", "Run date 01 Feb 2026 10:00:00"]
    lines = head
    for i, part in enumerate(np.array_split(np.arange(len(time)), steps), 1):
        f, t = friction[part], time[part] - time[part][0]
        n = np.full_like(t, 2.0)
        stroke = np.sign(np.sin(2 * np.pi * t + 0.1)) if reciprocating else np.ones_like(t)
        keys = [f"Step No. {i}", "", "Step Type Code: 0", "Radius       = 15.000", "Velocity     = 240"]
        keys += [f"Set Force    = {-n[0] / size:.0f}", f"Data Count   = {len(t)}", ""]
        header = ["Fx,Fz,Z,T,Ff,COF", f"{unit},{unit},mm,sec,{unit},", ""]
        columns = [stroke * f * n / size, -n / size, -t * 1e-3, t, f * n / size, f]
        lines = [*lines, *keys, *header, *rows(columns, ",", 6, ""), "", ""]
    return encoded(lines, "utf-8", "\r\n")


def compend(friction, time, *, fast_data_every=0):
    """Phoenix Compend: rows that begin and end with a tab, with lines naming files of fast data between."""
    load = np.full_like(time, 20.0)
    names = ["Test Time (s)", "Load (N)", "Friction (N)", "Total Cycles", "Contact Potential (mV)", "CoF"]
    columns = [time, load, friction * load, np.floor(time * 2), 0 * time, friction]
    text = ["\t" + line + "\t" for line in rows(columns, "\t", 6, "")]
    if fast_data_every:
        for n, i in enumerate(range(len(text) - 1, 0, -fast_data_every)):
            text.insert(i, f'Fast data in \t=HYPERLINK("test-h{n:03d}.tsv")')
    head = ["COMPEND 2000", "Test file\ttest.tsv", "", "Test started at 10:00:00"]
    header = "\t" + "\t".join(names) + "\t"
    return encoded([*head, header, *text, "Test finished at 11:00:00"], "cp1252", "\r\n")


def plain_csv(
    columns, *, separator=",", decimal=".", units=(), head=(), tail=(), encoding="utf-8", digits=6, missing=""
):
    """A table with its header, perhaps a line of units below it, and lines before and after."""
    lines = [*head, separator.join(columns)]
    if units:
        lines.append(separator.join(units))
    text = rows(list(columns.values()), separator, digits, missing)
    if decimal != ".":
        text = [line.replace(".", decimal) for line in text]
    return encoded([*lines, *text, *tail], encoding, "\n")


def rows(columns, separator, digits, missing):
    """Rows of numbers; NaN is written as `missing`."""
    texts = [
        [missing if value != value else f"{value:.{digits}f}" for value in np.asarray(column, float).tolist()]
        for column in columns
    ]
    return [separator.join(row) for row in zip(*texts, strict=True)]


def encoded(lines, encoding, newline):
    """The lines in an encoding; ``utf-16-le-mark`` and its like with a byte order mark."""
    text = newline.join(lines) + newline
    if encoding in CODES and encoding != "utf-8-sig":
        return CODES[encoding] + text.encode(encoding.removesuffix("-mark"))
    return text.encode(encoding)


def as_written(values, digits=6):
    """The numbers that a reader must give back for values written with this number of decimals."""
    return np.array([float(f"{value:.{digits}f}") for value in np.asarray(values, float).tolist()])
