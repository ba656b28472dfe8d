"""Figures of one contact, from a solution alone."""

from __future__ import annotations

import numpy as np
import pytest
from exact_cases import contact, kalker, saturation

from separatrix.figures import contact as figures


@pytest.fixture(scope="module")
def area():
    """A contact of 5:1 in partial slip."""
    return kalker(contact(0.2, columns=20, rows=40), -0.5 * saturation(0.25))


def test_the_outline_is_that_of_the_ellipse(area):
    """Row ends are means over rows of 1/20 of the half length: (1/20)^2/3 and less, but at both tips."""
    x, y = figures.outline(area).T
    near = np.abs(y) < 0.9
    radius = np.hypot(x / 0.2, y)[near]
    assert np.abs(radius - 1.0).max() < 0.05**2 / 3.0 / (1.0 - 0.9**2)


def test_a_contact_is_drawn_with_the_stick_line_of_another_theory(area):
    """Arrows, outline, and the line; axes in mm with different scales say so."""
    line = np.where(np.abs(area.across) < 0.5, -0.1, np.nan)
    figure = figures.tractions(area, stick_line=line)
    axes = figure.axes[0]
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["strips"]
    assert "different scales" in axes.get_xlabel()
    assert "mm" in axes.get_ylabel()
    assert "MPa" in figure.axes[1].get_ylabel()


def test_arrows_point_along_the_traction(area):
    """Body 1 is pulled forward where its creep is negative."""
    quiver = figures.tractions(area).axes[0].collections[-1]
    assert (quiver.U > 0.0).all()
    assert np.abs(quiver.V).max() < 0.2 * quiver.U.max()


def test_power_is_not_negative_and_its_map_sums_to_the_dissipation(area):
    """The map is per area of what is inside; times that area it is the dissipation, to rounding."""
    figure = figures.slip_and_power(area)
    mesh = figure.axes[1].collections[0]
    shown = 1e6 * np.asarray(mesh.get_array()).reshape(area.fraction.shape)
    cell = (area.along[1] - area.along[0]) * (area.across[1] - area.across[0])
    inside = np.where(area.fraction > 0.0, area.fraction, 1.0)
    assert shown.min() >= 0.0
    assert (shown * inside).sum() * cell == pytest.approx(area.dissipation, rel=1e-9)
