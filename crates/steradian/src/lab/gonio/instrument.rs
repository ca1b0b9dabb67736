//! The instrument: from a sample and directions of incidence to readings of all cells.

use super::super::precision::{Precision, worse};
use super::super::probe::Probe;
use super::super::session::{Ending, Session, Tally};
use super::beam::{Face, Incidence};
use super::cells::CellGrid;
use super::census::{Census, Place};
use super::material::{self, Method, Setting};
use super::patch::Patch;
use super::reading::{Beam, CellFlux, Reading, Rest, Scattered};
use crate::bsdf::{Bsdf, Side};
use crate::spectrum::{LANES, Wavelengths};
use crate::units::Estimate;

/// A virtual goniophotometer.
#[derive(Clone, Debug)]
pub struct Goniometer {
    /// Where light is collected.
    pub grid: CellGrid,
    /// The side of the sample that light comes to.
    pub face: Face,
    /// Where light comes from, one after the other.
    pub incidence: Vec<Incidence>,
    /// How cells of a material are filled; a piece of geometry is counted always.
    pub method: Method,
    /// A cell that holds less than this share of the brightest one, in [0, 1], is as precise as if it held that much.
    pub dim: f64,
}

/// What is measured.
#[derive(Clone, Copy, Debug)]
pub enum Sample<'s, 'j> {
    /// A material on a flat, boundless patch.
    Material(&'s Probe<'j>),
    /// The geometry of a scene.
    Geometry(&'s Patch<'j>),
}

/// Wavelengths that are measured with the same rays.
struct Group<'s, 'j> {
    examined: Examined<'s, 'j>,
    lanes: usize,
}

enum Examined<'s, 'j> {
    Bsdf(Bsdf<'j>),
    Photons(&'s Patch<'j>, Wavelengths),
}

impl Goniometer {
    /// Measures each incidence at each wavelength [nm] until every cell is as precise as the session asks: the half-width of
    /// f̄ is at most the relative precision of f̄ or of [`Goniometer::dim`] times the largest f̄ of that incidence, wavelength
    /// and side, or the absolute precision [sr⁻¹]; and so for the flux of discrete directions, which has no absolute one.
    ///
    /// The session's most rays are those of one incidence and up to four wavelengths. For a material, `wavelengths` must be
    /// those of its probe.
    pub fn measure(&self, sample: Sample<'_, '_>, wavelengths: &[f32], session: &Session<'_>) -> Reading {
        let mut reading = Reading {
            grid: self.grid.clone(),
            face: self.face,
            method: matches!(sample, Sample::Material(_)).then_some(self.method),
            wavelengths: wavelengths.to_vec(),
            beams: Vec::with_capacity(self.incidence.len()),
            precision: session.precision,
            ending: Ending::Precise,
            rays: 0,
        };
        let mut groups = groups(sample, wavelengths, LANES);
        for (number, &incidence) in self.incidence.iter().enumerate() {
            if number > 0 && session.cancel.is_cancelled() {
                reading.ending = Ending::Cancelled;
                break;
            }
            let beam = match self.beam(&groups, number, incidence, session, &mut reading) {
                Some(beam) => beam,
                None => {
                    // Directions depend on the wavelength: each has rays of its own, now and from now on.
                    groups = self::groups(sample, wavelengths, 1);
                    self.beam(&groups, number, incidence, session, &mut reading)
                        .unwrap_or(Beam { incidence, spectra: Vec::new() })
                }
            };
            reading.beams.push(beam);
        }
        reading
    }

    /// `None` when several wavelengths cannot share rays.
    fn beam(
        &self,
        groups: &[Group<'_, '_>],
        number: usize,
        incidence: Incidence,
        session: &Session<'_>,
        reading: &mut Reading,
    ) -> Option<Beam> {
        let setting = Setting { grid: &self.grid, face: self.face, incidence, method: self.method };
        let mut spectra = Vec::new();
        for (i, group) in groups.iter().enumerate() {
            let stream = (number * groups.len() + i) as u64 * 2 + u64::from(self.face == Face::Back);
            let spoilt = |census: &Census| census.is_dispersive && group.lanes > 1;
            let outcome = session.run(
                stream,
                || Census::new(self.grid.len()),
                |census, block| match &group.examined {
                    Examined::Bsdf(bsdf) => material::block(census, block, bsdf, &setting),
                    Examined::Photons(patch, w) => patch.block(census, block, *w, &setting),
                },
                |census| if spoilt(census) { 0.0 } else { self.demand(census, group, &session.precision) },
            );
            if spoilt(&outcome.tally) {
                return None;
            }
            reading.rays += outcome.tally.rays();
            reading.ending = worst(reading.ending, outcome.ending);
            for lane in 0..group.lanes {
                spectra.push(self.scattered(&outcome.tally, outcome.blocks, group, lane, &session.precision));
            }
        }
        Some(Beam { incidence, spectra })
    }

