"""The moving cage as a GIF and as a page: what is drawn, when, and that no half file is left."""

from __future__ import annotations

import html
import json

import drawn
import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image
from scipy.integrate import quad

from separatrix.figures import animation, motion, view
from separatrix.figures.animation import animate
from separatrix.figures.motion import A_TURN, MOST_FRAMES, frame_moments
from separatrix.ground.errors import InputError

SMALL, LONG = drawn.run(samples=4), drawn.run(samples=5000)
SPACE = drawn.run(samples=4, space=True, cage_land_count=2, cage_land_spacing=1e-2)
ODD = {
    "ordinary": SMALL,
    "in space": SPACE,
    "one sample": drawn.run(samples=1, outcome="SETTLES", space=True),
    "nothing touches": drawn.run(samples=3, guidance="ball", touching=False),
    "one ball": drawn.run(samples=2, count=1, guidance="inner"),
    "no play": drawn.run(samples=2, play=0.0, cage_land_out_of_round=1e-5),
    "hundred balls": drawn.run(samples=2, count=100, outcome="UNRESOLVED"),
    "a land only": drawn.run(samples=2, play=1e-2),
}


def whole(data):
    """The scene of all samples."""
    return view.scene(data, np.arange(data.sizes["time"]))


def drawn_at(seen, frame):
    """Outlines of the cage, and the circle of the land, as an animation draws them in a frame."""
    axes = Figure().add_subplot()
    animation.draw_cage(axes, seen)(frame)
    return [path.vertices for path in axes.collections[0].get_paths()], axes.lines[0].get_xydata()


@pytest.mark.parametrize("data", ODD.values(), ids=ODD.keys())
def test_a_gif_is_written_for_any_run(data, tmp_path):
    """Each sample a frame here, reported one by one; nothing else stays in the folder."""
    reported = []
    animate(data, tmp_path / "a.gif", progress=lambda *args: reported.append(args))
    assert [path.name for path in tmp_path.iterdir()] == ["a.gif"]
    count = data.sizes["time"]
    assert reported == [(i + 1, count) for i in range(count)]
    with Image.open(tmp_path / "a.gif") as found:
        assert (found.n_frames, found.format) == (count, "GIF")


def test_an_interrupt_leaves_no_half_file_and_the_older_one(tmp_path):
    """Ctrl-C at the second frame: the older one is there to the last byte, and nothing else."""
    (tmp_path / "a.gif").write_bytes(b"older")

    def stop(done, total):
        if done == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        animate(SMALL, tmp_path / "a.gif", progress=stop)
    assert [path.read_bytes() for path in tmp_path.iterdir()] == [b"older"]


@pytest.mark.parametrize("name", ["a.mp4", "a"])
def test_only_a_gif_is_written(name, tmp_path):
    """Another ending is refused in one line, and nothing is written; one in capitals is known."""
    with pytest.raises(InputError, match=r"must end in \.gif"):
        animate(SMALL, tmp_path / name)
    assert not list(tmp_path.iterdir())
    animate(SMALL.isel(time=[0]), tmp_path / "A.GIF")
    assert (tmp_path / "A.GIF").read_bytes().startswith(b"GIF89a")


def whirling(samples, whirl):
    """A run of 10 ms whose centre turns at a frequency."""
    made = drawn.run(samples=samples)
    around = 2 * np.pi * whirl * made["time"].values
    return made.assign(velocity=(("time", "across"), motion.ring(1.0, around)))


@pytest.mark.parametrize(("whirl", "parts"), [(50e3, 2), (2e3, 1)])
def test_a_fast_whirl_is_never_strobed(whirl, parts):
    """At least `A_TURN` frames a turn; a slow one is shown whole, else the picture says what is left out."""
    data = whirling(20_000, whirl)
    moments = frame_moments(data)
    steps, shown = np.diff(data["time"].values[moments]), motion.shown_parts(data, moments)
    assert (steps > 1 / (A_TURN * whirl)).sum() == parts - 1  # the cut
    assert len(shown) == parts
    assert (shown[0][0], shown[-1][1]) == pytest.approx((0.0, 10.0))
    assert view.span_key(data, moments).startswith("Frames show 0 to")


