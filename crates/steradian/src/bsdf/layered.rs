//! A dielectric coat over an opaque base, with an absorbing and scattering medium between them.
//!
//! The layers have no lateral extent: light enters, walks between the interfaces and leaves at the same
//! point (Guo, Hašan & Zhao 2018; pbrt-v4 book, 14.3). Values are unbiased estimates by random walks, seeded
//! from the directions. The coat lies on both sides of the surface.

use super::conductor::Conductor;
use super::contract::{BsdfSample, Lobe, Lobes, Mode, Side, Sides};
use super::dielectric::{Dielectric, Draw, Evaluation};
use super::diffuse::Diffuse;
use super::specimen::{Claims, Specimen};
use crate::math::hash::{self, Pcg32};
use crate::math::{LocalDir, Vec2, warp};
use crate::optics::{HenyeyGreenstein, TrowbridgeReitz, absorption};
use crate::spectrum::Sampled;
use crate::units::{Density, PdfSolidAngle, PerSteradian, Unitless};

/// An opaque scatterer that may lie beneath a coat: it reflects only, alike in both modes.
pub trait Base: Copy {
    /// f [sr⁻¹].
    fn eval(&self, wo: LocalDir, wi: LocalDir) -> Sampled<PerSteradian>;
    /// Density of [`Base::sample`].
    fn pdf(&self, wo: LocalDir, wi: LocalDir) -> PdfSolidAngle;
    /// Draws a reflected direction.
    fn sample(&self, wo: LocalDir, u: Vec2) -> Option<BsdfSample>;
    /// Whether only a discrete direction is reflected into.
    fn is_specular(&self) -> bool;
    /// Widens a narrow lobe.
    fn regularize(&mut self);
}

impl Base for Diffuse {
    fn eval(&self, wo: LocalDir, wi: LocalDir) -> Sampled<PerSteradian> {
        Self::eval(self, wo, wi)
    }

    fn pdf(&self, wo: LocalDir, wi: LocalDir) -> PdfSolidAngle {
        Self::pdf(self, wo, wi)
    }

    fn sample(&self, wo: LocalDir, u: Vec2) -> Option<BsdfSample> {
        Self::sample(self, wo, u)
    }

    fn is_specular(&self) -> bool {
        false
    }

    fn regularize(&mut self) {}
}

impl Base for Conductor {
    fn eval(&self, wo: LocalDir, wi: LocalDir) -> Sampled<PerSteradian> {
        Self::eval(self, wo, wi)
    }

    fn pdf(&self, wo: LocalDir, wi: LocalDir) -> PdfSolidAngle {
        Self::pdf(self, wo, wi)
    }

    fn sample(&self, wo: LocalDir, u: Vec2) -> Option<BsdfSample> {
        Self::sample(self, wo, u)
    }

    fn is_specular(&self) -> bool {
        self.roughness.is_smooth()
    }

    fn regularize(&mut self) {
        Self::regularize(self);
    }
}

/// How the two ways to leave through a rough coat are weighed against each other in an estimate of f.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ExitWeights {
    /// By the densities that either way was drawn with: unbiased.
    #[default]
    Consistent,
    /// As pbrt-v4 does, which takes the density of leaving for that of entering. The weights do not sum to one: what
    /// the base returns is overestimated, by 4 % for a coat with α = 0.1 and by 9 % with 0.4 (η = 1.5, measured
    /// against its own sampling). For pictures that must equal pbrt-v4's.
    Pbrt4,
}

/// What lies above the base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coat {
    /// The upper interface.
    pub interface: Dielectric,
    /// Optical thickness of the medium at perpendicular passage, positive.
    pub thickness: f32,
    /// Single-scattering albedo of the medium; zero where it only absorbs.
    pub albedo: Sampled<Unitless>,
    /// Mean cosine of scattering in the medium.
    pub g: f32,
    /// Most events of one walk.
    pub max_depth: u16,
    /// Walks per value, at least one.
    pub samples: u16,
    /// How a walk's ways through the coat are weighed.
    pub weights: ExitWeights,
}

