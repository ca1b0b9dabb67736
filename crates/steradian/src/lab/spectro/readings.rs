//! What the spectrophotometer found.

use super::setup::{Face, Incidence, Setup};
use super::sphere::{Beams, SphereReading};
use crate::lab::plot::{Axis, Chart, Curve, Dash, Drawing, series_ink};
use crate::lab::precision::Precision;
use crate::lab::session::Ending;
use crate::lab::table::{Cell, Column, Table};
use crate::units::Estimate;

/// Shares of the light that falls on the sample, at one wavelength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Wavelength [nm].
    pub wavelength: f32,
    /// How light falls on the sample.
    pub incidence: Incidence,
    /// The share that leaves on the side of the light, B (2.14).
    pub reflectance: Estimate,
    /// The share that leaves on the other side, B (2.15).
    pub transmittance: Estimate,
    /// The share that ends in the material: counted where photons end, or 1 − ρ − τ of a closed form.
    pub absorptance: Estimate,
    /// All three together, where they were counted apart: one, unless light is made or lost.
    pub sum: Option<Estimate>,
    /// Reflected flux in the viewing cone over that from a perfect diffuser, B (2.16).
    pub factor: Option<Estimate>,
    /// What the sphere reads, for a beam.
    pub sphere: Option<SphereReadings>,
}

/// What a sphere that is not ideal reads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphereReadings {
    /// Of the reflectance.
    pub reflectance: SphereReading,
    /// Of the transmittance.
    pub transmittance: SphereReading,
}

/// The readings of one material.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    /// The material's name.
    pub material: String,
    /// What was asked for.
    pub setup: Setup,
    /// Wavelength after wavelength, for one incidence after the other.
    pub readings: Vec<Reading>,
    /// Whether photons were counted.
    pub by_sampling: bool,
    /// The precision that was asked for, with the floor that was used.
    pub precision: Precision,
    /// Seed of the photons.
    pub seed: u64,
    /// Photons; each carries up to four wavelengths.
    pub rays: u64,
    /// Why no more were taken.
    pub ending: Ending,
    /// Whether some photon counted more than once or not at all.
    pub unbalanced: bool,
}

impl Spectrum {
    /// One row for each reading.
    pub fn table(&self) -> Table {
        let share = |name: &str| Column::new(name, "1");
        let mut columns = vec![
            Column::new("wavelength", "nm"),
            Column::new("incidence", "°"),
            share("reflectance"),
            share("transmittance"),
            share("absorptance"),
            share("R + T + A"),
        ];
        if self.setup.view.is_some() {
            columns.push(share("reflectance factor"));
        }
        let has_sphere = self.readings.iter().any(|r| r.sphere.is_some());
        if has_sphere {
            columns.extend(
                ["R as read", "R as read / true", "T as read", "T as read / true"].into_iter().map(share),
            );
        }
        let mut table = Table::new(format!("spectrophotometer: material \"{}\"", self.material), columns);
        let optional = |e: Option<Estimate>| e.map_or(Cell::Missing, Cell::from);
        for r in &self.readings {
            let mut row: Vec<Cell> = vec![f64::from(r.wavelength).into(), incidence(r.incidence)];
            row.extend([r.reflectance, r.transmittance, r.absorptance].map(Cell::from));
            row.push(optional(r.sum));
            if self.setup.view.is_some() {
                row.push(optional(r.factor));
            }
            if has_sphere {
                let of = |f: fn(&SphereReadings) -> Estimate| optional(r.sphere.as_ref().map(f));
                row.push(of(|s| s.reflectance.reading));
                row.push(of(|s| s.reflectance.ratio));
                row.push(of(|s| s.transmittance.reading));
                row.push(of(|s| s.transmittance.ratio));
            }
            table.rows.push(row);
        }
        self.facts(&mut table);
        table
    }

    fn facts(&self, table: &mut Table) {
        table.fact(
            "quantities",
            "shares of the power that falls on the sample: directional-hemispherical for a beam, bihemispherical for diffuse light",
        );
        if let Some(view) = self.setup.view {
            let (theta, phi, cone) = (view.direction.theta, view.direction.phi, view.half_angle);
            table.fact(
                "reflectance factor",
                format!("flux in a cone of half-angle {cone}° about θ = {theta}°, φ = {phi}°, over that from a perfect diffuser"),
            );
        }
        if let Some(s) = self.setup.sphere {
            let beams = match s.beams {
                Beams::Single => "single beam: sample and standard in turn",
                Beams::Double => "double beam: the error of substitution is removed",
            };
            table.fact(
                "sphere",
                format!(
                    "{beams}; wall {}, port {} of the area, standard {}, multiplier {}",
                    s.wall,
                    s.port,
                    s.standard,
                    Estimate::exact(s.multiplier())
                ),
            );
        }
        if !self.by_sampling {
            table.fact("method", "closed form; absorptance is what is missing from one");
            return;
        }
        table.fact(
            "method",
            "photons, absorbed ones counted where they end; wavelengths share photons by fours",
        );
        if self.unbalanced {
            table.fact(
                "balance",
                "samples of this material weigh more than one photon at times: R + T + A shows the excess, \
                 which a material without gain absorbs less",
            );
        }
        let Precision { relative, absolute, confidence, .. } = self.precision;
        let [confidence, relative] = [confidence, relative].map(|share| Estimate::exact(100.0 * share));
        table.fact("confidence", format!("{confidence} %, statistical only; exact for counts"));
        table.fact("precision", format!("{relative} % of the value, or ±{}", Estimate::exact(absolute)));
        table.fact("rays", self.rays.to_string());
        table.fact("ending", self.ending.name());
        table.fact("seed", self.seed.to_string());
    }

    /// Reflectance, transmittance and absorptance over wavelength, in one colour for each incidence.
    pub fn drawing(&self) -> Drawing {
        let mut curves = Vec::new();
        for (i, &incidence) in self.setup.incidences.iter().enumerate() {
            let ink = series_ink(i);
            let suffix = if self.setup.incidences.len() > 1 {
                format!(", {}", words(incidence))
            } else {
                String::new()
            };
            let points = |f: fn(&Reading) -> f64| {
                let of = self.readings.iter().filter(|r| r.incidence == incidence);
                of.map(|r| [f64::from(r.wavelength), f(r)]).collect::<Vec<_>>()
            };
            curves.push(Curve::new(format!("R{suffix}"), ink, points(|r| r.reflectance.value)));
            let t = Curve::new(format!("T{suffix}"), ink, points(|r| r.transmittance.value));
            curves.push(t.dashed(Dash::Dashed));
            let a = Curve::new(format!("A{suffix}"), ink, points(|r| r.absorptance.value));
            curves.push(a.dashed(Dash::Dotted));
        }
        let only = match self.setup.incidences.as_slice() {
            [only] => format!(", {}", words(*only)),
            _ => String::new(),
        };
        let chart = Chart {
            title: format!("{}{only}", self.material),
            x: Axis::new("wavelength [nm]"),
            y: Axis::new("share of the incident power [1]").including(&[0.0, 1.0]),
            curves,
        };
        chart.draw()
    }
}

fn incidence(incidence: Incidence) -> Cell {
    match incidence {
        Incidence::Beam(angles) => angles.theta.into(),
        Incidence::Diffuse(_) => Cell::Text(words(incidence)),
    }
}

fn words(incidence: Incidence) -> String {
    match incidence {
        Incidence::Beam(angles) => format!("{}°", angles.theta),
        Incidence::Diffuse(Face::Above) => "diffuse".to_owned(),
        Incidence::Diffuse(Face::Below) => "diffuse-below".to_owned(),
    }
}