    /// By how much the number of blocks must grow for the worst cell.
    fn demand(&self, census: &Census, group: &Group<'_, '_>, precision: &Precision) -> f64 {
        let bounds = census.bounds(precision);
        let mut worst = 0.0_f64;
        for lane in 0..group.lanes {
            for side in [Side::Reflection, Side::Transmission] {
                let f = |cell| {
                    let flux = census.share(Place::Cell(side, cell), lane, &bounds);
                    flux.scaled(1.0 / self.grid.projected_solid_angle(cell))
                };
                let discrete = |cell| census.share(Place::Discrete(side, cell), lane, &bounds);
                let flux_only = Precision { absolute: 0.0, ..*precision };
                worst = worse(worst, self.worst((0..self.grid.len()).map(f), precision));
                // What never arrived in a discrete direction is no direction.
                let found = (0..self.grid.len()).map(discrete).filter(|e| e.value > 0.0);
                worst = worse(worst, self.worst(found, &flux_only));
            }
        }
        worst
    }

    fn worst(&self, estimates: impl Iterator<Item = Estimate> + Clone, precision: &Precision) -> f64 {
        let brightest = estimates.clone().map(|e| e.value).fold(0.0, f64::max);
        let floor = precision.relative * self.dim * brightest;
        let with_floor = Precision { absolute: precision.absolute.max(floor), ..*precision };
        // With nothing anywhere there is nothing to be precise about.
        let wanted = estimates.filter(|_| brightest > 0.0);
        with_floor.worst_demand(wanted)
    }

    fn scattered(
        &self,
        census: &Census,
        blocks: u64,
        group: &Group<'_, '_>,
        lane: usize,
        precision: &Precision,
    ) -> Scattered {
        let bounds = census.bounds(precision);
        let share = |place| census.share(place, lane, &bounds);
        let cells = |side| -> Vec<CellFlux> {
            let of = |cell| {
                let discrete = share(Place::Discrete(side, cell));
                // The bound of what never arrived is that of the continuous part.
                let discrete = if discrete.value > 0.0 { discrete } else { Estimate::exact(0.0) };
                let continuous = share(Place::Cell(side, cell));
                let continuous = if group.is_continuous() { continuous } else { Estimate::exact(0.0) };
                CellFlux { continuous, discrete }
            };
            (0..self.grid.len()).map(of).collect()
        };
        let [reflectance, transmittance] =
            [Side::Reflection, Side::Transmission].map(|side| census.total(side, lane, precision));
        let passes = transmittance.value > 0.0 || group.transmits();
        let rest = matches!(group.examined, Examined::Photons(..)).then(|| Rest {
            absorbed: share(Place::Absorbed),
            lost: share(Place::Lost),
            edge: share(Place::Edge),
            sum: census.sum(lane, precision),
        });
        Scattered {
            reflected: cells(Side::Reflection),
            transmitted: if passes { cells(Side::Transmission) } else { Vec::new() },
            reflectance,
            transmittance,
            rest,
            blocks,
        }
    }
}

impl Group<'_, '_> {
    /// Whether anything but discrete directions can be scattered into.
    fn is_continuous(&self) -> bool {
        match self.examined {
            Examined::Bsdf(bsdf) => bsdf.lobes().is_continuous(),
            Examined::Photons(..) => true,
        }
    }

    /// Whether light may pass the sample in a continuum of directions.
    fn transmits(&self) -> bool {
        match self.examined {
            Examined::Bsdf(bsdf) => bsdf.lobes().transmission,
            Examined::Photons(..) => true,
        }
    }
}

fn groups<'s, 'j>(sample: Sample<'s, 'j>, wavelengths: &[f32], lanes: usize) -> Vec<Group<'s, 'j>> {
    match sample {
        Sample::Material(probe) => {
            probe.parts().map(|(bsdf, lanes)| Group { examined: Examined::Bsdf(*bsdf), lanes }).collect()
        }
        Sample::Geometry(patch) => {
            let group = |chunk: &[f32]| {
                let w = Wavelengths::exactly(std::array::from_fn(|i| chunk[i.min(chunk.len() - 1)]));
                Group { examined: Examined::Photons(patch, w), lanes: chunk.len() }
            };
            wavelengths.chunks(lanes).map(group).collect()
        }
    }
}

fn worst(a: Ending, b: Ending) -> Ending {
    match (a, b) {
        (Ending::Cancelled, _) | (_, Ending::Cancelled) => Ending::Cancelled,
        (Ending::RayLimit, _) | (_, Ending::RayLimit) => Ending::RayLimit,
        (Ending::Precise, Ending::Precise) => Ending::Precise,
    }
}