impl Coat {
    /// A coat that only bounds light: a film of optical thickness 0.01 with relative index `eta`, the
    /// defaults of the scene format.
    pub fn clear(eta: f32, roughness: TrowbridgeReitz) -> Self {
        Self {
            interface: Dielectric { eta, roughness },
            thickness: 0.01,
            albedo: Sampled::ZERO,
            g: 0.0,
            max_depth: 10,
            samples: 1,
            weights: ExitWeights::Consistent,
        }
    }

    /// The share of power that a passage over the depth `dz` in direction `w` leaves, B (2.21).
    pub(crate) fn transmittance(&self, dz: f32, w: LocalDir) -> f32 {
        absorption::bouguer(1.0 / w.abs_cos_theta(), dz)
    }

    fn has_medium(&self) -> bool {
        !self.albedo.is_zero()
    }
}

/// A coat over a base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layered<B> {
    /// What light enters through.
    pub coat: Coat,
    /// What lies beneath.
    pub base: B,
    /// Seed of the random walks.
    pub seed: u64,
}

/// Which estimate a stream of random numbers serves; they must be independent of each other.
#[derive(Clone, Copy)]
enum Stream {
    Eval = 1,
    Pdf = 2,
    Sample = 3,
}

impl<B: Base> Layered<B> {
    /// An unbiased estimate of f [sr⁻¹], without discrete directions.
    pub fn eval(&self, wo: LocalDir, wi: LocalDir, mode: Mode) -> Sampled<PerSteradian> {
        let Some((wo, wi)) = upwards(wo, wi) else { return Sampled::ZERO };
        let surface = self.coat.interface.evaluate_at(wo, wi, mode, Sides::Both).map_or(0.0, |e| e.f);
        let mut f = Sampled::splat(surface);
        if !self.scatters_below() {
            return f;
        }
        let mut rng = self.rng(Stream::Eval, [wo.x, wo.y, wo.z, wi.x, wi.y, wi.z]);
        let scale = 1.0 / f32::from(self.coat.samples);
        for _ in 0..self.coat.samples {
            let (uc, u) = (rng.next_f32(), next_2d(&mut rng));
            let entry = self.coat.interface.draw(wo, uc, u, mode, Sides::Transmission);
            let (uc, u) = (rng.next_f32(), next_2d(&mut rng));
            let exit = self.coat.interface.draw(wi, uc, u, mode.adjoint(), Sides::Transmission);
            if let (Some(entry), Some(exit)) = (entry, exit) {
                f += self.walk(&entry, &exit, wi, mode, &mut rng) * scale;
            }
        }
        f
    }

    /// The density that weighs this sampler against others, a function of the directions and the seed.
    ///
    /// It follows the first passage through the coat and back, and spreads a tenth over the sphere (pbrt-v4 book,
    /// 14.3.4). An approximation suffices: any density that both sides agree on keeps multiple importance
    /// sampling unbiased.
    pub fn pdf(&self, wo: LocalDir, wi: LocalDir) -> PdfSolidAngle {
        let Some((wo, wi)) = upwards(wo, wi) else { return PdfSolidAngle(0.0) };
        let interface = &self.coat.interface;
        let surface =
            interface.evaluate_at(wo, wi, Mode::Importance, Sides::Reflection).map_or(0.0, |e| e.pdf);
        let mut rng = self.rng(Stream::Pdf, [wo.x, wo.y, wo.z, wi.x, wi.y, wi.z]);
        let mut below = 0.0;
        for _ in 0..self.coat.samples {
            below += self.first_passage_pdf(wo, wi, &mut rng);
        }
        let pdf = surface + below / f32::from(self.coat.samples);
        PdfSolidAngle(0.9 * pdf + 0.1 * warp::UNIFORM_SPHERE_PDF)
    }

    /// Walks until the light leaves; `None` when it is absorbed, or still inside after the most events.
    pub fn sample(&self, wo: LocalDir, uc: f32, u: Vec2, mode: Mode) -> Option<BsdfSample> {
        let below = wo.z < 0.0;
        let wo = if below { -wo } else { wo };
        let walked = self.walk_out(wo, uc, u, mode)?;
        let (density, lobe) = if walked.specular {
            (Density::Delta, Lobe::Specular)
        } else {
            (Density::SolidAngle(self.pdf(wo, walked.wi)), Lobe::Glossy)
        };
        Some(BsdfSample {
            wi: if below { -walked.wi } else { walked.wi },
            weight: walked.weight,
            density,
            side: Side::Reflection,
            lobe,
            eta: 1.0,
        })
    }

