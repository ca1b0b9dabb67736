//! Stacks of homogeneous absorbing layers, B 2.3: each with its own thickness, index and absorption.
//!
//! Layers are thick against the coherence of light: powers add, fields do not. A smooth stack over a medium or a smooth metal,
//! and a smooth stack over a Lambertian base, are closed forms in which light keeps its polarisation from boundary to boundary.
//! With a rough boundary, values are unbiased estimates by random walks, in which smooth boundaries that follow each other
//! still act as one and light is unpolarised at each other event. A pane that is walked through as two unpolarised boundaries
//! transmits 1.4 % less at 60° than the polarised one (η = 1.5: 0.8362 against 0.8481), as any renderer's path through it does.

mod layers;
mod pile;
mod walk;

pub use layers::{LastBoundary, Layer, Layers, LayersError, MAX_LAYERS};
pub use pile::Below;

use super::albedo::Albedo;
use super::contract::{BsdfSample, Lobe, Lobes, Mode, Side};
use super::specimen::{Claims, Specimen};
use crate::math::hash::{self, Pcg32};
use crate::math::{LocalDir, Vec2, Vec3, warp};
use crate::optics::TrowbridgeReitz;
use crate::spectrum::{LANES, Sampled, Spectrum};
use crate::units::{Density, PdfSolidAngle, PerSteradian, Unitless};
use pile::{LAMBERT, Pile, Purpose, Recipe, Shares};

/// How a stack is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Method {
    /// Smooth throughout: discrete directions.
    Smooth,
    /// Smooth over a Lambertian base.
    Varnish,
    /// Random walks.
    Walk,
}

/// A stack of layers. Over a medium it is transparent and seen from both sides; over an opaque base it lies, like other coats,
/// on both sides of the surface.
#[derive(Clone, Copy, Debug)]
pub struct Stack<'a> {
    layers: &'a Layers,
    lambda: [f32; LANES],
    below: Below,
    method: Method,
    regularized: bool,
    /// Light that a Lambertian base gets back of what it gave off.
    returned: Sampled<Unitless>,
    /// Seed of the random walks.
    pub(super) seed: u64,
}

/// Which estimate a stream of random numbers serves; they must be independent of each other.
#[derive(Clone, Copy)]
enum Stream {
    Eval = 1,
    Pdf = 2,
    Sample = 3,
}

impl<'a> Stack<'a> {
    /// The stack at the wavelengths `lambda` [nm], over what lies below it there.
    ///
    /// Where [`Stack::follows_hero`], directions in the layers are those at the first wavelength.
    pub fn new(layers: &'a Layers, below: Below, lambda: [f32; LANES], seed: u64) -> Self {
        let method = match (Self::follows_hero(layers), below) {
            (true, _) => Method::Walk,
            (false, Below::Medium(_) | Below::Conductor { .. }) => Method::Smooth,
            (false, Below::Diffuse(_)) => Method::Varnish,
        };
        let mut stack =
            Self { layers, lambda, below, method, regularized: false, returned: Sampled::ZERO, seed };
        if method == Method::Varnish {
            stack.returned = match layers.returned {
                Some(k) => Sampled::splat(k),
                None => stack.pile(Purpose::Value, false).returned_to_base(),
            };
        }
        stack
    }

    /// Whether directions that leave on the side of light depend on the indices of the layers, so that a path's other
    /// wavelengths must be dropped where those disperse. Smooth stacks mirror, whatever they are made of.
    pub fn follows_hero(layers: &Layers) -> bool {
        !layers.is_smooth()
    }

    /// f [sr⁻¹] without discrete directions.
    ///
    /// Over a Lambertian base t(wo) t(wi) ρ / (π η² (1 − ρ K)): t is what arrives at the base, under the index η, and K what
    /// returns to it (Saunderson 1942, with directions, layers and absorption).
    pub fn eval(&self, wo: LocalDir, wi: LocalDir, mode: Mode) -> Sampled<PerSteradian> {
        if wo.z == 0.0 || wi.z == 0.0 {
            return Sampled::ZERO;
        }
        match self.method {
            Method::Smooth => Sampled::ZERO,
            Method::Varnish => self.varnish(wo, wi),
            Method::Walk => self.estimate(wo, wi, mode, Purpose::Value),
        }
    }

