//! Reads the scattering of a material at chosen directions and wavelengths, as numbers with their uncertainty.

use super::subject::Subject;
use crate::bsdf::interface::Interface;
use crate::bsdf::{Bsdf, BsdfSample, Mode, Side};
use crate::math::float::ONE_MINUS_EPSILON;
use crate::math::hash::{self, Pcg32};
use crate::math::{LocalDir, Vec2, Vec3};
use crate::spectrum::{LANES, Wavelengths};
use crate::units::Estimate;

/// Half-width of a 95 % interval in standard errors of a mean of many.
const NORMAL_95: f64 = 1.959_964;

/// Seed of the random walks: the same question has the same answer.
const SEED: u64 = 0x5eed_f00d;

/// A direction by its angles in the local frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Angles {
    /// Angle to the normal [degrees], in [0, 180]; above 90 is below the surface.
    pub theta: f64,
    /// Azimuth from ∂p/∂u [degrees].
    pub phi: f64,
}

impl Angles {
    /// The unit direction. Angles that are whole multiples of 90° give exact zeros.
    pub fn direction(self) -> LocalDir {
        let part = |x: f64| if x.abs() < 1e-15 { 0.0 } else { x as f32 };
        let ((st, ct), (sp, cp)) = (self.theta.to_radians().sin_cos(), self.phi.to_radians().sin_cos());
        LocalDir::new_unchecked(Vec3::new(part(st * cp), part(st * sp), part(ct)))
    }

    /// The angles of a direction, φ in [0, 360).
    pub fn of(w: LocalDir) -> Self {
        let (x, y, z) = (f64::from(w.x), f64::from(w.y), f64::from(w.z));
        let sin = x.hypot(y);
        // At the pole the azimuth says nothing.
        let phi = if sin < 1e-7 { 0.0 } else { y.atan2(x).to_degrees().rem_euclid(360.0) };
        Self { theta: sin.atan2(z).to_degrees(), phi }
    }
}

/// ρ and τ at one wavelength, see [`Bsdf::albedo`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AlbedoReading {
    /// Share of the power that is reflected.
    pub reflectance: f64,
    /// Share of the power that is transmitted.
    pub transmittance: f64,
}

/// What scatters from one direction into another, at one wavelength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// f [sr⁻¹], in the mode that was asked for.
    pub f: Estimate,
    /// Density of `wi` in sampling for `wo` [sr⁻¹].
    pub pdf: f64,
    /// Scattering probability function for light from `wi` [sr⁻¹]: the share of the scattered power that goes to `wo`
    /// per solid angle, f·|cosθo| / (ρ + τ), B (2.20); integrates to 1 over all `wo`, discrete directions included.
    /// `None` where nothing is scattered.
    pub s: Option<Estimate>,
    /// ρ and τ for light from `wi`.
    pub albedo: AlbedoReading,
}

/// A discrete direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Discrete {
    /// The direction.
    pub direction: LocalDir,
    /// Ratio of power, times the scale of radiance where radiance is transported through a refraction.
    pub ratio: f64,
    /// Side that it leaves to.
    pub side: Side,
}

/// Why nothing can be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ProbeError {
    /// Each point has one of several materials.
    #[error("material \"{name}\" is a mix of {parts}: ask for one of these")]
    Mix {
        /// The material.
        name: String,
        /// Those that it mixes.
        parts: String,
    },
    /// Light passes straight.
    #[error("material \"{0}\" is a mere boundary of media: it scatters nothing")]
    Boundary(String),
}

/// A material at a list of wavelengths.
#[derive(Clone, Debug)]
pub struct Probe<'j> {
    parts: Vec<Part<'j>>,
}

/// Wavelengths that one scattering function carries, in its first lanes.
#[derive(Clone, Copy, Debug)]
struct Part<'j> {
    bsdf: Bsdf<'j>,
    lanes: usize,
}

