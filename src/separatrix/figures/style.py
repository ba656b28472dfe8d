"""How every figure looks: sizes, colours that colour-blind readers can distinguish, labels and heading."""

from __future__ import annotations

import io
import json
import re
import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import xarray as xr
from cycler import cycler
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.mathtext import math_to_image
from matplotlib.transforms import Bbox, offset_copy
from matplotlib.typing import RcKeyType

from separatrix.ground.errors import InputError
from separatrix.ground.units import Array, format_quantity

Look = dict[str, Any]
"""Keyword arguments of matplotlib."""

Json = Mapping[str, Any]
"""A resolved study, or a part of it, as documents and datasets have it."""

COLUMN, PAGE = 3.5, 7.0
"""Widths of one and of two columns of a journal [inch]."""

BLUE, ORANGE, GREEN, VERMILION = "#0072B2", "#E69F00", "#009E73", "#D55E00"
PURPLE, SKY, BLACK, GREY = "#CC79A7", "#56B4E9", "#000000", "#6b6b6b"
"""Okabe and Ito's palette, and a grey."""

CYCLE = (BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY, BLACK)
MARKERS = ("o", "s", "^", "v", "P", "*", "p")
VERDICT_COLOURS = {"STABLE": BLUE, "UNSTABLE": VERMILION, "UNDECIDED": ORANGE}
VERDICT_MARKERS = {"STABLE": "o", "UNSTABLE": "X", "UNDECIDED": "D"}

STYLE: dict[RcKeyType, object] = {
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],
    "font.size": 8.0,
    "axes.titlesize": 8.5,
    "axes.labelsize": 8.0,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.prop_cycle": cycler(color=CYCLE),
    "axes.titlelocation": "left",
    "hatch.linewidth": 0.5,
    "lines.linewidth": 1.3,
    "lines.markersize": 4.0,
    "legend.frameon": False,
    "legend.fontsize": 7.5,
    "xtick.labelsize": 7.5,
    "ytick.labelsize": 7.5,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "figure.dpi": 200.0,
    "savefig.dpi": 200.0,
    "svg.hashsalt": "separatrix",
    "svg.fonttype": "path",
    "path.simplify": True,
}

NOTHING: dict[str, Look] = {
    ".png": {"Software": None},
    ".svg": {"Date": None, "Creator": None},
    ".pdf": {"Creator": None, "Producer": None, "CreationDate": None},
}
"""Endings of pictures, and what is left out of each so that the same data make the same bytes."""

WIDTH = 122
"""Letters on a line over the width of a page."""

LINE = 0.135
"""Height of a line [inch]."""

RANDOM = ("stability", "map", "rank", "sensitivity", "sweep")
"""Verbs whose answer depends on the seed, besides that of a single run."""

OUTCOMES = {
    "SETTLES": "the cage settles",
    "ROLLS": "the cage rolls in its pockets",
    "WHIRLS": "the cage whirls",
    "DRIFTS": "the cage drifts off",
    "UNRESOLVED": "unresolved",
}
"""How a run ended, in words."""


def journal() -> AbstractContextManager[None]:
    """Draw with this style inside the block."""
    return mpl.rc_context(STYLE)


def canvas(width: float = COLUMN, height: float = 2.6, **grid: Any) -> tuple[Figure, Any]:
    """Return a figure and its axes; no state of matplotlib's is touched."""
    figure = Figure(figsize=(width, height), layout="constrained")
    return figure, figure.subplots(**grid)


def settled(figure: Figure) -> Figure:
    """Lay the figure out once for all, so that every format and every drawing of it is the same."""
    layout = figure.get_layout_engine()
    if layout is not None:
        # axes of equal scales end elsewhere than where they were laid out
        for _ in range(2 if any(axes.get_aspect() != "auto" for axes in figure.axes) else 1):
            layout.execute(figure)
    figure.set_layout_engine(None)  # "none" would leave a placeholder, for which savefig draws twice
    # the solver's last digits and its sign of 0 differ from call to call, and names hold them
    for part in figure.subfigs:
        part.bbox_relative.set_points(part.bbox_relative.get_points().round(9) + 0.0)
    for axes in figure.axes:
        axes.set_position(Bbox(axes.get_position(original=True).get_points().round(9) + 0.0))
    return figure


def save(figure: Figure, path: Path) -> None:
    """Write the figure in the format of the ending, one of `NOTHING`; the same data make the same bytes."""
    if path.suffix not in NOTHING:
        raise InputError(str(path), f"must end in {', '.join(NOTHING)}", got=f'"{path.suffix}"')
    with journal():
        figure.savefig(path, metadata=NOTHING[path.suffix])


