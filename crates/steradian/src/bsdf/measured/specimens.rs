//! Small measurements of surfaces that are known in closed form.

use super::goniometer::GoniometerTable;
use super::merl::{self, MerlTable};
use super::rgl::RglTable;
use super::table::MeasuredTable;
use super::tabulate::{Azimuths, Nodes, tabulate};
use crate::math::{LocalDir, Vec3, warp::spherical_direction};
use crate::optics::{TrowbridgeReitz, fresnel};
use std::f32::consts::FRAC_1_PI;

/// Wavelengths [nm] at which specimens are examined: on a node, between nodes, and beyond both ends.
pub(super) const WAVELENGTHS: [f32; 4] = [550.0, 365.0, 607.0, 820.0];

/// A table with a name for reports.
#[derive(Clone, Debug)]
pub struct Synthetic {
    /// The name.
    pub name: &'static str,
    /// The table.
    pub table: MeasuredTable,
}

/// A rough metal with single scattering: f = D F G / (4 cosθo cosθi), as tarnished copper.
#[derive(Clone, Copy, Debug)]
pub(super) struct Metal(pub(super) TrowbridgeReitz);

impl Metal {
    /// Its optical constants at `lambda` [nm]: smooth, and near those of copper.
    fn index(lambda: f32) -> [f32; 2] {
        let red = 1.0 / (1.0 + (-(lambda - 575.0) / 15.0).exp());
        [1.2 - 0.9 * red, 2.5 + 0.004 * (lambda - 500.0)]
    }

    /// f [sr⁻¹] between directions above the surface.
    pub(super) fn f(&self, wo: LocalDir, wi: LocalDir, lambda: f32) -> f32 {
        let Some(m) = LocalDir::new(*wo + *wi) else { return 0.0 };
        let [eta, k] = Self::index(lambda);
        0.25 * self.0.d(m) * self.0.g_over_cosines(wo, wi) * fresnel::conductor(wo.dot(*m), eta, k)
    }
}

/// A `.bsdf` file of [`Metal`].
pub(super) fn metal_file(facets: TrowbridgeReitz, nodes: &Nodes) -> Vec<u8> {
    tabulate(&facets, nodes, |wo, wi, lambda| Metal(facets).f(wo, wi, lambda))
}

pub(super) fn nodes(azimuths: Azimuths, facets: usize) -> Nodes {
    Nodes {
        theta: 8,
        azimuths,
        facets,
        directions: 32,
        wavelengths: vec![380.0, 450.0, 500.0, 550.0, 600.0, 650.0, 700.0, 780.0],
    }
}

/// A `.binary` file of a metal with little gloss over a coloured diffuse base.
pub(super) fn merl_file(extents: merl::Extents) -> Vec<u8> {
    let metal = Metal(TrowbridgeReitz::new(0.25, 0.25));
    merl::write(extents, |wo, wi| {
        let gloss = 0.3 * metal.f(wo, wi, 550.0);
        [0.4, 0.25, 0.1].map(|diffuse| diffuse * FRAC_1_PI + gloss)
    })
}

/// Angles [°] and wavelengths [nm] of a goniometer table.
#[derive(Clone, Debug)]
pub(super) struct Angles {
    pub(super) theta_i: Vec<f32>,
    pub(super) phi_i: Vec<f32>,
    pub(super) theta_o: Vec<f32>,
    pub(super) phi_o: Vec<f32>,
    pub(super) wavelengths: Vec<f32>,
}

/// `n` angles [°] from `first` to `last`.
pub(super) fn spread(n: usize, first: f32, last: f32) -> Vec<f32> {
    (0..n).map(|i| first + (last - first) * i as f32 / (n - 1).max(1) as f32).collect()
}

