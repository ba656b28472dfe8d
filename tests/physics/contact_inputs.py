"""Input files with the numbers of CONTACT's public examples, eve70a/CONTACT, examples/*.inp; written anew."""

MATERIALS = "0.28 0.28 82000. 82000.  POISS 1,2, GG 1,2"
ITERATIONS = "100 100 30 1 1e-5  MAXGS, MAXIN, MAXNR, MAXOUT, EPS"


def case(digits, *lines):
    """One case of module 3: its control words, the solver's numbers if G = 0, and the lines after them."""
    solver = [ITERATIONS] if digits.split()[2][-6] == "0" else []
    return "\n".join([" 3 MODULE", *digits.split(), *solver, *lines]) + "\n"


def end(*cases):
    """The cases as the text of a file."""
    return "% numbers of a public example of CONTACT\n" + "".join(cases) + " 0 MODULE\n"


CATTANEO = end(
    case(
        "200100 022020 0000331", "9.1954 0 0 0", "0.4 0.4", "0.42 0.42 200. 200.", "-3", "19 19 1. 1. 1.26667"
    ),
    case(
        "201120 022020 0101541",
        "9.1954 -0.8750 0 0  FN, FX, FY, CPHI",
        "0.4 0.4",
        "0.42 0.42 200. 200.",
        "1",
        "19 19 -1.26667 -1.26667 .13333 .13333",
        "1 1",
        "0.01 0. 0.01 0. 0. 0.",
    ),
)

CARTER = end(
    case(
        "203100 022020 0001541",
        "35780. -0.00024 0. 0.",
        "0.3 0.3",
        "0.0 0.0401 30000.  CHI, DQ, VELOC",
        MATERIALS,
        "3",
        "55 1 -1.05 0. 0.04 200.",
        "1 1",
        "0.001 0. 0. 0. 0. 0.",
    )
)

BENTALL = end(
    case(
        "203100 022020 0000011",
        "16201.9 0.00052 0. 0.",
        "0.0001 0.0001",
        "180.0d 0.001 1000.",
        "0.31 0.28 23000. 82000.",
        "1",
        "216 1 -0.108 -500. 0.001 1000.",
        "1 1",
        "0.02 0. 0. 0. 0. 0.",
    ),
    *(
        case("203110 000000 0011341", f"16201.9 {force} 0. 0.  FN, FX, CETA, CPHI", f"{mu} {mu}")
        for force, mu in ((0.0, 0.0001), (0.0, 0.05), (0.75, 0.05), (-0.75, 0.05))
    ),
)

TRACTION_CURVE = end(
    case(
        "203100 022020 0000341",
        "106700. 0.00001 0. 0.",
        "0.33 0.33",
        "0. 0.5 10000.",
        MATERIALS,
        "-2",
        "48 44 0.0008 0.5 1.1  MX, MY, A1, AOB, SCALE",
    ),
    *(case("203100 100000 0100341", f"106700. {xi} 0. 0.") for xi in (4e-4, 8e-4, 1.2e-3, 1.6e-3)),
    case(
        "203100 102400 0100341",
        "106700. 0.00001 0. 0.",
        "0. 0.5 10000.",
        MATERIALS,
        "8200. 1.25 0. 0.  GG3, LAYTHK, TAU_C0, K_TAU",
    ),
)


def fastsim(cells=44):
    """Case 1 of the example, on `cells` elements a side over 1.1 times the contact."""
    return end(
        case(
            "203100 022020 0001341",
            "82000. 0. -0.000625 0.000625",
            "0.3 0.3",
            "0. 0.4 30000.",
            MATERIALS,
            "-3",
            f"{cells} {cells} 8. 4. 1.1",
        )
    )


def from_cattaneo_to_carter(steps=56, turned=False):
    """A shift under 0.657 of sliding, then rolling under this force, one column a case; also towards -x."""
    sign, chi = ("", "180d") if turned else ("-", "0.")
    area = ("1", "34 33 -4.125 -4.125 0.25 0.25", "1 1", "0.002963 0. 0.002963 0. 0. 0.")
    force = f"0.4705 {sign}0.657 0. 0."
    return end(
        case("201110 022020 0001341", force, "0.4013 0.4013", "0.28 0.28 1. 1.", *area),
        case("002110 102000 0011341", force, f"{chi} 0.25 1000.", "0.28 0.28 1. 1."),
        *(case("002110 100000 0010141", force) for _ in range(steps - 1)),
    )
