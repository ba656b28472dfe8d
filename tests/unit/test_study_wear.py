"""[film.wear] and [traction] in study files: every form, and what is refused where."""

import commands
import pytest
from commands import refusal_line
from test_study_refusals import VALID

from separatrix.ground.errors import InputError
from separatrix.study.keys import with_values
from separatrix.study.reading import read_study
from separatrix.study.sources import resolved
from separatrix.study.study import ContactPressure, PressureSlip, TractionModel, Wear, Worn
from separatrix.verdict.parameter_axes import value_in, varied

BAND = '[film.wear]\nwidth = "0.2 mm"\nfriction = 0.3\n'
PLACES = '[film.wear]\nacross = ["-0.1 mm", "0.1 mm"]\nthicknesses = ["0 um", "0.2 um"]\nfriction = 0.3\n'


def written(folder, section):
    """Path of the valid study with a section more, before [cage]."""
    return commands.written(folder, VALID.replace("[cage]\n", f"{section}\n[cage]\n", 1))


@pytest.mark.parametrize(
    ("section", "wear"),
    [
        (BAND, Wear(width=2e-4, friction=0.3)),
        (
            '[film.wear]\nshare = 0.1\nthickness = "50 nm"\nfriction = 0.3\nraces = "Inner race"\n',
            Wear(share=0.1, thickness=5e-8, friction=0.3, races=Worn.INNER),
        ),
        (PLACES, Wear(across=(-1e-4, 1e-4), thicknesses=(0.0, 2e-7), friction=0.3)),
    ],
)
def test_each_form_of_wear_is_read(section, wear, tmp_path):
    """In SI, with the origin of each key."""
    study = read_study(written(tmp_path, section))
    assert study.film.wear == wear
    found = resolved(study)["film"]
    assert found["wear.races"]["value"] == wear.races.value
    assert found["wear.friction"]["value"] == 0.3
    assert found["wear.friction"]["origin"].startswith("study.toml, line ")


NO_SENSE = [
    ("[film.wear]\nshare = 2\nfriction = 0.3\n", "[film] wear.share must lie between 0 and 1; got 2"),
    (BAND + "share = 0.1\n", "[film] wear.share and width exclude each other"),
    (BAND + '[traction]\npressure = "coated"\n', '[traction] pressure must be "hertz" where the film is'),
]


@pytest.mark.parametrize(("section", "words"), NO_SENSE)
def test_what_makes_no_sense_is_refused_in_a_line(section, words, tmp_path):
    """File, line, key, rule, value; others are in reader_mutants.json."""
    message = refusal_line(written(tmp_path, section))
    assert message.startswith("study.toml, line ")
    assert words in message


def test_traction_is_read(tmp_path):
    """Strips with Hertz's pressure by default."""
    section = '[traction]\nmodel = "exact"\npressure = "coated"\npressure_slip = "included"\n'
    found = read_study(written(tmp_path, section)).traction
    assert found.model is TractionModel.EXACT
    assert found.pressure is ContactPressure.COATED
    assert found.pressure_slip is PressureSlip.INCLUDED
    plain = read_study(written(tmp_path, "")).traction
    assert plain.model is TractionModel.STRIPS


def test_numbers_of_wear_may_be_uncertain_and_varied(tmp_path):
    """By the name film.wear.width."""
    study = read_study(written(tmp_path, BAND.replace('"0.2 mm"', '"0.2 mm +- 10 %"')))
    assert study.distributions["film.wear.width"].mean == pytest.approx(2e-4)
    for change in (with_values, varied):
        assert change(study, {"film.wear.width": 3e-4}).film.wear.width == 3e-4
    assert value_in(study, "film.wear.width") == pytest.approx(2e-4)
    whole = read_study(written(tmp_path, ""))
    assert value_in(whole, "film.wear.width") is None
    with pytest.raises(InputError, match=r"\[film\] has no wear that could vary"):
        varied(whole, {"film.wear.share": 0.1})
