"""What a reader may point at in the operating envelope: the panels of its figure, each case with its text."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import xarray as xr

from separatrix.figures.envelope import ORDERS, Place, column, has_duty, places, worst
from separatrix.figures.hover import Plot, Series, floats, plain
from separatrix.figures.map import MOST_PANELS, axis_label, axis_values, is_proportional
from separatrix.figures.stability import ETA_LABEL
from separatrix.figures.style import BLACK, BLUE, GREY, VERDICT_COLOURS, VERMILION
from separatrix.present.text.tables import interval, number, significant
from separatrix.units import Array, format_quantity


def envelope_plots(data: xr.Dataset) -> tuple[Plot, ...]:
    """Return the panels of the operating envelope from the top, as `figures.envelope` draws them."""
    place, names = places(data), _names(data)
    panels = [("\N{GREEK SMALL LETTER ETA} [-]", [*_margin(data, place, names)])]
    panels.append(("P(stable) [-]", [*_probability(data, place, names)]))
    panels.append(("frequency [Hz]", [*_frequencies(data, place, names)]))
    panels.append(("time [%]", [*_time(data, place, names)]))
    drawn = [(label, series) for label, series in panels if series]
    title, found = "Operating envelope", worst(data, place)
    if found is not None:
        at, words = found
        title = words if at is None else f"Worst case: {words}"
        if at is not None:
            drawn[0][1].append(Series(name="", kind="upright", x=(at,), y=(None,), colour=VERMILION))
    only = str(data["parameter"].values[0])
    return tuple(
        Plot(
            title=title,
            x_label=plain(axis_label(data, only, only)) if place[1] else "case",
            y_label=label,
            series=tuple(series),
            x_log=place[1] and is_proportional(place[0]),
            y_log=label.startswith("frequency"),
        )
        for label, series in drawn
    )


def sweep_plots(data: xr.Dataset) -> tuple[Plot, ...]:
    """Return the panels of a sweep of several parameters, as `figures.sweep` draws them: cases by verdict."""
    eta, verdict = data["restitution_factor"].values.astype(float), data["verdict"].values.astype(str)
    rows = zip(_names(data), eta, verdict, strict=True)
    texts = [f"{name}: restitution factor {number(e, 3)}{v and f', {v}'}" for name, e, v in rows]
    groups = [("cases", "", BLACK), *((v, v, c) for v, c in VERDICT_COLOURS.items())]
    return tuple(
        Plot(
            title="Restitution factor of every case",
            x_label=plain(axis_label(data, name, name)),
            y_label=plain(ETA_LABEL),
            series=tuple(
                _series(words, np.where(verdict == known, eta, np.nan), texts, (at, False), colour)
                for words, known, colour in groups
                if (verdict == known).any()
            ),
        )
        for name in map(str, data["parameter"].values[:MOST_PANELS])
        for at in [axis_values(data, name)]
    )


def _names(data: xr.Dataset) -> list[str]:
    """Return the number of each case with the values of its parameters."""
    parts = [[f"case {one}" for one in data["case"].values.tolist()]]
    for name in map(str, data["parameter"].values):
        words, unit = name.rpartition(".")[2].replace("_", " "), str(data[name].attrs.get("units", "-"))
        parts.append([f"{words} {format_quantity(value, unit)}" for value in data[name].values.tolist()])
    return [", ".join(one) for one in zip(*parts, strict=True)]


def _series(
    name: str, values: Array, texts: list[str], place: Place, colour: str, ends: tuple[Array, ...] = ()
) -> Series:
    """Return the finite values of the cases as a line, or as points where lines have no meaning."""
    at = np.isfinite(values)
    low, high = (floats(one[at]) for one in ends) if ends else ((), ())
    return Series(
        name=name,
        kind="line" if place[1] else "points",
        x=floats(place[0][at]),
        y=floats(values[at]),
        text=tuple(text for text, has in zip(texts, at, strict=True) if has),
        colour=colour,
        low=low,
        high=high,
    )


def _margin(data: xr.Dataset, place: Place, names: list[str]) -> Iterator[Series]:
    eta, threshold = column(data, "restitution_factor"), column(data, "restitution_threshold")
    if eta is None:
        return
    texts = [f"{name}: restitution factor {number(one, 3)}" for name, one in zip(names, eta, strict=True)]
    if threshold is not None:
        low, high = (data[f"restitution_threshold_{end}"].values.astype(float) for end in ("low", "high"))
        rows = list(zip(names, eta, threshold, low, high, strict=True))
        above = [f"{name}: threshold {interval(t, a, b)}, margin {t - e:+.3f}" for name, e, t, a, b in rows]
        yield _series("threshold (95 %)", threshold, above, place, BLUE, (low, high))
        texts = [
            text + (f", margin {t - e:+.3f}" if np.isfinite(t) else "")
            for text, (_, e, t, _, _) in zip(texts, rows, strict=True)
        ]
    yield _series("restitution factor", eta, texts, place, BLACK)


def _probability(data: xr.Dataset, place: Place, names: list[str]) -> Iterator[Series]:
    """Yield P(stable), a series of points for each verdict."""
    stable = column(data, "probability_stable")
    if stable is None:
        return
    ends = tuple(data[f"probability_{end}"].values.astype(float) for end in ("low", "high"))
    verdict = data["verdict"].values.astype(str)
    rows = zip(names, verdict, stable, *ends, data["reason"].values.astype(str), strict=True)
    texts = [f"{name}: {said}; P(stable) {interval(*p)}. {why}".strip() for name, said, *p, why in rows]
    for name, colour in VERDICT_COLOURS.items():
        if (verdict == name).any():
            values = np.where(verdict == name, stable, np.nan)
            yield _series(name, values, texts, (place[0], False), colour, ends)


def _frequencies(data: xr.Dataset, place: Place, names: list[str]) -> Iterator[Series]:
    """Yield the whirl without clearance, the orders of the bearing, and orbits of runs that whirl."""
    rows = [("linear_whirl_frequency", "whirl without clearance", BLACK)]
    rows += [(name, words, colour) for name, (words, colour, _) in ORDERS.items()]
    for name, words, colour in rows:
        values = column(data, name)
        if values is not None:
            values = np.where(values > 0.0, values, np.nan)
            yield _series(words, values, _hertz(names, words, values), place, colour)
    orbit = column(data, "orbit_frequency")
    for sign, way in ((1.0, "forward"), (-1.0, "backward")):
        if orbit is not None and (np.sign(orbit) == sign).any():
            words, values = (
                f"orbit of whirling runs, {way}",
                np.where(np.sign(orbit) == sign, abs(orbit), np.nan),
            )
            texts = _hertz(names, words, values)
            yield _series(words, values, texts, (place[0], False), VERMILION)


def _hertz(names: list[str], words: str, values: Array) -> list[str]:
    return [f"{name}: {words} {significant(one, 3)} Hz" for name, one in zip(names, values, strict=True)]


def _time(data: xr.Dataset, place: Place, names: list[str]) -> Iterator[Series]:
    """Yield the share of the time that each case of a duty cycle takes."""
    if has_duty(data):
        share = 100.0 * data["time_share"].values.astype(float)
        yield Series(
            name="share of the time",
            kind="bars",
            x=floats(place[0]),
            y=floats(share),
            text=tuple(
                f"{name}: {significant(one, 3)} % of the time" for name, one in zip(names, share, strict=True)
            ),
            colour=GREY,
        )
