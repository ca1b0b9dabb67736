#!/usr/bin/env python3
"""Writes the table of the clear-sky spectral model of Bird and Riordan under crates/steradian/data.

Run by hand, from the root of the repository, when the source changes; neither the build nor the tests need it:

    python3 -m venv /tmp/tables && /tmp/tables/bin/pip install pvlib==0.16.1
    /tmp/tables/bin/python xtask/tables/make_atmosphere.py

Prints the numbers that the test of crates/steradian/src/light/sky/atmosphere.rs expects, by pvlib's own implementation.
"""

import sys
from importlib.metadata import version
from pathlib import Path

import pvlib
import pvlib.spectrum  # noqa: F401

DATA = Path(__file__).resolve().parents[2] / "crates" / "steradian" / "data"
COLUMNS = ["wavelength", "spectral_irradiance_et", "water_vapor_absorption", "ozone_absorption", "mixed_absorption"]

# Apparent zenith angle, day of the year, pressure [Pa], water [cm], ozone [atm-cm], turbidity, exponent, albedo
CASES = [
    (48.19, 100, 101300.0, 1.42, 0.344, 0.27, 1.14, 0.2),
    (0.0, 3, 101300.0, 2.0, 0.30, 0.05, 1.3, 0.0),
    (80.0, 185, 84000.0, 0.5, 0.40, 0.10, 1.14, 0.6),
]
SHOWN = [300.0, 400.0, 450.0, 460.0, 550.0, 690.0, 762.5, 937.0, 1395.0, 2100.0, 4000.0]


def main():
    table = sys.modules["pvlib.spectrum.spectrl2"]._SPECTRL2_COEFFS
    rows = ",\n".join("    [" + ", ".join(f"{float(row[c])!r}" for c in COLUMNS) + "]" for row in table)
    about = [
        "Wavelength [nm], extraterrestrial irradiance [W m-2 nm-1], absorption by water vapour [cm-1], ozone [cm-1] and the",
        "uniformly mixed gases: Bird and Riordan, NREL Technical Report TR-215-2436 (1984), table 2-1.",
        f"Source: pvlib {version('pvlib')} (BSD-3-Clause).",
        "Written by xtask/tables/make_atmosphere.py.",
    ]
    (DATA / "clear_sky.rs").write_text("".join(f"// {line}\n" for line in about) + f"[\n{rows},\n]\n")

    for zenith, day, pressure, water, ozone, turbidity, alpha, albedo in CASES:
        airmass = pvlib.atmosphere.get_relative_airmass(zenith, model="kastenyoung1989")
        s = pvlib.spectrum.spectrl2(
            zenith, zenith, 0, albedo, pressure, airmass, water, ozone, turbidity, dayofyear=day, alpha=alpha
        )
        distance = pvlib.irradiance.get_extra_radiation(day, method="spencer", solar_constant=1) ** -0.5
        print(f"zenith {zenith}, distance {distance:.9f}:")
        wavelengths = list(s["wavelength"])
        for wavelength in SHOWN:
            i = wavelengths.index(wavelength)
            print(f"    ({wavelength}, {float(s['dni'][i].item()):.7e}, {float(s['dhi'][i].item()):.7e}),")


if __name__ == "__main__":
    main()