impl<'j> Probe<'j> {
    /// Prepares the material at each of the wavelengths [nm].
    ///
    /// # Errors
    /// For materials that have no scattering function of their own.
    pub fn new(subject: &Subject<'j>, wavelengths: &[f32]) -> Result<Self, ProbeError> {
        let nothing = || {
            let parts: Vec<_> = subject.parts().iter().map(|p| format!("\"{}\"", p.name())).collect();
            match parts.is_empty() {
                true => ProbeError::Boundary(subject.name().to_owned()),
                false => ProbeError::Mix { name: subject.name().to_owned(), parts: parts.join(" and ") },
            }
        };
        let mut parts = Vec::new();
        for chunk in wavelengths.chunks(LANES) {
            let mut w = Wavelengths::exactly(std::array::from_fn(|i| chunk[i.min(chunk.len() - 1)]));
            let bsdf = subject.scatterer(&mut w, SEED).ok_or_else(nothing)?;
            if !w.companions_terminated() {
                parts.push(Part { bsdf, lanes: chunk.len() });
                continue;
            }
            // Directions depend on the wavelength: only the first lane counts.
            for &lambda in chunk {
                let mut w = Wavelengths::exactly([lambda; LANES]);
                parts.push(Part { bsdf: subject.scatterer(&mut w, SEED).ok_or_else(nothing)?, lanes: 1 });
            }
        }
        Ok(Self { parts })
    }

    /// The scattering functions in the order of the wavelengths, each with the number of its lanes that count.
    pub fn parts(&self) -> impl Iterator<Item = (&Bsdf<'j>, usize)> {
        self.parts.iter().map(|p| (&p.bsdf, p.lanes))
    }

    /// Whether values are estimates by random walks.
    pub fn is_estimated(&self) -> bool {
        self.parts.iter().any(|p| p.bsdf.claims().is_random())
    }

    /// Whether light may pass to the other side in a continuum of directions.
    pub fn transmits(&self) -> bool {
        self.parts.iter().any(|p| p.bsdf.lobes().transmission)
    }

    /// Whether anything is scattered into a continuum of directions.
    pub fn is_continuous(&self) -> bool {
        self.parts.iter().any(|p| p.bsdf.lobes().is_continuous())
    }

    /// f [sr⁻¹] at each wavelength; the mean of `walks` (at least 2) values where it is estimated.
    pub fn f(&self, wo: LocalDir, wi: LocalDir, mode: Mode, walks: u32) -> Vec<Estimate> {
        self.parts.iter().flat_map(|p| p.f(wo, wi, mode, walks)).collect()
    }

    /// ρ and τ for light from `wi` at each wavelength.
    pub fn albedo(&self, wi: LocalDir) -> Vec<AlbedoReading> {
        let read = |p: &Part<'j>| {
            let a = p.bsdf.albedo(wi);
            let [r, t] = [a.reflectance, a.transmittance].map(|x| x.to_array().map(f64::from));
            let at = move |lane| AlbedoReading { reflectance: r[lane], transmittance: t[lane] };
            (0..p.lanes).map(at).collect::<Vec<_>>()
        };
        self.parts.iter().flat_map(read).collect()
    }

    /// Everything about a pair of directions, at each wavelength; `walks` as for [`Probe::f`], `albedo` is that for
    /// `wi`, which many pairs may share.
    pub fn read(
        &self,
        wo: LocalDir,
        wi: LocalDir,
        mode: Mode,
        walks: u32,
        albedo: &[AlbedoReading],
    ) -> Vec<Reading> {
        let pdfs = self.parts.iter().flat_map(|p| vec![f64::from(p.bsdf.pdf(wo, wi, mode).0); p.lanes]);
        // Scattered power over arriving power is what radiance does: s has no other mode.
        let physical = self.f(wo, wi, Mode::Radiance, walks);
        let f = if mode == Mode::Radiance { physical.clone() } else { self.f(wo, wi, mode, walks) };
        let cos = f64::from(wo.abs_cos_theta());
        let rows = f.into_iter().zip(pdfs).zip(physical).zip(albedo);
        rows.map(|(((f, pdf), physical), &albedo)| {
            let total = albedo.reflectance + albedo.transmittance;
            let s = (total > 0.0).then(|| physical.scaled(cos / total));
            Reading { f, pdf, s, albedo }
        })
        .collect()
    }

    /// The discrete directions that the known direction `w` scatters into, at each wavelength: with
    /// [`Mode::Radiance`] those that light seen from `w` comes from, with [`Mode::Importance`] those that light from `w`
    /// goes to.
    ///
    /// Ratios are exact to f32 for closed forms, and means of 65 536 random walks for others.
    pub fn discrete(&self, w: LocalDir, mode: Mode) -> Vec<Vec<Discrete>> {
        self.parts.iter().flat_map(|p| p.discrete(w, mode)).collect()
    }

    /// The interface that light meets first, with the lane to look at, for each wavelength; `None` where there is no
    /// plain one.
    pub fn interfaces(&self) -> Option<Vec<(Interface, usize)>> {
        let of = |p: &Part<'j>| p.bsdf.interface().map(|i| (0..p.lanes).map(move |lane| (i, lane)));
        let all: Option<Vec<_>> = self.parts.iter().map(of).collect();
        all.map(|parts| parts.into_iter().flatten().collect())
    }
}