    /// The density that weighs this sampler against others. For walks it is an approximation, a function of the directions and
    /// the seed: what the stack would scatter there if nothing absorbed, and a tenth over the sphere.
    pub fn pdf(&self, wo: LocalDir, wi: LocalDir) -> PdfSolidAngle {
        if wo.z == 0.0 || wi.z == 0.0 {
            return PdfSolidAngle(0.0);
        }
        PdfSolidAngle(match self.method {
            Method::Smooth => 0.0,
            Method::Varnish if !wo.same_hemisphere(wi) => 0.0,
            Method::Varnish => {
                let (shares, passed) = self.varnish_shares(wo);
                let p = mirror_probability(shares.reflected, passed);
                (1.0 - p) * warp::cosine_hemisphere_pdf(wi.abs_cos_theta())
            }
            Method::Walk if self.is_opaque() && !wo.same_hemisphere(wi) => 0.0,
            Method::Walk => {
                let clear = self.estimate(wo, wi, Mode::Importance, Purpose::Density).mean();
                0.9 * clear * wi.abs_cos_theta() + 0.1 * warp::UNIFORM_SPHERE_PDF
            }
        })
    }

    /// A discrete direction chosen by its power, a direction from the base, or a walk until the light leaves.
    pub fn sample(&self, wo: LocalDir, uc: f32, u: Vec2, mode: Mode) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        // An opaque stack is the same from both sides.
        let turned = self.is_opaque() && wo.z < 0.0;
        let up = if turned { -wo } else { wo };
        let mut s = match self.method {
            Method::Varnish => self.sample_varnish(up, uc, u)?,
            Method::Smooth | Method::Walk => self.sample_walk(up, uc, u, mode)?,
        };
        if turned {
            s.wi = -s.wi;
        }
        Some(s)
    }

    /// Which lobes are present.
    pub fn lobes(&self) -> Lobes {
        let continuous = match self.method {
            Method::Smooth => false,
            Method::Varnish => true,
            Method::Walk => !self.pile(Purpose::Value, false).is_specular(),
        };
        Lobes { reflection: continuous, transmission: continuous && !self.is_opaque() }
    }

    /// Widens narrow lobes: a named bias against fireflies. A closed form becomes a walk.
    pub fn regularize(&mut self) {
        self.method = Method::Walk;
        self.regularized = true;
    }

    /// Power ratios where they are closed forms.
    pub fn albedo(&self, wi: LocalDir) -> Option<Albedo> {
        if self.method != Method::Smooth || wi.z == 0.0 {
            return None;
        }
        let wi = if self.is_opaque() && wi.z < 0.0 { -wi } else { wi };
        let Shares { reflected, transmitted } = self.pile(Purpose::Value, false).shares(0, wi);
        Some(Albedo { reflectance: reflected, transmittance: transmitted })
    }

    /// Index of the uppermost layer.
    pub(super) fn top_eta(&self) -> Sampled<Unitless> {
        self.pile(Purpose::Value, false).eta_of(1)
    }

    /// What holds for it: only layers, metals, bases and second facets absorb.
    pub fn claims(&self) -> Claims {
        let clear =
            || self.layers.layers().iter().all(|l| l.thickness == 0.0 || self.absorbs_nothing(&l.absorption));
        match (self.method, self.below) {
            (Method::Walk, _) => Claims::ESTIMATED,
            (_, Below::Medium(_)) if clear() => Claims::LOSSLESS,
            (_, Below::Diffuse(reflectance)) if reflectance.min() >= 1.0 && clear() => Claims::LOSSLESS,
            _ => Claims::CLOSED_FORM,
        }
    }

    /// Examples of the layers in a cabinet, for the conformance suite.
    pub fn specimens(cabinet: &'a StackCabinet) -> impl Iterator<Item = Specimen<Self>> {
        cabinet.shelves.iter().map(|shelf| {
            let stack = Self::new(&shelf.layers, shelf.below, [450.0, 520.0, 580.0, 650.0], 1);
            Specimen::new(shelf.name, stack.claims(), stack)
        })
    }

    fn absorbs_nothing(&self, absorption: &Spectrum) -> bool {
        self.lambda.iter().all(|&l| absorption.at(l) == 0.0)
    }

    fn is_opaque(&self) -> bool {
        !matches!(self.below, Below::Medium(_))
    }

    fn pile(&self, purpose: Purpose, flipped: bool) -> Pile {
        let recipe = Recipe {
            layers: self.layers,
            lambda: self.lambda,
            below: self.below,
            hero_directions: self.method == Method::Walk,
            regularized: self.regularized,
        };
        Pile::new(&recipe, purpose, flipped)
    }

    fn rng(&self, stream: Stream, [a, b, c, d, e, f]: [f32; 6]) -> Pcg32 {
        let pair = |x: f32, y: f32| u64::from(x.to_bits()) << 32 | u64::from(y.to_bits());
        let key = [pair(a, b), pair(c, d), pair(e, f)];
        Pcg32::new(key.into_iter().fold(self.seed, hash::combine), stream as u64)
    }

    /// Walks see light come from above: other pairs of directions are mirrored, with the stack where it is transparent. Through
    /// the stack they start on the side of the rougher face and leave by the smoother one, whichever way the light goes: a
    /// walk seldom finds a direction through a rough face by itself.
    fn estimate(&self, wo: LocalDir, wi: LocalDir, mode: Mode, purpose: Purpose) -> Sampled<PerSteradian> {
        let opaque = self.is_opaque();
        if opaque && !wo.same_hemisphere(wi) {
            return Sampled::ZERO;
        }
        let (mut wo, mut wi, mut mode) = (wo, wi, mode);
        if !wo.same_hemisphere(wi) && (wi.z > 0.0) != self.layers.top_is_smoother() {
            (wo, wi, mode) = (wi, wo, mode.adjoint());
        }
        let flipped = wi.z < 0.0;
        let (wo, wi) = if !flipped {
            (wo, wi)
        } else if opaque {
            (-wo, -wi)
        } else {
            let mirrored = |w: LocalDir| LocalDir::new_unchecked(Vec3::new(w.x, w.y, -w.z));
            (mirrored(wo), mirrored(wi))
        };
        let pile = self.pile(purpose, flipped && !opaque);
        let (stream, max_events) = match purpose {
            Purpose::Value => (Stream::Eval, None),
            // There and back, and as often between the boundaries.
            Purpose::Density => (Stream::Pdf, Some(4 * pile.len())),
        };
        let mut rng = self.rng(stream, [wo.x, wo.y, wo.z, wi.x, wi.y, wi.z]);
        walk::estimate(&pile, wo, wi, mode, &mut rng, max_events)
    }

    fn sample_walk(&self, wo: LocalDir, uc: f32, u: Vec2, mode: Mode) -> Option<BsdfSample> {
        let pile = self.pile(Purpose::Value, false);
        let mut rng = self.rng(Stream::Sample, [wo.x, wo.y, wo.z, uc, u.x, u.y]);
        let left = walk::leave(&pile, wo, uc, u, mode, &mut rng)?;
        let (density, lobe) = if left.specular {
            (Density::Delta, Lobe::Specular)
        } else {
            (Density::SolidAngle(self.pdf(wo, left.wi)), Lobe::Glossy)
        };
        let (side, eta) = if wo.same_hemisphere(left.wi) {
            (Side::Reflection, 1.0)
        } else if wo.z > 0.0 {
            (Side::Transmission, pile.eta_across())
        } else {
            (Side::Transmission, 1.0 / pile.eta_across())
        };
        Some(BsdfSample { wi: left.wi, weight: left.weight, density, side, lobe, eta })
    }

    fn varnish(&self, wo: LocalDir, wi: LocalDir) -> Sampled<PerSteradian> {
        let Below::Diffuse(reflectance) = self.below else { return Sampled::ZERO };
        if !wo.same_hemisphere(wi) {
            return Sampled::ZERO;
        }
        let pile = self.pile(Purpose::Value, false);
        let upwards = |w: LocalDir| if w.z < 0.0 { -w } else { w };
        let passed = pile.passed_to_base(upwards(wo)) * pile.passed_to_base(upwards(wi));
        let eta = pile.last_eta();
        Sampled::from_fn(|lane| {
            let rho = reflectance[lane];
            // K is below one: some light leaves.
            passed[lane] * LAMBERT * rho / (eta[lane] * eta[lane] * (1.0 - rho * self.returned[lane]))
        })
    }

    fn varnish_shares(&self, wo: LocalDir) -> (Shares, Sampled<Unitless>) {
        let pile = self.pile(Purpose::Value, false);
        let up = if wo.z < 0.0 { -wo } else { wo };
        (pile.shares(0, up), pile.passed_to_base(up))
    }

    fn sample_varnish(&self, wo: LocalDir, uc: f32, u: Vec2) -> Option<BsdfSample> {
        let (shares, passed) = self.varnish_shares(wo);
        let p = mirror_probability(shares.reflected, passed);
        if uc < p {
            return Some(BsdfSample {
                wi: LocalDir::new_unchecked(Vec3::new(-wo.x, -wo.y, wo.z)),
                weight: shares.reflected / p,
                density: Density::Delta,
                side: Side::Reflection,
                lobe: Lobe::Specular,
                eta: 1.0,
            });
        }
        let wi = warp::cosine_hemisphere(u);
        let pdf = PdfSolidAngle((1.0 - p) * warp::cosine_hemisphere_pdf(wi.abs_cos_theta()));
        (pdf.0 > 0.0).then(|| BsdfSample {
            wi,
            weight: self.varnish(wo, wi).weight(wi.abs_cos_theta(), pdf),
            density: Density::SolidAngle(pdf),
            side: Side::Reflection,
            lobe: Lobe::Glossy,
            eta: 1.0,
        })
    }
}

