"""The film of a run: what it draws, when, and that it leaves no half file."""

from __future__ import annotations

import html
import json
import sys
from types import SimpleNamespace

import drawn
import numpy as np
import pytest
from PIL import Image
from scipy.integrate import quad

from separatrix.errors import InputError
from separatrix.figures import animation, cage_page, motion, scene
from separatrix.figures.animation import animate
from separatrix.figures.motion import A_TURN, MOST_FRAMES, frame_moments

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


def with_film(data, **options):
    """The scene of all samples."""
    return scene.scene(data, np.arange(data.sizes["time"]), **options)


@pytest.mark.parametrize("data", ODD.values(), ids=ODD.keys())
def test_a_gif_is_written_for_any_run(data, tmp_path):
    """Each sample a frame here, reported one by one; nothing else stays in the folder."""
    reported = []
    animate(data, tmp_path / "a.gif", kind="gif", progress=lambda *args: reported.append(args))
    assert [path.name for path in tmp_path.iterdir()] == ["a.gif"]
    count = data.sizes["time"]
    assert reported == [(i + 1, count) for i in range(count)]
    with Image.open(tmp_path / "a.gif") as film:
        assert (film.n_frames, film.size) == (count, (760, 480))


def test_colours_of_a_gif_are_kept():
    """White and all that is drawn with."""
    colours = [tuple(round(255 * c) for c in animation.to_rgb(colour)) for colour in animation.DRAWN]
    image = Image.new("RGB", (len(colours) + 1, 1), "white")
    for place, colour in enumerate(colours):
        image.putpixel((place, 0), colour)
    kept = image.quantize(palette=animation.palette(), dither=Image.Dither.NONE).convert("RGB")
    # Pillow looks a colour up in cells of 8 of 256 steps
    assert np.abs(np.asarray(kept).astype(int) - np.asarray(image).astype(int)).max() <= 8


def test_an_interrupt_leaves_no_half_file_and_the_older_one(tmp_path):
    """Ctrl-C at the second frame: the older film is there to the last byte, and nothing else."""
    (tmp_path / "a.gif").write_bytes(b"older")

    def stop(done, total):
        if done == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        animate(SMALL, tmp_path / "a.gif", kind="gif", progress=stop)
    assert [path.read_bytes() for path in tmp_path.iterdir()] == [b"older"]


def encoder(fail=None):
    """An encoder that writes what it is sent, or fails."""

    def write_frames(path, size, **options):
        with open(path, "wb") as file:
            while True:
                frame = yield
                if fail is not None:
                    raise fail
                file.write(frame)

    return SimpleNamespace(write_frames=write_frames)


@pytest.mark.parametrize(
    ("name", "kind", "installed", "words"),
    [
        ("a.avi", "avi", encoder(), "must be gif or mp4"),
        ("film", None, encoder(), "must be gif or mp4"),
        ("film.avi", None, encoder(), "must be gif or mp4"),
        ("a.mp4", "mp4", None, r"separatrix\[animation\]"),
        ("a.mp4", None, encoder(OSError("no program\nat all")), "could not be encoded"),
    ],
)
def test_what_cannot_be_written_is_refused_in_one_line(name, kind, installed, words, tmp_path, monkeypatch):
    """An unknown kind, an extra that is not installed, an encoder that fails: no file."""
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", installed)
    with pytest.raises(InputError, match=words) as raised:
        animate(SMALL, tmp_path / name, kind=kind)
    assert "\n" not in str(raised.value)
    assert not list(tmp_path.iterdir())


def test_the_ending_of_the_file_is_the_kind(tmp_path, monkeypatch):
    """An MP4 gets every frame, three bytes for each point; endings in capitals are known."""
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", encoder())
    animate(SMALL, tmp_path / "a.mp4")
    assert (tmp_path / "a.mp4").stat().st_size == 4 * 3 * 760 * 480
    animate(SMALL.isel(time=[0]), tmp_path / "film.GIF")
    assert (tmp_path / "film.GIF").read_bytes().startswith(b"GIF89a")


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
    steps, shown = np.diff(data["time"].values[moments]), animation.shown_parts(data, moments)
    assert (steps > 1 / (A_TURN * whirl)).sum() == parts - 1  # the cut
    assert len(shown) == parts
    assert (shown[0][0], shown[-1][1]) == pytest.approx((0.0, 10.0))
    assert animation.notes(data, scene.scene(data, moments), moments)[-1].startswith("Shown: 0 to")


@pytest.mark.parametrize("data", [*(whirling(20_000, whirl) for whirl in (50e3, 2e3)), LONG])
def test_frames_are_few_and_run_from_start_to_end(data):
    """However many samples: rising, with the first and the last."""
    moments = frame_moments(data)
    assert MOST_FRAMES / 2 < moments.size <= MOST_FRAMES
    assert (np.diff(moments) > 0).all()
    assert (moments[0], moments[-1]) == (0, data.sizes["time"] - 1)