def legend_below(figure: Figure, panels: Iterable[Axes] | None = None, *, columns: int = 2) -> None:
    """Name everything in these panels (or in all) once, below the picture."""
    handles: Look = {}
    for axes in figure.axes if panels is None else panels:
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
            handles.setdefault(label, handle)
    look: Look = {"fontsize": 6.5, "handlelength": 2.4, "columnspacing": 1.5}
    figure.legend(list(handles.values()), list(handles), loc="outside lower left", ncols=columns, **look)


def legend_above(axes: Axes, columns: int, length: float = 1.6) -> None:
    """Name the lines of a panel in one row at the right of its title."""
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 0.97), ncols=columns, handlelength=length)


def colour_bar(mesh: ScalarMappable, panels: list[Axes], label: str, **look: Any) -> None:
    """Explain the colours of a mesh beside its panels."""
    bar: Any = panels[0].figure.colorbar(mesh, ax=panels, label=label, **look)
    bar.outline.set_visible(False)


def label_lines(
    axes: Axes,
    labels: Sequence[tuple[float, float, str, str]],
    *,
    gap: float = 0.055,
    colour: str | None = None,
) -> None:
    """Write labels at the right ends of lines, moved apart where they would overlap.

    Labels are (x, y, text, colour) at the ends of the lines, in data; limits and scales must be final. `gap`
    is the least distance of two, as a share of the height; `colour` that of the text, by default the line's.
    A label that had to move is tied to its line.
    """
    share = axes.transData - axes.transAxes
    wanted = [float(share.transform((x, y))[1]) for x, y, _, _ in labels]
    places = spread(wanted, gap)
    moved = any(abs(place - want) > gap / 4 for place, want in zip(places, wanted, strict=True) if want < 1)
    upright = axes.get_xaxis_transform()  # x in data, y as a share of the height
    beside = offset_copy(upright, axes.get_figure(root=True), x=12 if moved else 4, units="points")
    for place, want, (x, y, text, own) in zip(places, wanted, labels, strict=True):
        leader: Look = {"arrowstyle": "-", "lw": 0.5, "shrinkA": 1.0, "shrinkB": 0.0, "relpos": (0.0, 0.5)}
        axes.annotate(
            text,
            (x, y),
            xytext=(x, place),
            textcoords=beside,
            color=colour or own,
            va="center",
            fontsize=7.0,
            annotation_clip=False,
            arrowprops={**leader, "color": own} if moved and want < 1 else None,
        )


def with_ends(data: xr.Dataset, name: str) -> tuple[Array, Array, Array]:
    """Return a variable with the low and the high end of its interval."""
    value, low, high = (np.asarray(data[f"{name}{end}"].values, dtype=float) for end in ("", "_low", "_high"))
    return value, low, high


def spread(wanted: Sequence[float], gap: float) -> list[float]:
    """Return places in 0 to 1, `gap` apart and in the same order, near to the wanted ones."""
    order = np.argsort(wanted, kind="stable")
    places = np.array(wanted, dtype=float)[order]
    for _ in range(200):
        for low in range(places.size - 1):
            lack = gap - (places[low + 1] - places[low])
            if lack > 1e-9:
                places[low : low + 2] += [-lack / 2, lack / 2]
        np.clip(places, 0.02, 0.98, out=places)
    return [float(place) for place in places[np.argsort(order)]]


_COMMENT = re.compile(r"<!--.*?-->\s*|<metadata>.*?</metadata>\s*", re.DOTALL)
_PATH = re.compile(r' d="[^"]*"')
_LONG = re.compile(r"-?\d+\.\d{3,}(?!\d*e)")
_SIZE = re.compile(r'<svg[^>]*?viewBox="0 0 ([\d.]+) ([\d.]+)"', re.DOTALL)


def svg_of(figure: Figure) -> tuple[str, float, float]:
    """Return a figure as SVG with its width and height [points]; texts are drawn, none is left as text."""
    buffer = io.StringIO()
    with journal():
        figure.savefig(buffer, format="svg", metadata=NOTHING[".svg"])
    return _small(buffer.getvalue())


def formula(latex: str) -> tuple[str, float, float]:
    """Return a formula as SVG with its width and height [points]."""
    buffer = io.BytesIO()
    with mpl.rc_context({**STYLE, "savefig.transparent": True}):
        math_to_image(f"${latex}$", buffer, prop=FontProperties(size=11), format="svg")
    return _small(buffer.getvalue().decode())


def _small(text: str) -> tuple[str, float, float]:
    """Return an SVG without comments and to a hundredth of a point, and its size."""
    text = _COMMENT.sub("", text[text.index("<svg") :])
    text = _PATH.sub(lambda path: _LONG.sub(lambda one: f"{float(one[0]):.2f}", path[0]), text)
    size = _SIZE.search(text)
    if size is None:
        raise ValueError("matplotlib's SVG has no viewBox")
    return text, float(size[1]), float(size[2])