/// The text of a goniometer table of f(light, seen, λ) [sr⁻¹].
pub(super) fn goniometer_text(angles: &Angles, f: impl Fn(LocalDir, LocalDir, f32) -> f32) -> String {
    let mut lines = vec!["theta_i [deg],phi_i [deg],theta_o [deg],phi_o [deg]".to_owned()];
    for lambda in &angles.wavelengths {
        lines[0] += &format!(",f_{lambda}nm [1/sr]");
    }
    let direction = |theta: f32, phi: f32| {
        let w = spherical_direction(theta.to_radians(), phi.to_radians());
        // A right angle in degrees is slightly more than one in radians, in floats.
        LocalDir::new_unchecked(Vec3::new(w.x, w.y, if theta <= 90.0 { w.z.max(1e-4) } else { w.z }))
    };
    for &ti in &angles.theta_i {
        for &pi in &angles.phi_i {
            for &to in &angles.theta_o {
                for &po in &angles.phi_o {
                    let mut line = format!("{ti},{pi},{to},{po}");
                    for &lambda in &angles.wavelengths {
                        line += &format!(",{}", f(direction(ti, pi), direction(to, po), lambda));
                    }
                    lines.push(line);
                }
            }
        }
    }
    lines.join("\n")
}

/// A frosted sheet: a rough metal's gloss at a third, and a wide lobe of transmission.
pub(super) fn frosted(facets: TrowbridgeReitz) -> impl Fn(LocalDir, LocalDir, f32) -> f32 {
    move |light, seen, lambda| {
        if seen.z > 0.0 {
            0.1 * FRAC_1_PI + Metal(facets).f(seen, light, lambda) / 3.0
        } else {
            // Straight on is brightest.
            let straight = (-light.dot(*seen)).max(0.0);
            0.4 * FRAC_1_PI * straight * straight * lambda / 700.0
        }
    }
}

/// Goniometer tables of frosted sheets, unchanged by turning or not.
pub(super) fn frosted_texts() -> [String; 2] {
    let isotropic = Angles {
        theta_i: spread(8, 0.0, 84.0),
        phi_i: vec![0.0],
        theta_o: spread(31, 0.0, 180.0),
        phi_o: spread(19, 0.0, 180.0),
        wavelengths: vec![400.0, 550.0, 700.0],
    };
    let brushed = Angles {
        theta_i: spread(6, 0.0, 80.0),
        phi_i: spread(8, 0.0, 315.0),
        theta_o: spread(10, 0.0, 90.0),
        phi_o: spread(24, 0.0, 345.0),
        wavelengths: vec![420.0, 690.0],
    };
    [
        goniometer_text(&isotropic, frosted(TrowbridgeReitz::new(0.5, 0.5))),
        goniometer_text(&brushed, frosted(TrowbridgeReitz::new(0.4, 0.8))),
    ]
}

/// The specimens of the conformance suite.
pub fn tables() -> Vec<Synthetic> {
    let mut all = Vec::new();
    // What the project writes, it reads (tested); a specimen that it did not read would be missing in reports.
    let mut add =
        |name, table: Option<MeasuredTable>| all.extend(table.map(|table| Synthetic { name, table }));
    for (name, ax, ay, azimuths, facets) in [
        ("measured rgl rough 0.03", 0.03, 0.03, Azimuths::Isotropic, 64),
        ("measured rgl rough 0.3", 0.3, 0.3, Azimuths::Isotropic, 32),
        ("measured rgl rough 1", 1.0, 1.0, Azimuths::Isotropic, 32),
        ("measured rgl brushed", 0.15, 0.6, Azimuths::Quarter(5), 32),
    ] {
        let file = metal_file(TrowbridgeReitz::new(ax, ay), &nodes(azimuths, facets));
        add(name, RglTable::parse(&file).ok().map(MeasuredTable::Rgl));
    }
    let merl = merl_file(merl::Extents { theta_h: 30, theta_d: 30, phi_d: 36 });
    add("measured merl", MerlTable::parse(&merl).ok().map(MeasuredTable::Merl));
    let names = ["measured goniometer frosted", "measured goniometer brushed"];
    for (name, text) in names.into_iter().zip(frosted_texts()) {
        add(name, GoniometerTable::parse(text.as_bytes()).ok().map(MeasuredTable::Goniometer));
    }
    all
}