impl Part<'_> {
    fn f(&self, wo: LocalDir, wi: LocalDir, mode: Mode, walks: u32) -> Vec<Estimate> {
        if !self.bsdf.claims().is_random() {
            let f = self.bsdf.eval(wo, wi, mode);
            return (0..self.lanes)
                .map(|lane| Estimate { value: f64::from(f[lane]), half_width: 0.0 })
                .collect();
        }
        let n = walks.max(2);
        let (mut sum, mut squares) = ([0.0_f64; LANES], [0.0_f64; LANES]);
        for i in 0..n {
            let f = self.bsdf.with_seed(hash::combine(SEED, u64::from(i))).eval(wo, wi, mode);
            for lane in 0..self.lanes {
                sum[lane] += f64::from(f[lane]);
                squares[lane] += f64::from(f[lane]).powi(2);
            }
        }
        let n = f64::from(n);
        (0..self.lanes)
            .map(|lane| {
                let mean = sum[lane] / n;
                let variance = ((squares[lane] / n - mean * mean) * n / (n - 1.0)).max(0.0);
                Estimate { value: mean, half_width: NORMAL_95 * (variance / n).sqrt() }
            })
            .collect()
    }

    fn discrete(&self, w: LocalDir, mode: Mode) -> Vec<Vec<Discrete>> {
        let found = if self.bsdf.claims().is_random() { self.met(w, mode) } else { self.chosen(w, mode) };
        let at_lane = |lane: usize| {
            let discrete =
                |f: &Found| Discrete { direction: f.direction, side: f.side, ratio: f.ratio[lane] };
            found.iter().map(discrete).collect()
        };
        (0..self.lanes).map(at_lane).collect()
    }

    fn delta(&self, w: LocalDir, uc: f32, u: Vec2, mode: Mode) -> Option<BsdfSample> {
        self.bsdf.sample(w, uc, u, mode).filter(|s| s.density.is_delta())
    }

    /// The discrete directions of a closed form. They depend on the choice `uc` alone and change at a few places, which are
    /// found by bisection: the stretch between is the probability of the choice.
    fn chosen(&self, w: LocalDir, mode: Mode) -> Vec<Found> {
        const NODES: u32 = 1 << 10;
        let u = Vec2::new(0.37, 0.61);
        let at = |uc: f32| self.delta(w, uc, u, mode);
        let same = |a: &Option<BsdfSample>, b: &Option<BsdfSample>| match (a, b) {
            (Some(a), Some(b)) => is_along(a.wi, b.wi),
            (a, b) => a.is_none() && b.is_none(),
        };
        let mut found = Vec::new();
        let (mut left, mut here) = (0.0_f32, at(0.0));
        for i in 1..=NODES {
            let right = (i as f32 / NODES as f32).min(ONE_MINUS_EPSILON);
            let next = at(right);
            let (mut lo, mut hi) = (left, right);
            while !same(&here, &next) {
                let middle = 0.5 * (lo + hi);
                if middle <= lo || middle >= hi {
                    break;
                }
                if same(&here, &at(middle)) { lo = middle } else { hi = middle }
            }
            let boundary = if same(&here, &next) { right } else { hi };
            add(&mut found, here, f64::from(boundary) - f64::from(left));
            add(&mut found, next, f64::from(right) - f64::from(boundary));
            (left, here) = (right, next);
        }
        found
    }

    /// The discrete directions that random walks end in, by counting.
    fn met(&self, w: LocalDir, mode: Mode) -> Vec<Found> {
        const FEW: u32 = 1 << 8;
        const MANY: u32 = 1 << 16;
        let count = |n: u32| {
            let mut found = Vec::new();
            let mut rng = Pcg32::new(SEED, 5);
            for i in 0..n {
                let uc = (i as f32 + 0.5) / n as f32;
                let u = Vec2::new(rng.next_f32(), rng.next_f32());
                add(&mut found, self.delta(w, uc, u, mode), 1.0 / f64::from(n));
            }
            found
        };
        // Most materials have none, and need no further look.
        let few = count(FEW);
        if few.is_empty() { few } else { count(MANY) }
    }
}

