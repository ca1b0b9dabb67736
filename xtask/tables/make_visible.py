#!/usr/bin/env python3
"""Prints the density of wavelengths of crates/steradian/src/spectrum/visible.rs.

Run by hand, from the root of the repository; neither the build nor the tests need it. Needs numpy, takes minutes.

Four wavelengths, a quarter of the distribution apart, estimate the sRGB and the luminance of a spectrum. What is minimised is
the mean logarithm of one plus the relative variance of these estimates over random reflectances (sigmoids of quadratics, as
colours of scenes become) under white, thermal light and daylight, and to a small part the same of one wavelength alone, which
is what dispersion leaves of a path. Colours whose channels nearly vanish are left out.
"""

import re
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
LAMBDA = np.arange(360, 831.0)
KNOTS = np.linspace(360, 830, 48)
FINE = np.linspace(360, 830, 941)
LANES = 4
# Rows of sRGB from XYZ.
SRGB = np.array(
    [
        [3.2404542, -1.5371385, -0.4985314],
        [-0.9692660, 1.8760108, 0.0415560],
        [0.0556434, -0.2040259, 1.0572252],
    ]
)


def matching():
    text = (ROOT / "crates/steradian/data/cie_1931_2deg.rs").read_text()
    text = re.sub(r"//.*", "", text)
    numbers = [float(x) for x in re.findall(r"-?\d+\.?\d*(?:[eE][-+]?\d+)?", text)]
    bars = np.array(numbers[: 3 * 471]).reshape(471, 3) / 106.857
    return np.concatenate([bars @ SRGB.T, bars[:, 1:2]], axis=1)


def thermal(kelvin):
    power = lambda l: l**-5 / (np.exp(1.4388e7 / (l * kelvin)) - 1)
    return power(LAMBDA) / power(560.0)


def spectra(channels):
    rng = np.random.default_rng(1)
    found = []
    while len(found) < 160:
        c2, c1, c0 = rng.normal(0, 6), rng.normal(0, 4), rng.normal(0, 1.5)
        t = (LAMBDA - 550) / 235
        x = c2 * t * t + c1 * t + c0
        reflectance = 0.5 + x / (2 * np.sqrt(1 + x * x))
        if rng.random() < 0.3:  # two bounces
            reflectance = reflectance**2
        light = [1.0, 1.0, thermal(3000.0), thermal(6500.0)][rng.integers(4)]
        color = channels[:, :3].T @ (reflectance * light)
        if color.min() > 0.02 * color.max():
            found.append(reflectance * light)
    return np.array(found + [np.ones(471)] * 15 + [thermal(2800.0)] * 5)


CHANNELS = matching()
SPECTRA = spectra(CHANNELS)
# Wavelengths by channels of spectra.
VALUES = (SPECTRA[:, :, None] * CHANNELS[None]).transpose(1, 0, 2).reshape(471, -1)
MEAN = VALUES.sum(0)
COLORS = MEAN.reshape(-1, 4)
SQUARE = (COLORS**2 + (0.02 * COLORS.max(1, keepdims=True)) ** 2).reshape(-1)
U = (np.arange(96) + 0.5) / 96


def noise(logarithm):
    density = np.exp(np.clip(np.interp(FINE, KNOTS, logarithm), -12, 6))
    cumulative = np.concatenate([[0], np.cumsum((density[1:] + density[:-1]) / 2)])
    total = cumulative[-1]
    estimate, single = 0, 0
    for lane in range(LANES):
        drawn = np.interp((U + lane / LANES) % 1, cumulative / total, FINE)
        x = drawn - 360
        i = np.minimum(x.astype(int), 469)
        t = (x - i)[:, None]
        pdf = np.interp(drawn, FINE, density / (total * 0.5))[:, None]
        value = (VALUES[i] * (1 - t) + VALUES[i + 1] * t) / pdf
        estimate = estimate + value / LANES
        single = single + (value**2).mean(0) / LANES
    together = ((estimate - MEAN) ** 2).mean(0) / SQUARE
    smooth = np.sum(np.diff(logarithm, 2) ** 2)
    return np.log1p(together).mean() + 0.03 * np.log1p(single / SQUARE).mean() + 2e-4 * smooth


def main():
    rgb = np.abs(CHANNELS[:, :3]) / CHANNELS[:, :3].sum(0)
    start = np.sqrt((rgb**2).sum(1)) ** 0.5
    start = start + 0.05 * start.mean()
    x = np.log(np.interp(KNOTS, LAMBDA, start / start.max()))
    # Adam (Kingma & Ba 2015) on finite differences.
    first, second = np.zeros_like(x), np.zeros_like(x)
    best = (noise(x), x)
    for step in range(1, 300):
        here = noise(x)
        if here < best[0]:
            best = (here, x.copy())
        slope = np.array([(noise(x + 1e-3 * e) - noise(x - 1e-3 * e)) / 2e-3 for e in np.eye(len(x))])
        first = 0.9 * first + 0.1 * slope
        second = 0.98 * second + 0.02 * slope * slope
        rate = 0.04 * min(1.0, 30.0 / step)
        x = x - rate * (first / (1 - 0.9**step)) / (np.sqrt(second / (1 - 0.98**step)) + 1e-5)
    density = np.exp(best[1])
    print((density / density.max()).round(3).tolist())
    print("log noise", best[0], "of the eye's density", noise(-2 * np.log(np.cosh(0.0072 * (KNOTS - 538)))))


if __name__ == "__main__":
    main()