    /// Which lobes are present.
    pub fn lobes(&self) -> Lobes {
        let continuous = !self.coat.interface.is_specular() || self.scatters_below();
        Lobes { reflection: continuous, transmission: false }
    }

    /// Widens narrow lobes: a named bias against fireflies.
    pub fn regularize(&mut self) {
        self.coat.interface.regularize();
        self.base.regularize();
    }

    /// What holds for it.
    pub fn claims(&self) -> Claims {
        match self.coat.weights {
            ExitWeights::Pbrt4 if !self.coat.interface.is_specular() => Claims::BIASED,
            ExitWeights::Pbrt4 | ExitWeights::Consistent => Claims::ESTIMATED,
        }
    }

    /// Whether light that entered can leave into a continuum of directions.
    fn scatters_below(&self) -> bool {
        !(self.coat.interface.is_specular() && self.base.is_specular()) || self.coat.has_medium()
    }

    fn rng(&self, stream: Stream, [a, b, c, d, e, f]: [f32; 6]) -> Pcg32 {
        let pair = |x: f32, y: f32| u64::from(x.to_bits()) << 32 | u64::from(y.to_bits());
        let key = [pair(a, b), pair(c, d), pair(e, f)];
        Pcg32::new(key.into_iter().fold(self.seed, hash::combine), stream as u64)
    }

    /// One walk from `entry` that is connected to `exit`, a transmission drawn backwards from `wi`, at each
    /// event, and to `wi` through the coat after each event; both are weighed by the power heuristic.
    fn walk(
        &self,
        entry: &Draw,
        exit: &Draw,
        wi: LocalDir,
        mode: Mode,
        rng: &mut Pcg32,
    ) -> Sampled<PerSteradian> {
        let coat = &self.coat;
        let interface = &coat.interface;
        let phase = HenyeyGreenstein::new(coat.g);
        let base_is_rough = !self.base.is_specular();
        // The last leg, travelled upwards.
        let leg = -exit.wi;
        let leg_weight = exit.weight * coat.transmittance(coat.thickness, leg);
        // The heuristic's share of the connection, whose competitor draws it with `other`; one where the coat is smooth.
        let exit_pdf = interface.density(wi, exit);
        let connection_share = |other: f32| exit_pdf.map_or(1.0, |p| power_heuristic(p, other));
        let through_coat = |w: LocalDir, depth: f32, drawn: Option<f32>| {
            // A smooth coat evaluates to nothing.
            let Some(e) = interface.evaluate_at(-w, wi, mode, Sides::Transmission) else { return 0.0 };
            let share = drawn.map_or(1.0, |p| power_heuristic(p, self.competing_pdf(&e)));
            e.f * share * coat.transmittance(depth, w)
        };

        let mut f = Sampled::<PerSteradian>::ZERO;
        let mut beta = Sampled::<Unitless>::splat(entry.weight);
        let mut w = entry.wi;
        let mut z = coat.thickness;
        for depth in 0..coat.max_depth {
            if !survives(depth, &mut beta, rng) {
                break;
            }
            if coat.has_medium() {
                let dz = warp::exponential(rng.next_f32(), 1.0 / w.abs_cos_theta());
                let zp = if w.z > 0.0 { z + dz } else { z - dz };
                if zp == z {
                    continue;
                }
                if zp > 0.0 && zp < coat.thickness {
                    let p = phase.p((-w).dot(*leg));
                    let connected =
                        p * connection_share(p) * coat.transmittance(coat.thickness - zp, leg) * exit.weight
                            / leg.abs_cos_theta();
                    beta *= coat.albedo;
                    f += beta * Sampled::splat(connected);
                    let scattered = phase.sample(*-w, next_2d(rng));
                    if scattered.wi.z == 0.0 {
                        continue;
                    }
                    (w, z) = (LocalDir::new_unchecked(scattered.wi), zp);
                    if w.z > 0.0 {
                        f += beta * Sampled::splat(through_coat(w, coat.thickness - z, Some(scattered.p)));
                    }
                    continue;
                }
                z = zp.clamp(0.0, coat.thickness);
            } else {
                z = if z == coat.thickness { 0.0 } else { coat.thickness };
                beta = beta * coat.transmittance(coat.thickness, w);
            }
            if z == coat.thickness {
                let (uc, u) = (rng.next_f32(), next_2d(rng));
                let Some(back) = interface.draw(-w, uc, u, mode, Sides::Reflection) else { break };
                beta = beta * back.weight;
                w = back.wi;
            } else {
                if base_is_rough {
                    let share = connection_share(self.base.pdf(-w, leg).0);
                    f += beta * self.base.eval(-w, leg) * (leg_weight * share);
                }
                let Some(bounce) = self.base.sample(-w, next_2d(rng)) else { break };
                beta *= bounce.weight;
                w = bounce.wi;
                let drawn = match bounce.density {
                    Density::SolidAngle(p) => Some(p.0),
                    Density::Delta => None,
                };
                f += beta * Sampled::splat(through_coat(w, coat.thickness, drawn));
            }
        }
        f
    }

