#!/usr/bin/env python3
"""Writes crates/steradian/data/cie_receptors.rs: V'(lambda) and the alpha-opic action spectra of CIE S 026:2018.

Run by hand, from the root of the repository, when a source changes; neither the build nor the tests need it:

    python3 -m venv /tmp/tables && /tmp/tables/bin/pip install colour-science==0.4.7 && \\
        /tmp/tables/bin/pip install --no-deps pyplr==1.0.3
    /tmp/tables/bin/python xtask/tables/make_receptors.py

The S-, M- and L-cone-opic action spectra are the 10-degree cone fundamentals of CIE 170-1 (Stockman & Sharpe 2000), from 390
nm, and the rhodopic one is V'; all three come from colour-science, with more digits. The melanopic one is pyplr's.
"""

import ast
import importlib.util
import warnings
from importlib.metadata import version
from pathlib import Path

warnings.filterwarnings("ignore")
import colour  # noqa: E402

DATA = Path(__file__).resolve().parents[2] / "crates" / "steradian" / "data"
SCRIPT = "xtask/tables/make_receptors.py"


def pyplr_table():
    """Wavelength: S, M, L, rods, melanopsin. Read from the source, since pyplr imports far more than it needs here."""
    folder = Path(importlib.util.find_spec("pyplr").submodule_search_locations[0])
    tree = ast.parse((folder / "CIE.py").read_text())
    function = next(n for n in ast.walk(tree) if isinstance(n, ast.FunctionDef) and n.name == "get_CIES026")
    lists = [n for n in ast.walk(function) if isinstance(n, (ast.List, ast.Tuple)) and len(n.elts) == 401 * 6]
    # Where the standard has no number there is an attribute, np.nan.
    numbers = [e.value if isinstance(e, ast.Constant) else 0.0 for e in lists[0].elts]
    return {int(r[0]): r[1:] for r in zip(*[iter(numbers)] * 6)}


def main():
    published = pyplr_table()
    cones = colour.MSDS_CMFS["Stockman & Sharpe 10 Degree Cone Fundamentals"]
    lms = {int(l): row for l, row in zip(cones.wavelengths, cones.values)}
    scotopic = colour.colorimetry.SDS_LEFS_SCOTOPIC["CIE 1951 Scotopic Standard Observer"]
    rods = {int(l): float(v) for l, v in zip(scotopic.wavelengths, scotopic.values)}
    rows = []
    for l in range(380, 781):
        long, medium, short = (float(v) for v in lms.get(l, (0.0, 0.0, 0.0)))
        row = [rods[l], short, medium, long, float(published[l][4])]
        for ours, theirs in zip(row, [published[l][3], *published[l][:3], published[l][4]]):
            # pyplr rounds to five digits or 1e-7, rods to three digits.
            assert abs(ours - theirs) <= 6e-5 * ours + 1e-7 + 6e-4 * (ours == rods[l]), (l, ours, theirs)
        rows.append(row)
    about = [
        "V'(lambda) (rhodopic), S-, M- and L-cone-opic and melanopic action spectra, 380-780 nm at 1 nm (CIE S 026:2018).",
        f"Source: colour-science {version('colour-science')} (BSD-3-Clause); melanopic: pyplr {version('pyplr')} (MIT).",
        f"Written by {SCRIPT}.",
    ]
    body = ",\n".join("    [" + ", ".join(f"{v!r}" for v in row) + "]" for row in rows)
    (DATA / "cie_receptors.rs").write_text("".join(f"// {a}\n" for a in about) + f"[\n{body},\n]\n")


if __name__ == "__main__":
    main()
