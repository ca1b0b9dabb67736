//! Light on a sample, wavelength by wavelength.

use super::counts::{Count, Fate, Ledger, Quantity};
use super::readings::{Reading, Spectrum, SphereReadings};
use super::setup::{Face, Incidence, Method, Setup, SpectroError, View};
use crate::bsdf::{Bsdf, Mode, Side};
use crate::lab::precision::{Precision, worse};
use crate::lab::probe::Probe;
use crate::lab::session::{Block, Ending, Session};
use crate::lab::subject::Subject;
use crate::math::hash::{self, Pcg32};
use crate::math::{LocalDir, Vec2, Vec3, warp};
use crate::optics::quadrature::gauss;
use crate::spectrum::LANES;
use crate::units::Estimate;

/// Photons of a block.
const PHOTONS: u64 = 256;

/// Shares below a hundredth of the light are measured as precisely as that one, unless a floor is given: what is not reflected
/// at all has no relative precision.
const SMALL: f64 = 0.01;

/// Puts the material into the spectrophotometer.
///
/// # Errors
/// When the settings make no sense, or the material cannot be measured in that way. The wavelengths are the caller's care: see
/// [`Subject::range`].
pub fn measure(
    subject: &Subject<'_>,
    setup: &Setup,
    session: &Session<'_>,
) -> Result<Spectrum, SpectroError> {
    setup.check()?;
    let probe = Probe::new(subject, &setup.wavelengths)?;
    let is_closed = probe.parts().all(|(bsdf, _)| bsdf.closed_albedo(LocalDir::Z).is_some());
    let by_sampling = match setup.method {
        Method::Sampled => true,
        Method::Auto => !is_closed || setup.view.is_some(),
        Method::Exact if !is_closed => return Err(SpectroError::NoClosedForm(subject.name().to_owned())),
        Method::Exact => false,
    };
    let Precision { relative, absolute, .. } = session.precision;
    let floor = if absolute > 0.0 { absolute } else { SMALL * relative };
    let precision = Precision { absolute: floor, ..session.precision };
    let mut bench = Bench {
        probe,
        session: Session { precision, ..*session },
        by_sampling,
        stream: 0,
        rays: 0,
        ending: Ending::Precise,
        unbalanced: false,
    };
    let n = setup.wavelengths.len();
    let spheres = setup.sphere.map(|sphere| {
        let below = |bench: &mut Bench<'_, '_>| bench.all(Incidence::Diffuse(Face::Below), None);
        (sphere, [bench.all(Incidence::Diffuse(Face::Above), None), below(&mut bench)])
    });
    let mut readings = Vec::with_capacity(n * setup.incidences.len());
    for &incidence in &setup.incidences {
        let found = bench.all(incidence, setup.view);
        for (i, (&wavelength, f)) in setup.wavelengths.iter().zip(found).enumerate() {
            let sphere = spheres.as_ref().and_then(|(sphere, [above, below])| {
                // The beam's side, and the side that looks into the sphere when light comes through.
                let (front, back) = match incidence {
                    Incidence::Diffuse(_) => return None,
                    Incidence::Beam(a) if a.theta < 90.0 => (above.get(i)?, below.get(i)?),
                    Incidence::Beam(_) => (below.get(i)?, above.get(i)?),
                };
                Some(SphereReadings {
                    reflectance: sphere.reflectance(f.reflectance, front.reflectance),
                    transmittance: sphere.transmittance(f.transmittance, back.reflectance),
                })
            });
            readings.push(Reading {
                wavelength,
                incidence,
                reflectance: f.reflectance,
                transmittance: f.transmittance,
                absorptance: f.absorptance,
                sum: f.sum,
                factor: f.viewed.zip(setup.view).map(|(e, v)| e.scaled(1.0 / v.of_perfect_diffuser())),
                sphere,
            });
        }
        if session.cancel.is_cancelled() {
            break;
        }
    }
    Ok(Spectrum {
        material: subject.name().to_owned(),
        setup: setup.clone(),
        readings,
        by_sampling,
        precision,
        seed: session.seed,
        rays: bench.rays,
        ending: bench.ending,
        unbalanced: bench.unbalanced,
    })
}