    /// The density against which a step towards the coat is weighed that then leaves by `through`.
    fn competing_pdf(&self, through: &Evaluation) -> f32 {
        match self.coat.weights {
            // What the connection was drawn with: from outside, backwards.
            ExitWeights::Consistent => through.reverse_pdf,
            ExitWeights::Pbrt4 => through.pdf,
        }
    }

    /// A walk from outside to outside; `wo` points up.
    fn walk_out(&self, wo: LocalDir, uc: f32, u: Vec2, mode: Mode) -> Option<Walked> {
        let coat = &self.coat;
        let first = coat.interface.draw(wo, uc, u, mode, Sides::Both)?;
        let mut walked =
            Walked { wi: first.wi, weight: Sampled::splat(first.weight), specular: first.facet.is_none() };
        if first.side == Side::Reflection {
            return Some(walked);
        }
        let mut rng = self.rng(Stream::Sample, [wo.x, wo.y, wo.z, uc, u.x, u.y]);
        let phase = HenyeyGreenstein::new(coat.g);
        let mut z = coat.thickness;
        for depth in 0..coat.max_depth {
            let w = walked.wi;
            if !survives(depth, &mut walked.weight, &mut rng) || w.z == 0.0 {
                return None;
            }
            if coat.has_medium() {
                let dz = warp::exponential(rng.next_f32(), 1.0 / w.abs_cos_theta());
                let zp = if w.z > 0.0 { z + dz } else { z - dz };
                if zp == z {
                    return None;
                }
                if zp > 0.0 && zp < coat.thickness {
                    let scattered = phase.sample(*-w, next_2d(&mut rng));
                    walked.weight *= coat.albedo;
                    walked.specular = false;
                    walked.wi = LocalDir::new_unchecked(scattered.wi);
                    z = zp;
                    continue;
                }
                z = zp.clamp(0.0, coat.thickness);
            } else {
                z = if z == coat.thickness { 0.0 } else { coat.thickness };
                walked.weight = walked.weight * coat.transmittance(coat.thickness, w);
            }
            let (uc, u) = (rng.next_f32(), next_2d(&mut rng));
            if z == 0.0 {
                let bounce = self.base.sample(-w, u)?;
                walked.weight *= bounce.weight;
                walked.specular &= bounce.density.is_delta();
                walked.wi = bounce.wi;
            } else {
                let drawn = coat.interface.draw(-w, uc, u, mode, Sides::Both)?;
                walked.weight = walked.weight * drawn.weight;
                walked.specular &= drawn.facet.is_none();
                walked.wi = drawn.wi;
                if drawn.side == Side::Transmission {
                    return (drawn.wi.z > 0.0).then_some(walked);
                }
            }
        }
        None
    }