def test_a_picture_says_how_many_times_too_large_movements_are():
    """Number for number, and how time runs; a film of few moments has the force between them."""
    moments = np.array([0, 3])
    seen = scene.scene(SMALL, moments)
    assert f"enlarged {seen.enlarged:g} times" in animation.notes(SMALL, seen, moments)[3]
    assert seen.force[1].max() == seen.largest[0] == 20.0
    assert animation.notes(SMALL, seen, moments)[1] == "Land: grey to red, 0 to 7 N."


def test_a_wall_meets_its_ball_when_the_pocket_touches():
    """A cage moved by the play along the ball's tangent: bar and ball meet in the enlarged picture."""
    still = drawn.run(samples=1, count=13)
    seen = with_film(still.assign(position=still["position"] * 0.0 + [0.0, 3e-4]))
    assert seen.enlarged > 2
    wall = seen.moved(np.append(scene.ring(seen.radius, -seen.reaches()[:1])[0], 0.0), 0)
    # rounding: tangent to the ball that lies at (R, 0)
    assert wall[1] == pytest.approx(-seen.ball, rel=1e-9)
    bars = seen.faces()[-13 * scene.BAR_POINTS :]
    last = np.arctan2(bars[-1, 1, 1], bars[-1, 1, 0])  # the end of the bar behind ball 0
    assert last == pytest.approx(-seen.reaches()[0], rel=1e-9)


@pytest.mark.parametrize(("guidance", "side"), [("outer", 1), ("inner", -1)])
def test_the_cage_meets_its_land_when_it_touches(guidance, side):
    """At an offset of the gap the surface of the cage reaches the land, outside and inside."""
    data = drawn.run(samples=1, guidance=guidance)
    seen = with_film(data.assign(position=data["position"] * 0.0 + [5e-4, 0.0]))
    reached = seen.moved(np.array([[side * seen.land, 0.0, 0.0]]), 0)
    # rounding
    assert side * reached[0, 0] == pytest.approx(seen.land_radius, rel=1e-12)


def test_in_the_plane_the_picture_is_seen_along_the_axis():
    """With x to the right and y upward, as in the orbit; in space from above, and the lean moves the edge."""
    points = np.array([[1.0, 2.0, 3.0]])
    assert animation.seen(points, with_film(SMALL).view, 0.0)[0] == pytest.approx(points[:, :2])
    seen = with_film(SPACE)
    assert animation.seen(points, seen.view, 0.0)[1] > 0.0
    rim = np.array([seen.radius, 0.0, 0.0])
    expected = seen.axial[0] - seen.radius * seen.lean[0, 0]
    assert seen.moved(rim, 0)[2] == pytest.approx(seen.enlarged * expected)


def test_the_ball_set_turns_by_the_integral_of_its_speed():
    """With a ramp from a fifth of the speed over 4 of 10 ms; without one, speed times time."""
    assert scene.turned_by(SMALL).tolist() == pytest.approx((600.0 * SMALL["time"].values).tolist())
    ramped = drawn.run(samples=6, cage_ramp_time=4e-3, cage_ramp_start=0.2)

    def speed(t):
        return 600.0 * (0.2 + 0.8 * min(t / 4e-3, 1.0))

    expected = [quad(speed, 0.0, t, points=[4e-3])[0] for t in ramped["time"].values]
    # quadrature
    assert scene.turned_by(ramped).tolist() == pytest.approx(expected, rel=1e-9)


def test_in_the_fixed_frame_the_picture_turns_with_the_ball_set():
    """Balls by the angle of the ball set, and nothing else changes."""
    fixed = with_film(SMALL, fixed=True)
    assert fixed.frame.tolist() == scene.turned_by(SMALL).tolist()
    places = fixed.ball_places(2)
    shown, _ = animation.seen(places, fixed.view, fixed.frame[2])
    # rounding
    assert scene.turned(places[:, :2], fixed.frame[2]) == pytest.approx(shown, abs=1e-12)


def test_a_ball_of_unknown_size_fills_three_quarters_of_its_place():
    """A cage by itself has no diameter of its balls."""
    assert with_film(drawn.run(samples=1, cage_ball_diameter=0.0)).ball == pytest.approx(
        0.375 * 2 * np.pi * 0.0325 / 5
    )
    assert with_film(SMALL).ball == 0.5 * 0.0111


@pytest.mark.parametrize("data", [SMALL, SPACE, drawn.run(samples=1, guidance="ball")])
def test_a_page_has_its_run_as_numbers_and_escapes_the_study(data):
    """Under a megabyte; tilt only in space; a study's text ends no script."""
    title = "</script><b> & $1$"
    text = cage_page.page(data.assign_attrs(title=title))
    assert title not in text
    assert html.escape(title) in text
    run = json.loads(text.partition('id="run">')[2].partition("</script>")[0])
    assert (run["lean"] is None) is not motion.is_in_space(data)
    assert len(run["time"]) == data.sizes["time"]
    assert len(run["force"]) == data["contact_force"].size
    assert "@" not in text.partition("<body>")[2].partition("<script")[0]