/// What became of the light at one wavelength.
#[derive(Clone, Copy, Debug)]
struct Found {
    reflectance: Estimate,
    transmittance: Estimate,
    absorptance: Estimate,
    sum: Option<Estimate>,
    viewed: Option<Estimate>,
}

/// The sample in place, and what it has cost so far.
struct Bench<'j, 's> {
    probe: Probe<'j>,
    session: Session<'s>,
    by_sampling: bool,
    stream: u64,
    rays: u64,
    ending: Ending,
    unbalanced: bool,
}

impl<'j> Bench<'j, '_> {
    /// All wavelengths, or as many as there is time for.
    fn all(&mut self, incidence: Incidence, view: Option<View>) -> Vec<Found> {
        let parts: Vec<(Bsdf<'j>, usize)> = self.probe.parts().map(|(bsdf, lanes)| (*bsdf, lanes)).collect();
        let mut all = Vec::new();
        for (bsdf, lanes) in parts {
            match self.by_sampling {
                true => all.extend(self.sampled(&bsdf, lanes, incidence, view)),
                false => all.extend(exact(&bsdf, lanes, incidence)),
            }
            if self.session.cancel.is_cancelled() {
                break;
            }
        }
        all
    }

    fn sampled(
        &mut self,
        bsdf: &Bsdf<'j>,
        lanes: usize,
        incidence: Incidence,
        view: Option<View>,
    ) -> Vec<Found> {
        let precision = self.session.precision;
        let cone = view.map(Cone::new);
        let scale = view.map_or(1.0, |v| 1.0 / v.of_perfect_diffuser());
        let block = |ledger: &mut Ledger, block: Block| {
            let mut counts = [Count::default(); LANES];
            photons(bsdf, incidence, cone.as_ref(), block, &mut counts);
            ledger.close(PHOTONS, &counts);
        };
        let fates = [Fate::Reflected, Fate::Transmitted, Fate::Absorbed].map(Quantity::Fate);
        let demand = |ledger: &Ledger| {
            let of = |lane: usize| {
                let shares = fates.iter().map(|q| ledger.estimate(lane, *q, &precision));
                let viewed =
                    cone.is_some().then(|| ledger.estimate(lane, Quantity::Viewed, &precision).scaled(scale));
                precision.worst_demand(shares.chain(viewed))
            };
            (0..lanes).map(of).fold(0.0, worse)
        };
        self.stream += 1;
        let outcome = self.session.run(self.stream, Ledger::default, block, demand);
        let ledger = &outcome.tally;
        self.rays += outcome.blocks * PHOTONS;
        if outcome.ending != Ending::Precise {
            self.ending = outcome.ending;
        }
        let found = |lane: usize| {
            let [reflectance, transmittance, absorptance] =
                fates.map(|q| ledger.estimate(lane, q, &precision));
            let sum = Some(ledger.estimate(lane, Quantity::Sum, &precision));
            let viewed = cone.as_ref().map(|_| ledger.estimate(lane, Quantity::Viewed, &precision));
            Found { reflectance, transmittance, absorptance, sum, viewed }
        };
        self.unbalanced |= (0..lanes).any(|lane| ledger.is_unbalanced(lane));
        (0..lanes).map(found).collect()
    }
}