impl Layers {
    /// The same layers with what does not depend on the wavelength computed once.
    #[must_use]
    pub fn prepared(mut self) -> Self {
        if self.is_smooth() && self.is_grey() {
            self.returned =
                Some(Stack::new(&self, Below::Diffuse(Sampled::ONE), [0.0; LANES], 0).returned[0]);
        }
        self
    }
}

/// Probability of the mirror direction, where `passed` is what arrives at the base.
fn mirror_probability(reflected: Sampled<Unitless>, passed: Sampled<Unitless>) -> f32 {
    let (r, t) = (reflected.mean(), passed.mean());
    if r + t > 0.0 { r / (r + t) } else { 1.0 }
}

/// The layers of specimens.
#[derive(Debug)]
pub struct StackCabinet {
    shelves: Vec<Shelf>,
}

#[derive(Debug)]
struct Shelf {
    name: &'static str,
    layers: Layers,
    below: Below,
}

impl Default for StackCabinet {
    fn default() -> Self {
        let glass = |eta: f32, thickness: f32, absorption: f32| Layer {
            thickness,
            eta: Spectrum::Constant(eta),
            absorption: Spectrum::Constant(absorption),
        };
        let five = || {
            vec![
                glass(1.5, 1.0, 0.1),
                glass(1.33, 1.0, 0.2),
                glass(1.8, 0.5, 0.0),
                glass(1.2, 1.0, 0.1),
                glass(1.6, 1.0, 0.05),
            ]
        };
        let medium = |eta| Below::Medium(Sampled::splat(eta));
        let metal =
            Below::Conductor { eta: Sampled::splat(0.3), k: Sampled::from_array([2.0, 2.5, 3.0, 4.0]) };
        let paint = Below::Diffuse(Sampled::from_array([0.1, 0.8, 0.4, 1.0]));
        // Brighter than the few mirrored samples that no test of finite size sees enough of.
        let pale = Below::Diffuse(Sampled::from_array([0.4, 0.8, 0.6, 1.0]));
        let white = Below::Diffuse(Sampled::ONE);
        let all: [(&'static str, Vec<Layer>, &[f32], Below); 16] = [
            ("stack pane", vec![glass(1.5, 0.0, 0.0)], &[0.0], medium(1.0)),
            ("stack pane, absorbing", vec![glass(1.5, 1.0, 0.1)], &[0.0], medium(1.0)),
            (
                "stack of two into water",
                vec![glass(1.5, 1.0, 0.0), glass(1.7, 1.0, 0.0)],
                &[0.0],
                medium(1.33),
            ),
            ("stack of five, absorbing", five(), &[0.0], medium(1.4)),
            ("stack of two on smooth metal", vec![glass(1.5, 1.0, 0.1), glass(1.3, 1.0, 0.1)], &[0.0], metal),
            ("stack on white", vec![glass(1.5, 1.0, 0.0)], &[0.0], white),
            ("stack of five on white", five(), &[0.0], white),
            ("stack of two on paint", vec![glass(1.4, 1.0, 0.1), glass(1.7, 1.0, 0.3)], &[0.0], paint),
            ("stack pane, rough", vec![glass(1.5, 1.0, 0.1)], &[0.3], medium(1.0)),
            ("stack pane, one rough face", vec![glass(1.5, 1.0, 0.1)], &[0.0, 0.4], medium(1.0)),
            ("stack pane, rough 1", vec![glass(1.5, 1.0, 0.1)], &[1.0], medium(1.0)),
            (
                "stack of two into glass, rough",
                vec![glass(1.33, 1.0, 0.2), glass(1.7, 1.0, 0.0)],
                &[0.2, 0.4, 0.3],
                medium(1.5),
            ),
            ("stack of five, one rough", five(), &[0.0, 0.0, 0.6, 0.0, 0.0, 0.0], medium(1.4)),
            (
                "stack of two on paint, rough",
                vec![glass(1.4, 1.0, 0.1), glass(1.7, 1.0, 0.3)],
                &[0.2, 0.1],
                pale,
            ),
            (
                "stack of two on metal, rough",
                vec![glass(1.5, 1.0, 0.1), glass(1.3, 1.0, 0.1)],
                &[0.2, 0.1, 0.3],
                metal,
            ),
            (
                "stack of two on rough metal",
                vec![glass(1.5, 1.0, 0.1), glass(1.3, 1.0, 0.1)],
                &[0.0, 0.0, 0.5],
                metal,
            ),
        ];
        let shelves = all
            .into_iter()
            .filter_map(|(name, layers, alphas, below)| {
                let alphas: Vec<_> = alphas.iter().map(|&a| TrowbridgeReitz::new(a, a)).collect();
                let last = match below {
                    Below::Diffuse(_) => LastBoundary::Lambertian,
                    Below::Medium(_) | Below::Conductor { .. } => LastBoundary::Interface,
                };
                Layers::new(layers, &alphas, last).ok().map(|layers| Shelf {
                    name,
                    layers: layers.prepared(),
                    below,
                })
            })
            .collect();
        Self { shelves }
    }
}

#[cfg(test)]
mod tests;