/// A discrete direction and what has been found to go there.
struct Found {
    direction: LocalDir,
    side: Side,
    ratio: [f64; LANES],
}

fn add(found: &mut Vec<Found>, sample: Option<BsdfSample>, probability: f64) {
    let Some(s) = sample else { return };
    let known = found.iter().position(|f| is_along(f.direction, s.wi));
    let at = known.unwrap_or_else(|| {
        found.push(Found { direction: s.wi, side: s.side, ratio: [0.0; LANES] });
        found.len() - 1
    });
    for (sum, weight) in found[at].ratio.iter_mut().zip(s.weight.to_array()) {
        *sum += f64::from(weight) * probability;
    }
}

fn is_along(a: LocalDir, b: LocalDir) -> bool {
    a.distance_squared(*b) < 1e-10
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::import::pbrt::{Input, import};
    use crate::scene::{Diagnostics, MemoryFiles, RenderJob, compile};
    use std::f64::consts::PI;
    use std::path::Path;

    fn job() -> RenderJob {
        let text = "WorldBegin
            MakeNamedMaterial \"paint\" \"string type\" \"diffuse\" \"spectrum reflectance\" [300 0.5 900 0.5]
            MakeNamedMaterial \"glass\" \"string type\" \"dielectric\"
            MakeNamedMaterial \"frosted\" \"string type\" \"dielectric\" \"float roughness\" 0.4
            MakeNamedMaterial \"prism\" \"string type\" \"dielectric\" \"spectrum eta\" \"glass-SF11\"
            MakeNamedMaterial \"metal\" \"string type\" \"conductor\" \"float roughness\" 0.5
            MakeNamedMaterial \"coat\" \"string type\" \"coateddiffuse\" \"float roughness\" 0.3 \"rgb albedo\" [0.5 0.5 0.5]
            MakeNamedMaterial \"both\" \"string type\" \"mix\" \"string materials\" [\"paint\" \"metal\"]
            MakeNamedMaterial \"air\" \"string type\" \"interface\"";
        let input = Input::Text { name: "test", bytes: text.as_bytes(), base: Path::new("") };
        let scene = import(&[input], &MemoryFiles::default()).scene.unwrap();
        compile(scene, &MemoryFiles::default(), &mut Diagnostics::default()).unwrap()
    }

    fn probe<'j>(job: &'j RenderJob, name: &str, wavelengths: &[f32]) -> Probe<'j> {
        Probe::new(&Subject::find(job, name).unwrap(), wavelengths).unwrap()
    }

    fn at(theta: f64, phi: f64) -> LocalDir {
        Angles { theta, phi }.direction()
    }

    #[test]
    fn angles_make_exact_axes_and_return_from_directions() {
        assert_eq!(*at(0.0, 123.0), Vec3::Z);
        assert_eq!(*at(90.0, 90.0), Vec3::Y);
        assert_eq!(*at(180.0, 0.0), Vec3::NEG_Z);
        for (theta, phi) in [(30.0, 200.0), (89.0, 359.0), (120.0, 1.0)] {
            let back = Angles::of(at(theta, phi));
            assert!((back.theta - theta).abs() < 1e-4 && (back.phi - phi).abs() < 1e-4, "{back:?}");
        }
    }

    /// B (2.20): the density of scattered power integrates to one.
    #[test]
    fn the_scattering_probability_function_is_a_density_over_outgoing_directions() {
        let job = job();
        let wavelengths = [450.0, 500.0, 550.0, 600.0, 650.0];
        for name in ["paint", "metal", "frosted"] {
            let probe = probe(&job, name, &wavelengths);
            for theta in [0.0, 50.0] {
                let wi = at(theta, 180.0);
                let albedo = probe.albedo(wi);
                assert_eq!(albedo.len(), wavelengths.len());
                let mut sums = [0.0; 5];
                let n = 180;
                for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                    // Midpoints in θ and φ over the sphere.
                    let (dt, dp) = (PI / f64::from(n), 2.0 * PI / f64::from(n));
                    let (t, p) = ((f64::from(i) + 0.5) * dt, (f64::from(j) + 0.5) * dp);
                    let readings =
                        probe.read(at(t.to_degrees(), p.to_degrees()), wi, Mode::Radiance, 2, &albedo);
                    for (sum, r) in sums.iter_mut().zip(readings) {
                        *sum += r.s.unwrap().value * t.sin() * dt * dp;
                    }
                }
                for sum in sums {
                    // The albedo of rough glass is a mean over samples, good to a few thousandths.
                    assert!((sum - 1.0).abs() < 6e-3, "{name} at {theta}: {sum}");
                }
            }
        }
    }

    /// R(0) = ((n − 1)/(n + 1))², Snell's direction, and the basic radiance law L/n².
    #[test]
    fn glass_has_two_discrete_directions_with_the_shares_of_fresnel() {
        let job = job();
        let probe = probe(&job, "glass", &[550.0]);
        let w = at(30.0, 0.0);
        let power = &probe.discrete(at(0.0, 0.0), Mode::Importance)[0];
        let share = |side| power.iter().find(|d| d.side == side).unwrap().ratio;
        assert!((share(Side::Reflection) - 0.04).abs() < 1e-6);
        assert!((share(Side::Transmission) - 0.96).abs() < 1e-6);
        let seen = &probe.discrete(w, Mode::Radiance)[0];
        assert_eq!(seen.len(), 2);
        let through = seen.iter().find(|d| d.side == Side::Transmission).unwrap();
        let angles = Angles::of(through.direction);
        assert!((180.0 - angles.theta - (0.5_f64 / 1.5).asin().to_degrees()).abs() < 1e-4, "{angles:?}");
        assert!((angles.phi - 180.0).abs() < 1e-3);
        let tau = probe.albedo(w)[0].transmittance;
        assert!((through.ratio - tau / 2.25).abs() < 1e-5);
    }

    #[test]
    fn dispersion_sends_each_wavelength_its_own_way() {
        let job = job();
        let wavelengths = [400.0, 500.0, 700.0];
        let found = probe(&job, "prism", &wavelengths).discrete(at(60.0, 0.0), Mode::Importance);
        let refracted = |lane: usize| {
            let d: &Vec<Discrete> = &found[lane];
            Angles::of(d.iter().find(|d| d.side == Side::Transmission).unwrap().direction).theta
        };
        // Blue is bent towards the normal below the surface, at 180°.
        assert!(refracted(0) > refracted(1) + 0.1 && refracted(1) > refracted(2) + 0.1);
    }

    #[test]
    fn more_walks_narrow_the_interval_around_the_same_value() {
        let job = job();
        let probe = probe(&job, "coat", &[550.0]);
        assert!(probe.is_estimated());
        let (wo, wi) = (at(20.0, 0.0), at(40.0, 150.0));
        let [few, many] = [400, 40_000].map(|n| probe.f(wo, wi, Mode::Radiance, n)[0]);
        assert!((few.half_width / many.half_width / 10.0).ln().abs() < 0.4, "{few:?} {many:?}");
        // Three half-widths are 5.9 standard errors: chance leaves them once in 10⁸.
        assert!((few.value - many.value).abs() < 3.0 * few.half_width);
        assert_eq!(probe.f(wo, wi, Mode::Radiance, 400)[0], few);
    }

    #[test]
    fn mixes_and_boundaries_have_no_scattering_of_their_own() {
        let job = job();
        let error = |name| Probe::new(&Subject::find(&job, name).unwrap(), &[550.0]).unwrap_err().to_string();
        assert_eq!(
            error("both"),
            "material \"both\" is a mix of \"paint\" and \"metal\": ask for one of these"
        );
        assert!(error("air").contains("boundary"));
    }
}
