#!/usr/bin/env python3
"""Writes the tables of colorimetry under crates/steradian/data: the test colours of CIE 13.3 and more illuminants.

Run by hand, from the root of the repository, when a source changes; neither the build nor the
tests need it:

    python3 -m venv /tmp/tables && /tmp/tables/bin/pip install colour-science==0.4.7
    /tmp/tables/bin/python xtask/tables/make_colorimetry.py

With --goldens it prints what colour-science makes of its illuminants, for the tests.
"""

import sys
import warnings
from importlib.metadata import version
from pathlib import Path

warnings.filterwarnings("ignore")
import colour  # noqa: E402
from colour.quality.datasets.tcs import DATA_TCS_CIE1995  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
DATA = ROOT / "crates" / "steradian" / "data"
CARRIER = f"colour-science {version('colour-science')} (BSD-3-Clause)"
SCRIPT = "xtask/tables/make_colorimetry.py"

ILLUMINANTS = {
    "C": "CIE illuminant C, relative spectral power.",
    "D55": "CIE illuminant D55, relative spectral power.",
    "D75": "CIE illuminant D75, relative spectral power.",
    **{f"HP{i}": f"CIE high-pressure discharge lamp HP{i}, relative spectral power." for i in range(1, 6)},
    **{
        f"LED-{i}": f"CIE LED illuminant LED-{i}, relative spectral power (CIE 15:2018)."
        for i in ("B1", "B2", "B3", "B4", "B5", "BH1", "RGB1", "V1", "V2")
    },
}


def number(x, digits=7):
    """The shortest decimal that keeps `digits` significant digits."""
    return f"{x:.{digits}g}"


def test_colours():
    names = [f"TCS{i:02}" for i in range(1, 15)]
    samples = [DATA_TCS_CIE1995[name] for name in names]
    grid = [360 + 5 * i for i in range(95)]
    assert all(sorted(s) == grid for s in samples)
    lines = [
        "// Spectral radiance factors of the test colours 1 to 14 of CIE 13.3-1995, one row each, 360-830 nm at 5 nm.",
        f"// Source: {CARRIER}.",
        f"// Written by {SCRIPT}.",
        "[",
    ]
    for sample in samples:
        values = [repr(float(sample[l])) for l in grid]
        lines.append("    [")
        for i in range(0, len(values), 16):
            lines.append("        " + ", ".join(values[i : i + 16]) + ",")
        lines.append("    ],")
    lines.append("]")
    (DATA / "cie_test_colours.rs").write_text("\n".join(lines) + "\n")


def illuminants():
    for key, about in ILLUMINANTS.items():
        sd = colour.SDS_ILLUMINANTS[key]
        lines = [f"# {about}", f"# Source: {CARRIER}.", f"# Written by {SCRIPT}.", "# wavelength [nm], value"]
        lines += [f"{number(l)} {number(v)}" for l, v in zip(sd.wavelengths, sd.values)]
        (DATA / "spectra" / f"stdillum-{key}.spd").write_text("\n".join(lines) + "\n")


def goldens():
    keys = ["A", "C", "D50", "D55", "D65", "D75", *(f"FL{i}" for i in range(1, 13))]
    for key in [*keys, *(k for k in ILLUMINANTS if k not in keys)]:
        sd = colour.SDS_ILLUMINANTS[key]
        xyz = colour.sd_to_XYZ(sd, method="Integration")
        x, y = colour.XYZ_to_xy(xyz)
        cct, duv = colour.temperature.uv_to_CCT_Ohno2013(colour.UCS_to_uv(colour.XYZ_to_UCS(xyz)))
        cri = colour.quality.colour_rendering_index(sd, additional_data=True)
        special = ", ".join(f"{cri.Q_as[i].Q_a:.2f}" for i in range(1, 9))
        print(f'("{key}", {x:.5f}, {y:.5f}, {cct:.1f}, {duv:.5f}, {cri.Q_a:.2f}, [{special}]),')
    chips = colour.SDS_COLOURCHECKERS["BabelColor Average"]
    for chip in ("dark skin", "foliage", "white 9.5 (.05 D)"):
        xyz = colour.sd_to_XYZ(chips[chip], illuminant=colour.SDS_ILLUMINANTS["D65"], method="Integration")
        print(chip, list(zip(chips[chip].wavelengths, chips[chip].values)), xyz / 100)


if __name__ == "__main__":
    if "--goldens" in sys.argv:
        goldens()
    else:
        test_colours()
        illuminants()
