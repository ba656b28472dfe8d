"""One run by the verb: its document, text and arrays, in the plane and in space."""

import html
import json
import re
from pathlib import Path

import numpy as np
import pytest
from cages import TURNING
from commands import SMALL, document
from matplotlib.figure import Figure
from scipy.integrate import quad

import separatrix
from separatrix.cage import run_ensemble, settings_for
from separatrix.front import main
from separatrix.ground.plain_data import Part, plain
from separatrix.present import draw, view
from separatrix.present.view import A_TURN, AROUND, MOST_FRAMES, frame_moments, scene
from separatrix.verbs.parts import run_pictures

SPACE = """
extends = "cryogenic-turbopump"
title = 'A cage in space & <b>"two lands"</b> </script> $1$'
[cage]
motion = "space"
ball = "damper"
ball_cage_friction = 0.2
guidance = "inner"
land_clearance = "0.5 mm"
land_count = 2
land_spacing = "10 mm"
inner_diameter = "60 mm"
outer_diameter = "70 mm"
width = "14 mm"
[stability]
kicks = ["0.5 m/s"]
tilt_kick = 1.0
axial_kick = 0.5
duration = "3 ms"
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with a simulation in the plane, and one in space."""
    place = tmp_path_factory.mktemp("runs")
    for name, text in (("small", SMALL), ("space", SPACE)):
        (place / f"{name}.toml").write_text(text)
        assert main(["simulate", str(place / f"{name}.toml"), "--out", str(place / name), "--quiet"]) == 0
    return place


@pytest.fixture(scope="module", params=["small", "space"])
def answered(request, folder):
    """Folder of an answer in the plane, and of one in space."""
    return folder / request.param


@pytest.fixture(scope="module")
def data(answered):
    """The arrays of the saved answer."""
    return separatrix.load(answered / "simulate.json")


pytestmark = pytest.mark.usefixtures("elsewhere")


def simulated(folder: Path, capsys, *options: str) -> dict:
    """Return the document of one run of the small study."""
    return document(capsys, "simulate", str(folder / "small.toml"), *options)


def words(text: str) -> str:
    """Return a text on one line."""
    return " ".join(text.split())


def test_kick_and_run_are_those_asked_for(folder, capsys):
    """By default the first run from the reference kick; another kick and run give another motion."""
    usual = simulated(folder, capsys)
    assert (usual["kick"], usual["run"]) == (0.502, 0)
    other = simulated(folder, capsys, "--run", "3")
    assert (other["kick"], other["run"]) == (0.502, 3)
    assert other["velocity"][0] != usual["velocity"][0]
    harder = simulated(folder, capsys, "--kick", "200 cm/s")
    assert harder["kick"] == 2.0
    # the same direction: energy goes as the square of the kick, in single precision
    expected = (2.0 / 0.502) ** 2 * usual["kinetic_energy"][0]
    assert harder["kinetic_energy"][0] == pytest.approx(expected, rel=1e-6)


def test_what_only_space_has_is_null_in_the_plane(answered):
    """And a whirl has a frequency where it lasts; the energy balances, and the impacts are shared out."""
    found = json.loads((answered / "simulate.json").read_text(), parse_constant=pytest.fail)
    is_flat, whirls = answered.name == "small", found["outcome"] in ("WHIRLS", "ROLLS")
    names = ("lean", "axial_place", "ball_axial", "largest_tilt")
    assert {(found[name] is None) for name in names} == {is_flat}
    assert {(found[name] is not None) for name in ("whirl_frequency", "whirl_speed")} == {whirls}
    assert (len(found["position"]), len(found["position"][0])) == (len(found["time"]), 2)
    assert found["energy_imbalance"] < 3e-3
    assert sum(found[f"{side}_share"] for side in ("front", "rear", "axial")) == pytest.approx(1.0)


def test_samples_have_the_peaks_of_the_engine_and_a_balance_of_work_and_energy(data):
    """Every other step of a short run is a sample, or each; energy is that of the start and work since."""
    for sampled in ("contact_force", "land_force"):
        most = float(data[f"largest_{sampled}"])
        assert 0.98 * most <= float(data[sampled].max()) <= most * (1.0 + 1e-6)
    offset = float(np.hypot(*data["position"].values.T).max())
    assert offset == pytest.approx(float(data["largest_offset"]), rel=1e-3)
    energy = data["kinetic_energy"].values + data["stored_energy"].values
    work = sum(data[name].values for name in data.data_vars if str(name).startswith("work_"))
    # to the error of a step
    assert energy - energy[0] == pytest.approx(work - work[0], abs=3e-3 * float(energy.max()))


def swept(time, place, rate):
    """Mean angular speed of a vector, weighted with its square: the area that it sweeps over its square."""
    turned = place[:, 0] * rate[:, 1] - place[:, 1] * rate[:, 0]
    return np.trapezoid(turned, time) / np.trapezoid(np.sum(place**2, axis=1), time)