def literal(text: str) -> str:
    """Return a text that a figure writes as it is: matplotlib takes a formula between two dollar signs."""
    return text.replace("$", r"\$")


def literal_texts(data: xr.Dataset) -> xr.Dataset:
    """Return a dataset whose texts, title and study a figure writes as they are."""
    found = data.copy()
    for name, one in data.variables.items():
        if one.dtype.kind in "OU" and "$" in str(one.values):
            written = one.values.astype(object)
            for place, text in np.ndenumerate(written):
                written[place] = literal(text) if isinstance(text, str) else text
            found[name] = xr.Variable(one.dims, written, one.attrs)
    found.attrs = {name: literal(v) if isinstance(v, str) else v for name, v in data.attrs.items()}
    if "study" in data.attrs:  # it is JSON, where a backslash is written twice
        found.attrs["study"] = data.attrs["study"].replace("$", r"\\$")
    return found


def study_of(data: xr.Dataset) -> Json:
    """Return the resolved study in a dataset; empty without one."""
    return dict(json.loads(data.attrs.get("study", "{}")))


def stated(study: Json, section: str, key: str) -> Any:
    """Return the value of a key of a resolved study; None where the study has none."""
    return ((study.get(section) or {}).get(key) or {}).get("value")


def headed(figure: Figure, data: xr.Dataset) -> Figure:
    """Write title, operating point and run above a figure, as far as the dataset records them."""
    width, height = figure.get_size_inches()
    lines = heading(data, int(WIDTH * min(1.0, width / PAGE)))
    if lines:
        figure.set_size_inches(width, height + LINE * len(lines))
        figure.suptitle("\n".join(lines), x=0.008, ha="left", fontsize=7.0, linespacing=1.35)
    return figure


def heading(data: xr.Dataset, width: int = WIDTH) -> list[str]:
    """Return the title of the study, its operating point, and which run this is; each a line or two.

    `data` is from `literal_texts`; what its attributes do not record is left out.
    """
    study = study_of(data)
    seed = f"seed {int(data.attrs['seed'])}" if "seed" in data.attrs else ""
    around, run = list(_operating_point(data, study)), ""
    if "outcome" in data:
        run = _run(data, study, seed)
    elif data.attrs.get("verb") in RANDOM and seed:
        around.append(seed)
    parts = str(data.attrs.get("title", "")), "; ".join(around), run
    return [line for part in parts for line in cut(part, width)]


def cut(text: str, width: int) -> list[str]:
    """Return a text on at most two lines."""
    return textwrap.wrap(text, width, max_lines=2, placeholder=" ...")


def _operating_point(data: xr.Dataset, study: Json) -> Iterator[str]:
    """Yield medium, speed and load, and film, as far as the study states them and no axis varies them."""
    axes = [str(data[key].values) for key in ("x_parameter", "y_parameter") if key in data]
    cases = data["parameter"].values if "parameter" in data else ()
    varied = {str(name).rpartition(".")[2] for name in (*axes, *cases)}

    def known(section: str, key: str, unit: str = "") -> str:
        value = None if key in varied else stated(study, section, key)
        if unit and value:
            return format_quantity(value, unit).replace(" um", " \N{MICRO SIGN}m")
        return str(value or "")

    medium = known("operation", "fluid"), known("operation", "temperature", "K")
    yield from filter(None, [", ".join(filter(None, medium))])
    for race in ("inner", "outer"):
        if speed := known("operation", f"{race}_speed", "rad/s"):
            yield f"{race} ring {speed}"
    for direction in ("axial", "radial"):
        if load := known("operation", f"{direction}_load", "N"):
            yield f"{load} {direction}"
    film = study.get("film", {})
    if not film.get("is_bare", not film):
        yield ", ".join(filter(None, [_material(film), known("film", "thickness", "m")]))
    elif film:
        yield "bare races"


def _material(section: Json) -> str:
    record = section.get("material") or {}
    return str(record.get("name") or record.get("value") or "")


def _run(data: xr.Dataset, study: Json, seed: str) -> str:
    """Return friction with its material, kick, number and seed of a run, and its outcome."""
    parts = []
    if "cage_ball_cage_friction" in data:
        cage = study.get("cage", {})
        entry = cage.get("ball_cage_friction", {})
        candidate = entry.get("candidate")
        whose = f"{candidate} in {entry['environment']}" if candidate else _material(cage)
        value = float(data["cage_ball_cage_friction"])
        parts.append(f"pocket friction {value:.3g}{f' ({whose})' if whose else ''}")
    parts.append(f"kick {float(data['kick']):g} m/s")
    parts += [f"run {int(data['run'])}"] if "run" in data else []
    parts += [seed] if seed else []
    word, length = str(data["outcome"].values), 1e3 * float(data["time"].values[-1])
    return f"{', '.join(parts)}: {OUTCOMES.get(word, word)} (run of {length:.4g} ms)"