@pytest.mark.parametrize("data", [*(whirling(20_000, whirl) for whirl in (50e3, 2e3)), LONG])
def test_frames_are_few_and_run_from_start_to_end(data):
    """However many samples: rising, with the first and the last."""
    moments = frame_moments(data)
    assert MOST_FRAMES / 2 < moments.size <= MOST_FRAMES
    assert (np.diff(moments) > 0).all()
    assert (moments[0], moments[-1]) == (0, data.sizes["time"] - 1)


def test_a_picture_says_how_many_times_too_large_movements_are():
    """Number for number, and how time runs; one of few moments has the force between them."""
    moments = np.array([0, 3])
    seen = view.scene(SMALL, moments)
    key = "0 to 20 N in the pocket (balls: white to red), 0 to 7 N on the land (grey to red); root scale"
    assert view.force_key(seen).startswith(key)
    assert seen.force[1].tolist() == [seen.largest[0]] * 5 == [20.0] * 5
    assert f'"enlarged":{seen.enlarged}' in view.page(SMALL)


def test_a_wall_meets_its_ball_when_the_pocket_touches():
    """A cage moved by the play along the ball's tangent: bar and ball meet in the enlarged picture."""
    still = drawn.run(samples=1, count=13)
    seen = whole(still.assign(position=still["position"] * 0.0 + [0.0, 3e-4]))
    assert seen.enlarged > 2
    last = drawn_at(seen, 0)[0][12]  # the bar behind ball 0, which lies at (R, 0)
    wall = last[view.BAR_POINTS : view.BAR_POINTS + 2].mean(axis=0)
    # rounding: tangent to the ball
    assert wall[1] == pytest.approx(-seen.ball, rel=1e-9)


@pytest.mark.parametrize(("guidance", "side"), [("outer", 1), ("inner", -1)])
def test_the_cage_meets_its_land_when_it_touches(guidance, side):
    """At an offset of the gap the surface of the cage reaches the land, outside and inside."""
    data = drawn.run(samples=1, guidance=guidance)
    shapes, land = drawn_at(whole(data.assign(position=data["position"] * 0.0 + [5e-4, 0.0])), 0)
    surface = shapes[-1] if side > 0 else shapes[-2]
    at = 0 if side > 0 else motion.AROUND.size // 2  # along x, or against it
    # rounding
    assert surface[at] == pytest.approx(land[at], rel=1e-12, abs=1e-12)


def test_the_ball_set_turns_by_the_integral_of_its_speed():
    """With a ramp from a fifth of the speed over 4 of 10 ms; without one, speed times time."""
    assert view.turned_by(SMALL).tolist() == pytest.approx((600.0 * SMALL["time"].values).tolist())
    ramped = drawn.run(samples=6, cage_ramp_time=4e-3, cage_ramp_start=0.2)

    def speed(t):
        return 600.0 * (0.2 + 0.8 * min(t / 4e-3, 1.0))

    expected = [quad(speed, 0.0, t, points=[4e-3])[0] for t in ramped["time"].values]
    # quadrature
    assert view.turned_by(ramped).tolist() == pytest.approx(expected, rel=1e-9)


def test_a_ball_of_unknown_size_fills_three_quarters_of_its_place():
    """A cage by itself has no diameter of its balls."""
    assert whole(drawn.run(samples=1, cage_ball_diameter=0.0)).ball == pytest.approx(
        0.375 * 2 * np.pi * 0.0325 / 5
    )
    assert whole(SMALL).ball == 0.5 * 0.0111


@pytest.mark.parametrize("data", [SMALL, SPACE, drawn.run(samples=1, guidance="ball")])
def test_a_page_has_its_run_as_numbers_and_escapes_the_study(data):
    """Tilt, and a view from above, only in space; a study's text ends no script."""
    title = "</script><b> & $1$"
    text = view.page(data.assign_attrs(title=title))
    assert title not in text
    assert html.escape(title) in text
    run = json.loads(text.partition('id="run">')[2].partition("</script>")[0])
    assert (run["lean"] is None) is not motion.is_in_space(data)
    assert (run["view"] == [np.pi / 2, 0.0]) is not motion.is_in_space(data)  # along the axis
    assert len(run["time"]) == data.sizes["time"]
    assert len(run["force"]) == data["contact_force"].size
    assert "@" not in text.partition("<body>")[2].partition("<script")[0]