/// A block of photons. One photon carries all wavelengths of the scattering function, and ends at each by itself.
fn photons(
    bsdf: &Bsdf<'_>,
    incidence: Incidence,
    cone: Option<&Cone>,
    block: Block,
    counts: &mut [Count; LANES],
) {
    let mut rng = Pcg32::new(block.seed, 0);
    for i in 0..PHOTONS {
        let mut pair = || Vec2::new(rng.next_f32(), rng.next_f32());
        let from = match incidence {
            Incidence::Beam(angles) => angles.direction(),
            Incidence::Diffuse(face) => {
                let up = warp::cosine_hemisphere(pair());
                if face == Face::Above { up } else { -up }
            }
        };
        let u = pair();
        let (uc, roulette) = (rng.next_f32(), rng.next_f32());
        // Random walks inside of the material are new for each photon.
        let bsdf = bsdf.with_seed(hash::combine(block.seed, i));
        // Power that goes from the light towards sensors.
        let Some(s) = bsdf.sample(from, uc, u, Mode::Importance) else {
            counts.iter_mut().for_each(Count::absorb);
            continue;
        };
        let fate = match s.side {
            Side::Reflection => Fate::Reflected,
            Side::Transmission => Fate::Transmitted,
        };
        let viewed = fate == Fate::Reflected && cone.is_some_and(|c| c.holds(s.wi, from));
        for (count, weight) in counts.iter_mut().zip(s.weight.to_array()) {
            count.book(fate, weight, viewed, roulette);
        }
    }
}

/// The directions that a detector sees.
struct Cone {
    axis: LocalDir,
    /// The squared chord that its edge makes with the axis: exact for narrow cones, of which the cosine rounds to one.
    chord2: f32,
}

impl Cone {
    fn new(view: View) -> Self {
        let chord = 2.0 * (0.5 * view.half_angle.to_radians()).sin();
        Self { axis: view.direction.direction(), chord2: (chord * chord) as f32 }
    }

    /// Whether a direction is inside; for light from below the cone is turned below.
    fn holds(&self, w: LocalDir, from: LocalDir) -> bool {
        let axis = if from.z < 0.0 { Vec3::new(self.axis.x, self.axis.y, -self.axis.z) } else { *self.axis };
        (axis - *w).length_squared() <= self.chord2
    }
}

/// The closed form; for diffuse light its mean, with the azimuth left out: closed forms do not know one.
fn exact(bsdf: &Bsdf<'_>, lanes: usize, incidence: Incidence) -> Vec<Found> {
    let (mut r, mut t) = ([0.0_f64; LANES], [0.0_f64; LANES]);
    let mut add = |from: LocalDir, weight: f64| {
        let Some(albedo) = bsdf.closed_albedo(from) else { return };
        for lane in 0..lanes {
            r[lane] += weight * f64::from(albedo.reflectance[lane]);
            t[lane] += weight * f64::from(albedo.transmittance[lane]);
        }
    };
    match incidence {
        Incidence::Beam(angles) => add(angles.direction(), 1.0),
        Incidence::Diffuse(face) => {
            // ∫ 2 μ ρ(μ) dμ over μ = u², which smooths the grazing end; narrow panels contain the kink at a critical angle.
            for panel in 0..PANELS {
                let [from, to] = [panel, panel + 1].map(|i| f64::from(i) / f64::from(PANELS));
                for node in gauss(4, from, to) {
                    let mu = node.x * node.x;
                    let z = if face == Face::Above { mu } else { -mu };
                    let from = Vec3::new((1.0 - mu * mu).max(0.0).sqrt() as f32, 0.0, z as f32);
                    add(LocalDir::new_unchecked(from), node.weight * 4.0 * mu * node.x);
                }
            }
        }
    }
    let found = |lane: usize| Found {
        reflectance: Estimate::exact(r[lane]),
        transmittance: Estimate::exact(t[lane]),
        // Nothing is absorbed where rounding alone says so.
        absorptance: Estimate::exact(Some(1.0 - r[lane] - t[lane]).filter(|a| a.abs() > 5e-7).unwrap_or(0.0)),
        sum: None,
        viewed: None,
    };
    (0..lanes).map(found).collect()
}

/// Makes the error at such a kink some 1e-5.
const PANELS: u32 = 1024;