def test_whirl_of_the_samples_is_that_of_the_engine(answered):
    """Orbit, cone and offset of the judged part, which the engine sums up step by step."""
    answer = separatrix.simulate(answered.with_suffix(".toml"))
    settings = settings_for(answer.study.stability, answer.cage)
    engine = run_ensemble(answer.cage, settings, kicks=[answer.kick], runs=1)
    run, turn = answer.history, answer.cage.cage_speed
    part = (run.time >= run.judged_from) & (run.time <= run.followed)
    orbit = swept(run.time[part], run.position[part], run.velocity[part])
    # Trapezoids over samples of two steps are off by 1.7e-5, 8e-5 and 1.8e-6 as measured: three times that.
    assert run.orbit_speed == engine.orbit_speed[0, 0]
    assert run.orbit_speed == pytest.approx(orbit + turn, abs=5e-5 * turn)
    # 1.8e-6 measured, three times that: samples stand two steps apart
    assert run.mean_offset == pytest.approx(np.hypot(*run.position[part].T).mean(), rel=6e-6)
    if answer.cage.is_in_space:
        cone = swept(run.time[part], run.lean[part], run.lean_rate[part])
        assert run.cone_speed == pytest.approx(cone + turn, abs=2.5e-4 * turn)


def test_a_whirl_is_followed_for_fifty_turns_and_its_force_means_nothing_beyond_the_races(folder):
    """Its frequency and speed in the document and in the text; no digits of a force that no ball can take."""
    (folder / "whirl.toml").write_text(SMALL.replace("= 0.1", '= 0.6\nball = "traction"', 1))
    answer = separatrix.simulate(folder / "whirl.toml", kick=2.0)
    assert answer.notes
    found, text = answer.document(), words(answer.summary())
    assert found["outcome"] == "WHIRLS"
    assert found["time"][-1] * found["whirl_frequency"] > 49.0
    assert 0.1 < found["whirl_speed"] < 100.0
    assert re.search(r"Whirl \d\S* k?Hz (forward|backward), seen from the balls; the centre moves at", text)
    assert found["force_exceeds_races"] is (found["largest_contact_force"] > found["force_limit"])
    assert found["force_limit"] == pytest.approx(95.7 / 0.6, rel=0.01)
    assert re.search(r"Pocket force, largest above (159.5|160) N, whose friction is all that", text)


def test_a_whirl_whose_forces_pass_the_races_is_followed_among_free_balls(folder):
    """One state has no meaning there: outcome, forces and signs are those of the ball that decides."""
    (folder / "decided.toml").write_text(SMALL.replace("= 0.1", "= 0.6"))
    answer = separatrix.simulate(folder / "decided.toml", kick=2.0)
    assert answer.cage.free_ball is not None
    assert answer.history.outcome is answer.signs.signs_outcome
    assert not answer.force_exceeds_races
    assert "Ball free: with one state the motion lasts with forces above" in words(answer.summary())


def test_a_ball_that_leaves_its_pocket_is_named_with_its_time(folder):
    """A wall that ends 0.2 mm from the balls' equator, and a strong kick: the run decides nothing."""
    walls = '[cage]\ninner_diameter = "64.6 mm"\nouter_diameter = "75 mm"\nwidth = "14 mm"'
    (folder / "edge.toml").write_text(SMALL.replace("[cage]", walls))
    found = separatrix.simulate(folder / "edge.toml", kick=2.0)
    assert (found.history.outcome.name, found.history.cause.name) == ("UNRESOLVED", "LEFT_POCKET")
    assert 1 <= found.history.left_ball <= 13
    said = f"Ball {found.history.left_ball} reaches the edge of its pocket's wall at "
    assert said in words(found.summary())


@pytest.mark.usefixtures("undrawn")
@pytest.mark.parametrize("motion", ["plane", "space"])
def test_balls_that_their_races_grip_have_an_infinite_damping(folder, capsys, motion):
    """A restitution factor of 1, the end of a map's axis: null in the document."""
    (folder / "moved.toml").write_text(SMALL.replace("[cage]", f'[cage]\nmotion = "{motion}"'))
    asked = ["simulate", str(folder / "moved.toml"), "--restitution-factor", "1"]
    assert main([*asked, "--out", "gripped", "--quiet"]) == 0
    found = json.loads(Path("gripped/simulate.json").read_text())
    assert found["cage"]["race_damping"] is None
    assert found["chain"]["race_damping"] > 0.0
    assert not [one for one in found["warnings"] if "not finite" in one]
    assert found["given_restitution_factor"] == 1.0


# The page of `simulate`: what its pictures and the moving cage show, and when.

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
    own = {"cage_speed": 600.0, "ball_diameter": 0.0111, "land_width": 3e-3, "guidance": guidance}
    own |= {"land_clearance": clearance, "axial_half_play": 0.5 * play if space else None}
    document["cage"] = plain(TURNING, left_out=[]) | own | cage
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
    # of a course in time the least and the largest of each part are drawn, with the first and the last
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
    # of spheres by a circle, and off their balls by what lies in all three
    ball = run(count=3, pocket_shape="spherical", pocket_radial_offset=0.0)
    np.testing.assert_allclose(run_pictures.pocket_boundary(ball), 3e-4, rtol=1e-12)  # rounding
    off = run(count=3, pocket_shape="spherical", pocket_radial_offset=4e-4)  # a sphere of 0.5 mm
    assert run_pictures.pocket_boundary(off).min() == pytest.approx(1e-4)
