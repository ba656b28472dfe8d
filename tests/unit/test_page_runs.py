"""The page of `simulate`: what its pictures and the moving cage show, and when."""

import html
import json

import numpy as np
import pytest
from matplotlib.figure import Figure
from scipy.integrate import quad

from separatrix.ground.document import Part
from separatrix.present import draw, view
from separatrix.present.view import A_TURN, AROUND, MOST_FRAMES, frame_moments, scene
from separatrix.verbs.parts import run_pictures

LENGTHS = ("position", "axial_place", "half_play", "largest_offset")


def run(samples=4, *, count=5, guidance="outer", play=0.6e-3, space=False, whirl=900.0, **cage):
    """A run of 10 ms of a cage of `count` pockets whose centre goes around, as a document."""
    time = np.linspace(0.0, 0.01, samples)
    around = np.stack([np.cos(whirl * time), np.sin(whirl * time)], axis=1)
    force = np.where(np.arange(samples)[:, None] % 3 == np.arange(count) % 3, 20.0, 0.0)
    clearance = None if guidance == "ball" else 1e-3
    values = {
        "time": time,
        "position": 4e-4 * around,
        "velocity": 4e-4 * whirl * around[:, ::-1] * [-1.0, 1.0],
        "rotation": 1e-3 * time,
        "ball_lead": np.zeros((samples, count)),
        "contact_force": force,
        "land_force": np.where(np.arange(samples) % 4 == 1, 7.0, 0.0),
        "pocket_angle": 2 * np.pi * np.arange(count) / count,
        "half_play": np.full(count, 0.5 * play),
    }
    if space:
        values |= {"axial_place": 1e-5 * around[:, 0], "lean": 5e-3 * around, "ball_axial": 0.0 * force}
    document = {name: value.tolist() for name, value in values.items()}
    document |= {"judged_from": 0.0, "followed": 0.0, "force_limit": None, "whirl_frequency": None}
    document["study"] = {"cage": {"width": {"value": None}}}
    document["cage"] = {
        "pitch_radius": 0.0325,
        "cage_speed": 600.0,
        "ball_diameter": 0.0111,
        "guidance": guidance,
        "land_clearance": clearance,
        "land_out_of_round": 0.0,
        "land_lobes": 2,
        "land_count": 1,
        "land_spacing": None,
        "land_width": 3e-3,
        "ramp_time": 0.0,
        "ramp_start": 0.1,
        "pocket_shape": "square",
        "axial_half_play": 0.5 * play if space else None,
    } | cage
    return Part(document, dict.fromkeys(LENGTHS, "m") | {"largest_tilt": "rad", "time": "s"})


ODD = {
    "ordinary": run(),
    "in space": run(space=True, land_count=2, land_spacing=1e-2),
    "one sample": run(1, space=True),
    "one ball": run(2, count=1, guidance="inner"),
    "no play": run(2, play=0.0, land_out_of_round=1e-5),
    "a land only": run(2, play=1e-2),
    "no land": run(3, guidance="ball"),
}


@pytest.mark.parametrize("answer", ODD.values(), ids=ODD.keys())
def test_any_run_has_panels(answer):
    """Those of the plane, and in space that of the tilt."""
    kinds = (run_pictures.orbit, run_pictures.spectrum, run_pictures.offset, run_pictures.forces)
    for one in (*kinds, *[run_pictures.tilt] * ("lean" in answer)):
        draw.draw_panel(Figure().add_subplot(), one(answer))


@pytest.mark.parametrize(("whirl", "parts"), [(50e3, 2), (2e3, 1)])
def test_a_fast_whirl_is_never_strobed(whirl, parts):
    """At least `A_TURN` frames a turn; a slow one is shown whole, else the key says what is left out."""
    answer = run(20_000, whirl=2 * np.pi * whirl)
    moments = np.concatenate(frame_moments(answer, MOST_FRAMES))
    steps, seen = np.diff(np.array(answer.time)[moments]), scene(answer)
    assert (steps > 1 / (A_TURN * whirl)).sum() == len(seen["parts"]) - 1 == parts - 1  # the cut
    assert (seen["parts"][0][0], seen["parts"][-1][1]) == pytest.approx((0.0, 0.01))
    assert MOST_FRAMES / 2 < moments.size <= MOST_FRAMES
    assert (moments[0], moments[-1]) == (0, 19_999)


def test_the_ball_set_turns_by_the_integral_of_its_speed():
    """With a ramp from a fifth of the speed over 4 of 10 ms."""
    answer = run(6, ramp_time=4e-3, ramp_start=0.2)

    def speed(t):
        return 600.0 * (0.2 + 0.8 * min(t / 4e-3, 1.0))

    expected = [quad(speed, 0.0, t, points=[4e-3])[0] for t in answer.time]
    # quadrature
    assert view.turned_by(answer.cage, np.array(answer.time)) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("answer", [ODD["ordinary"], ODD["in space"], ODD["one sample"]])
def test_a_view_has_its_run_as_numbers_and_escapes_the_study(answer):
    """Tilt, and a view from above, only in space; a study's text ends no script; it says how enlarged."""
    title, seen = "</script><b> & $1$ @DATA@", scene(answer)
    text = view.page((title, "below"), seen)
    assert title not in text
    assert html.escape(title) in text
    found = json.loads(text.partition('id="run">')[2].partition("</script>")[0])
    assert (found["lean"] is None) is ("lean" not in answer)
    assert (found["view"] == [np.pi / 2, 0.0]) is ("lean" not in answer)  # along the axis
    assert len(found["time"]) == len(answer.time)
    assert found == json.loads(json.dumps(seen))
    assert found["most"] == [max(map(max, answer.contact_force)) or 1.0, max(answer.land_force) or 1.0]


def test_the_force_of_a_frame_is_the_largest_since_the_one_before():
    """Of samples between two frames none is lost."""
    forces = np.zeros((6, 1))
    forces[2] = 7.0
    assert view._largest_since(forces, np.array([0, 3, 5])).ravel().tolist() == [0.0, 7.0, 0.0]


def test_a_course_in_time_keeps_its_extremes():
    """Of many samples the least and the largest of each part are drawn, with the first and the last."""
    values = np.zeros(20_000)
    values[[7, 11_111]] = 3.0, -2.0
    places = run_pictures.thinned(values)
    assert {0, 7, 11_111, 19_999} <= set(places.tolist())
    assert places.size <= run_pictures.SHOWN + 2


def test_the_pockets_bound_the_path_by_a_polygon():
    """Half way between the normals of two of six lines the centre goes farther, by 1 over cos 30 deg."""
    found = run_pictures.pocket_boundary(run(count=3))
    assert found.min() == pytest.approx(3e-4)
    # half a degree from one direction to the next
    assert found.max() == pytest.approx(3e-4 / np.cos(np.pi / 6), rel=1e-4)
    assert AROUND.size == found.size
