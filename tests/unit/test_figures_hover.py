"""What a reader may point at in a figure."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from separatrix.figures.hover import Series, map_plot, traction_plot


def map_of(share: list[list[float]]) -> xr.Dataset:
    """A map of 2 x 2 points: film thickness [m] across, friction upward; one point was refused."""
    shape = ("y", "x")
    table = {
        "probability_whirl": share,
        "decision": [["STABLE", ""], ["UNDECIDED", "UNSTABLE"]],
        "reason": [["", "refused: too thin"], ["", ""]],
        "probability_low": [[0.0, np.nan], [0.2, 0.8]],
        "probability_high": [[0.2, np.nan], [0.8, 1.0]],
        "runs": [[16, 0], [16, 16]],
    }
    data = xr.Dataset({name: (shape, np.array(values)) for name, values in table.items()})
    data["x"] = ("x", [1e-7, 2e-6], {"units": "m"})
    data["y"] = ("y", [0.1, 0.3], {"units": "-"})
    for name, key, here in (("x", "film.thickness", 5e-7), ("y", "ball_cage_friction", 0.2)):
        data[f"{name}_parameter"], data[f"{name}_here"] = key, here
    return data


def named(series: tuple[Series, ...], name: str) -> Series:
    """The series of that name."""
    return next(one for one in series if one.name == name)


def test_map_cells_say_what_is_known_in_the_shown_unit():
    """A cell has its share and verdict, a refused one its reason; axes are in micrometres."""
    plot = map_plot(map_of([[0.0, np.nan], [0.5, 1.0]]))
    cells = plot.series[0]
    assert cells.x == pytest.approx((0.1, 2.0, 0.1, 2.0))
    assert cells.value == (0.0, None, 0.5, 1.0)
    assert "film thickness 0.1 \N{MICRO SIGN}m" in cells.text[0]
    assert "STABLE; share that whirls 0.00 (0.00 to 0.20), 16 runs" in cells.text[0]
    assert cells.text[1].endswith("refused: too thin")


def test_the_study_is_at_its_place_of_the_map():
    """The mark of the study is in the units of the axes, not in SI."""
    study = named(map_plot(map_of([[0.0, np.nan], [0.5, 1.0]])).series, "the study itself")
    assert (study.x[0], study.y[0]) == pytest.approx((0.5, 0.2))


def test_traction_has_a_series_for_each_race_in_percent():
    """Creep is in percent, and every point has its text."""
    data = xr.Dataset(
        {
            "creep_increment": (("race", "increment"), [[-0.01, 0.0, 0.01]] * 2),
            "traction_coefficient": (("race", "increment"), [[-0.1, 0.0, 0.1], [-0.05, 0.0, np.nan]]),
        },
        coords={"race": ["inner", "outer"]},
    )
    inner, outer = traction_plot(data).series
    assert inner.x == pytest.approx((-1.0, 0.0, 1.0))
    assert inner.text[2] == "inner race: creep 1 %, traction coefficient 0.1"
    assert outer.y[2] is None