    /// An estimate of the density of leaving into `wi` at the first return to the coat, were every crossing certain.
    fn first_passage_pdf(&self, wo: LocalDir, wi: LocalDir, rng: &mut Pcg32) -> f32 {
        let interface = &self.coat.interface;
        let mut enter = |w| {
            let (uc, u) = (rng.next_f32(), next_2d(rng));
            interface.draw(w, uc, u, Mode::Importance, Sides::Transmission)
        };
        let (Some(entry), Some(exit)) = (enter(wo), enter(wi)) else { return 0.0 };
        let through_base = self.base.pdf(-entry.wi, -exit.wi).0;
        let Some(exit_pdf) = interface.density(wi, &exit) else { return through_base };
        let Some(bounce) = self.base.sample(-entry.wi, next_2d(rng)) else { return 0.0 };
        let through_coat =
            interface.evaluate_at(-bounce.wi, wi, Mode::Importance, Sides::Both).map_or(0.0, |e| e.pdf);
        match bounce.density {
            Density::Delta => through_coat,
            Density::SolidAngle(p) => {
                power_heuristic(exit_pdf, through_base) * through_base
                    + power_heuristic(p.0, through_coat) * through_coat
            }
        }
    }
}

impl Layered<Diffuse> {
    /// Examples for the conformance suite.
    pub fn specimens() -> impl Iterator<Item = Specimen<Self>> {
        let of = |coat, reflectance| Self { coat, base: Diffuse { reflectance }, seed: 1 };
        let coloured = Sampled::from_array([0.1, 0.8, 0.4, 1.0]);
        let rough = Coat::clear(1.5, TrowbridgeReitz::new(0.3, 0.3));
        let milky = Coat { thickness: 0.5, albedo: Sampled::splat(0.9), g: 0.4, max_depth: 100, ..rough };
        [
            Specimen::new(
                "coated diffuse smooth",
                Claims::ESTIMATED,
                of(Coat::clear(1.5, TrowbridgeReitz::SMOOTH), coloured),
            ),
            Specimen::new("coated diffuse rough", Claims::ESTIMATED, of(rough, coloured)),
            Specimen::new("coated diffuse milky", Claims::ESTIMATED, of(milky, coloured)),
        ]
        .into_iter()
    }
}

impl Layered<Conductor> {
    /// Examples for the conformance suite.
    pub fn specimens() -> impl Iterator<Item = Specimen<Self>> {
        let of = |coat: TrowbridgeReitz, base| Self {
            coat: Coat::clear(1.5, coat),
            base: Conductor { eta: Sampled::splat(0.3), k: Sampled::splat(2.0), roughness: base },
            seed: 1,
        };
        let (smooth, rough) = (TrowbridgeReitz::SMOOTH, TrowbridgeReitz::new(0.3, 0.3));
        [
            Specimen::new("coated conductor smooth", Claims::ESTIMATED, of(smooth, smooth)),
            Specimen::new("coated conductor, rough base", Claims::ESTIMATED, of(smooth, rough)),
            Specimen::new("coated conductor, rough coat", Claims::ESTIMATED, of(rough, smooth)),
            Specimen::new("coated conductor rough", Claims::ESTIMATED, of(rough, rough)),
        ]
        .into_iter()
    }
}

/// Light that left the layers.
struct Walked {
    wi: LocalDir,
    weight: Sampled<Unitless>,
    /// Whether every event had a discrete direction.
    specular: bool,
}

/// Russian roulette after the first events: a dim walk goes on with the probability that is its weight.
fn survives(depth: u16, beta: &mut Sampled<Unitless>, rng: &mut Pcg32) -> bool {
    let p = beta.max();
    if depth <= 3 || p >= 0.25 {
        return true;
    }
    if rng.next_f32() >= p {
        return false;
    }
    *beta = *beta / p;
    true
}

/// Both directions seen from the coat above; `None` when they lie on different sides, which nothing crosses.
fn upwards(wo: LocalDir, wi: LocalDir) -> Option<(LocalDir, LocalDir)> {
    wo.same_hemisphere(wi).then(|| if wo.z < 0.0 { (-wo, -wi) } else { (wo, wi) })
}

fn next_2d(rng: &mut Pcg32) -> Vec2 {
    Vec2::new(rng.next_f32(), rng.next_f32())
}

/// Share of a strategy with density `p` against one with density `q` (Veach 1997, eq. 9.14 with β = 2).
pub(super) fn power_heuristic(p: f32, q: f32) -> f32 {
    // Scaled by the larger, so that squares of narrow lobes do not overflow.
    let m = p.max(q);
    if m == 0.0 {
        return 0.0;
    }
    let (p, q) = (p / m, q / m);
    p * p / (p * p + q * q)
}
