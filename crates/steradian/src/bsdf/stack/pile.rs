//! A stack at the wavelengths of one path: media, and what bounds them.
//!
//! Boundaries that follow each other and are smooth act as one: all reflections between them are summed in closed form, per
//! polarisation. Layers are thick, so that the summands do not interfere.

use super::layers::{Layers, MAX_LAYERS};
use crate::bsdf::conductor::Conductor;
use crate::bsdf::contract::{BsdfSample, Mode, Side, Sides};
use crate::bsdf::dielectric::Dielectric;
use crate::bsdf::diffuse::Diffuse;
use crate::bsdf::quadrature::GAUSS_LEGENDRE;
use crate::math::float::safe_sqrt;
use crate::math::{LocalDir, Vec2, Vec3};
use crate::optics::{TrowbridgeReitz, absorption, fresnel};
use crate::spectrum::{LANES, Sampled};
use crate::units::{Density, PerSteradian, Unitless};
use std::f32::consts::FRAC_1_PI;

/// What lies below the last layer.
#[derive(Clone, Copy, Debug)]
pub enum Below {
    /// A transparent medium with this index over that of the outside.
    Medium(Sampled<Unitless>),
    /// An opaque Lambertian base with this reflectance.
    Diffuse(Sampled<Unitless>),
    /// An opaque metal with the complex index eta + j k over that of the outside.
    Conductor {
        /// Real part.
        eta: Sampled<Unitless>,
        /// Imaginary part.
        k: Sampled<Unitless>,
    },
}

/// Shares of power of light at a run of boundaries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Shares {
    pub(super) reflected: Sampled<Unitless>,
    pub(super) transmitted: Sampled<Unitless>,
}

/// A homogeneous medium.
#[derive(Clone, Copy, Debug)]
struct Medium {
    eta: Sampled<Unitless>,
    /// Optical thickness at perpendicular passage; zero for the outer media.
    depth: Sampled<Unitless>,
}

/// What light meets between two media; media are numbered from the top, where the outside is 0.
#[derive(Clone, Copy, Debug)]
enum Element {
    /// Smooth boundaries from the medium `above` to the medium `below`.
    Run { above: u8, below: u8 },
    /// Smooth boundaries below the medium `above`, the last one of metal.
    Mirror { above: u8 },
    /// A rough boundary below the medium `above`.
    Rough { above: u8, interface: Dielectric },
    /// The Lambertian base.
    Diffuse(Diffuse),
    /// A rough metal base.
    Metal(Conductor),
}

/// What is left out of the physics.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Purpose {
    /// Nothing: values.
    Value,
    /// Absorption: what remains of the value is close to the density of directions.
    Density,
}

/// How a pile is made from the layers of a stack.
#[derive(Clone, Copy, Debug)]
pub(super) struct Recipe<'a> {
    pub(super) layers: &'a Layers,
    pub(super) lambda: [f32; LANES],
    pub(super) below: Below,
    /// Directions in the layers follow the hero's indices, at every wavelength.
    pub(super) hero_directions: bool,
    /// Narrow lobes are widened.
    pub(super) regularized: bool,
}

/// The pile.
#[derive(Clone, Debug)]
pub(super) struct Pile {
    media: [Medium; MAX_LAYERS + 2],
    elements: [Element; MAX_LAYERS + 1],
    n_media: usize,
    n_elements: usize,
    metal: Option<Metal>,
    /// All wavelengths are alike.
    grey: bool,
}

#[derive(Clone, Copy, Debug)]
struct Metal {
    eta: Sampled<Unitless>,
    k: Sampled<Unitless>,
}

/// A direction that was drawn at an element.
#[derive(Clone, Copy, Debug)]
pub(super) struct Drawn {
    pub(super) wi: LocalDir,
    /// f·|cosθi|/p.
    pub(super) weight: Sampled<Unitless>,
    /// Density; `None` for a discrete direction.
    pub(super) pdf: Option<f32>,
}

/// Value and densities of a pair of directions at an element.
#[derive(Clone, Copy, Debug)]
pub(super) struct Value {
    pub(super) f: Sampled<PerSteradian>,
    /// Density of drawing `wi` for `wo` [sr⁻¹].
    pub(super) pdf: f32,
    /// Density of drawing `wo` for `wi` where transmission is certain [sr⁻¹].
    pub(super) reverse_pdf: f32,
}

impl Pile {
    /// Seen from above, or with `flipped` from below.
    pub(super) fn new(recipe: &Recipe<'_>, purpose: Purpose, flipped: bool) -> Self {
        let outside = Medium { eta: Sampled::ONE, depth: Sampled::ZERO };
        let mut pile = Self {
            media: [outside; MAX_LAYERS + 2],
            elements: [Element::Mirror { above: 0 }; MAX_LAYERS + 1],
            n_media: 1,
            n_elements: 0,
            metal: None,
            grey: false,
        };
        let layers = recipe.layers.layers();
        let indices = |eta: Sampled<Unitless>| {
            let eta = if recipe.hero_directions { Sampled::splat(eta[0]) } else { eta };
            // Zero stands for "no value" in scene files; the bounds are those of other materials.
            eta.map(|n| if n > 0.0 { n.clamp(1e-3, 1e3) } else { 1.0 })
        };
        for (medium, layer) in pile.media[1..].iter_mut().zip(layers) {
            let at = |s: &crate::spectrum::Spectrum| match s.constant_value() {
                Some(v) => Sampled::splat(v),
                None => Sampled::from_array(recipe.lambda.map(|l| s.at(l))),
            };
            let depth = match purpose {
                Purpose::Value => at(&layer.absorption).map(|a| (a * layer.thickness).max(0.0)),
                Purpose::Density => Sampled::ZERO,
            };
            *medium = Medium { eta: indices(at(&layer.eta)), depth };
        }
        pile.n_media += layers.len();
        let mut below = recipe.below;
        if let Below::Medium(eta) = below {
            pile.media[pile.n_media] = Medium { eta: indices(eta), depth: Sampled::ZERO };
            pile.n_media += 1;
        } else if purpose == Purpose::Density {
            below = match below {
                Below::Diffuse(_) => Below::Diffuse(Sampled::ONE),
                // An infinite index reflects all.
                _ => Below::Conductor { eta: Sampled::ZERO, k: Sampled::splat(1e4) },
            };
        }
        if flipped {
            pile.media[..pile.n_media].reverse();
        }
        let same = |s: Sampled<Unitless>| s.to_array().iter().all(|&x| x == s[0]);
        pile.grey = pile.media[..pile.n_media].iter().all(|m| same(m.eta) && same(m.depth))
            && match below {
                Below::Conductor { eta, k } => same(eta) && same(k),
                Below::Medium(_) | Below::Diffuse(_) => true,
            };
        let boundaries = recipe.layers.boundaries();
        let roughness = |j: usize| {
            let j = if flipped { boundaries.len() - 1 - j } else { j };
            let roughness = boundaries.get(j).copied().unwrap_or(TrowbridgeReitz::SMOOTH);
            if recipe.regularized { roughness.regularized() } else { roughness }
        };
        pile.stack_elements(below, roughness);
        pile
    }

    /// Number of elements from the top.
    pub(super) fn len(&self) -> usize {
        self.n_elements
    }

    /// Whether the whole pile is smooth boundaries.
    pub(super) fn is_specular(&self) -> bool {
        self.n_elements == 1 && self.is_specular_at(0)
    }

    /// Index of the lowest medium over that of the uppermost.
    pub(super) fn eta_across(&self) -> f32 {
        self.media[self.n_media - 1].eta[0] / self.media[0].eta[0]
    }

    /// Whether light scatters at the element into discrete directions only.
    pub(super) fn is_specular_at(&self, element: usize) -> bool {
        match self.elements[element] {
            Element::Run { .. } | Element::Mirror { .. } => true,
            Element::Rough { .. } | Element::Diffuse(_) => false,
            Element::Metal(m) => m.roughness.is_smooth(),
        }
    }

    /// The share of light that passes the gap below an element in a direction with this cosine, B (2.21).
    pub(super) fn transmittance_below(&self, element: usize, abs_cos: f32) -> Sampled<Unitless> {
        let medium = self.media[self.medium_below(element)];
        self.per_lane(|lane| absorption::bouguer(medium.depth[lane] / abs_cos, 1.0))
    }

    /// dω above over dω below an element that directions `above` and `below` are refracted at, from n² cosθ dω on both sides.
    pub(super) fn solid_angle_ratio(&self, element: usize, above: LocalDir, below: LocalDir) -> f64 {
        let extent = |medium: usize, w: LocalDir| {
            let eta = f64::from(self.media[medium].eta[0]);
            eta * eta * f64::from(w.abs_cos_theta())
        };
        extent(self.medium_below(element), below) / extent(self.medium_above(element), above)
    }

    /// Draws among the asked-for `sides` of an element.
    pub(super) fn draw(
        &self,
        element: usize,
        wo: LocalDir,
        uc: f32,
        u: Vec2,
        mode: Mode,
        sides: Sides,
    ) -> Option<Drawn> {
        if wo.z == 0.0 {
            return None;
        }
        match self.elements[element] {
            Element::Run { .. } | Element::Mirror { .. } => self.draw_discrete(element, wo, uc, mode, sides),
            Element::Rough { interface, .. } => {
                let drawn = interface.draw(wo, uc, u, mode, sides)?;
                let pdf = interface.density(wo, &drawn);
                // A direction in the surface has no layer to pass.
                (drawn.wi.z != 0.0).then(|| Drawn { wi: drawn.wi, weight: Sampled::splat(drawn.weight), pdf })
            }
            Element::Diffuse(_) | Element::Metal(_) if sides == Sides::Transmission => None,
            Element::Diffuse(base) => from_base(base.sample(wo, u)?),
            Element::Metal(base) => from_base(base.sample(wo, u)?),
        }
    }

    /// Value and densities of a pair of directions; `None` where there is no continuum or the value is zero.
    pub(super) fn evaluate(&self, element: usize, wo: LocalDir, wi: LocalDir, mode: Mode) -> Option<Value> {
        match self.elements[element] {
            Element::Run { .. } | Element::Mirror { .. } => None,
            Element::Rough { interface, .. } => {
                let e = interface.evaluate_at(wo, wi, mode, Sides::Both)?;
                Some(Value { f: Sampled::splat(e.f), pdf: e.pdf, reverse_pdf: e.reverse_pdf })
            }
            Element::Diffuse(base) => {
                Some(Value { f: base.eval(wo, wi), pdf: base.pdf(wo, wi).0, reverse_pdf: 0.0 })
            }
            Element::Metal(base) => {
                Some(Value { f: base.eval(wo, wi), pdf: base.pdf(wo, wi).0, reverse_pdf: 0.0 })
            }
        }
    }

    /// Reflectance and transmittance of the smooth boundaries of an element, for light that lies above or below it.
    pub(super) fn shares(&self, element: usize, w: LocalDir) -> Shares {
        let (above, below) = match self.elements[element] {
            Element::Run { above, below } => (usize::from(above), usize::from(below)),
            Element::Mirror { above } => (usize::from(above), self.n_media - 1),
            Element::Rough { .. } | Element::Diffuse(_) | Element::Metal(_) => {
                debug_assert!(false, "no run of smooth boundaries");
                return Shares { reflected: Sampled::ZERO, transmitted: Sampled::ZERO };
            }
        };
        let (from, to) = if w.z > 0.0 { (above, below) } else { (below, above) };
        let metal = matches!(self.elements[element], Element::Mirror { .. });
        let mut transmitted = [0.0; LANES];
        let reflected = self.per_lane(|lane| {
            let (r, t) = self.add(from, to, metal, lane, w.abs_cos_theta());
            transmitted[lane] = t;
            r
        });
        if self.grey {
            transmitted = [transmitted[0]; LANES];
        }
        Shares { reflected, transmitted: Sampled::from_array(transmitted) }
    }

    /// The share of light from direction `w` above the stack that arrives at a base under a smooth stack.
    pub(super) fn passed_to_base(&self, w: LocalDir) -> Sampled<Unitless> {
        let last = self.media[self.n_media - 1];
        let passed = self.shares(0, w).transmitted;
        passed
            * self.per_lane(|lane| {
                let inside = self.cosine(0, self.n_media - 1, lane, w.abs_cos_theta());
                if inside > 0.0 { absorption::bouguer(last.depth[lane] / inside, 1.0) } else { 0.0 }
            })
    }

    /// Index of the lowest medium.
    pub(super) fn last_eta(&self) -> Sampled<Unitless> {
        self.media[self.n_media - 1].eta
    }

    /// Index of a medium, counted from the outside.
    pub(super) fn eta_of(&self, medium: usize) -> Sampled<Unitless> {
        self.media[medium].eta
    }

    /// ∫ 2μ R(μ) e^(−2τ/μ) dμ: the share of a Lambertian emission at the base that returns to it, from all reflections in the
    /// smooth stack above and twice through the last layer, τ thick.
    pub(super) fn returned_to_base(&self) -> Sampled<Unitless> {
        self.per_lane(|lane| self.returned_in(lane))
    }

    fn returned_in(&self, lane: usize) -> f32 {
        let last = self.n_media - 1;
        let square = |m: &Medium| m.eta[lane] * m.eta[lane];
        let whole = square(&self.media[last]);
        // Over q = n² sin²θ, which all media share, R is smooth but where a medium begins to reflect totally.
        let mut kinks = [0.0_f32; MAX_LAYERS + 2];
        let mut n = 1;
        for medium in &self.media[..last] {
            if square(medium) < whole {
                kinks[n] = square(medium);
                n += 1;
            }
        }
        kinks[n] = whole;
        n += 1;
        kinks[..n].sort_unstable_by(f32::total_cmp);
        let mut sum = 0.0_f64;
        for pair in kinks[..n].windows(2) {
            let (a, width) = (f64::from(pair[0]), f64::from(pair[1] - pair[0]));
            if width == 0.0 {
                continue;
            }
            for panel in 0..4 {
                for [x, weight] in GAUSS_LEGENDRE {
                    // Square roots at both ends of the segment become smooth.
                    let x = (x + f64::from(panel)) / 4.0;
                    let q = a + width * x * x * (3.0 - 2.0 * x);
                    let dq = width * 6.0 * x * (1.0 - x) * weight / 4.0;
                    let cos = (1.0 - q / f64::from(whole)).max(0.0).sqrt() as f32;
                    if cos > 0.0 {
                        let (r, _) = self.add(last, 0, false, lane, cos);
                        let passed = absorption::bouguer(2.0 * self.media[last].depth[lane] / cos, 1.0);
                        sum += f64::from(r * passed) * dq;
                    }
                }
            }
        }
        (sum / f64::from(whole)) as f32
    }

    fn stack_elements(&mut self, below: Below, roughness: impl Fn(usize) -> TrowbridgeReitz) {
        let last = self.n_media - 1;
        let mut smooth_from = None;
        for j in 0..last {
            let eta = self.media[j + 1].eta[0] / self.media[j].eta[0];
            let interface = Dielectric { eta, roughness: roughness(j) };
            if interface.is_specular() {
                smooth_from.get_or_insert(j);
                continue;
            }
            self.end_run(&mut smooth_from, j);
            self.push(Element::Rough { above: j as u8, interface });
        }
        match below {
            Below::Medium(_) => self.end_run(&mut smooth_from, last),
            Below::Diffuse(reflectance) => {
                self.end_run(&mut smooth_from, last);
                self.push(Element::Diffuse(Diffuse { reflectance }));
            }
            Below::Conductor { eta, k } => {
                let roughness = roughness(last);
                if roughness.is_smooth() {
                    self.metal = Some(Metal { eta, k });
                    self.push(Element::Mirror { above: smooth_from.unwrap_or(last) as u8 });
                } else {
                    self.end_run(&mut smooth_from, last);
                    let around = self.media[last].eta;
                    self.push(Element::Metal(Conductor { eta: eta / around, k: k / around, roughness }));
                }
            }
        }
    }

    fn end_run(&mut self, from: &mut Option<usize>, to: usize) {
        if let Some(above) = from.take() {
            self.push(Element::Run { above: above as u8, below: to as u8 });
        }
    }

    fn push(&mut self, element: Element) {
        self.elements[self.n_elements] = element;
        self.n_elements += 1;
    }

    fn medium_above(&self, element: usize) -> usize {
        match self.elements[element] {
            Element::Run { above, .. } | Element::Mirror { above } | Element::Rough { above, .. } => {
                usize::from(above)
            }
            Element::Diffuse(_) | Element::Metal(_) => self.n_media - 1,
        }
    }

    fn medium_below(&self, element: usize) -> usize {
        match self.elements[element] {
            Element::Run { below, .. } => usize::from(below),
            Element::Rough { above, .. } => usize::from(above) + 1,
            Element::Mirror { .. } | Element::Diffuse(_) | Element::Metal(_) => self.n_media - 1,
        }
    }

    fn per_lane(&self, mut f: impl FnMut(usize) -> f32) -> Sampled<Unitless> {
        if self.grey { Sampled::splat(f(0)) } else { Sampled::from_fn(f) }
    }

    /// |cosθ| in medium `to` of light with the cosine `cos` in medium `from`; zero beyond total reflection.
    fn cosine(&self, from: usize, to: usize, lane: usize, cos: f32) -> f32 {
        let (n, m) = (self.media[from].eta[lane], self.media[to].eta[lane]);
        if n == m {
            return cos;
        }
        // n² sin²θ is common: written so that grazing directions keep their digits.
        safe_sqrt((m - n) * (m + n) + n * n * cos * cos) / m
    }

    /// Reflectance and transmittance, the mean of both polarisations, of all smooth boundaries on the way from medium `from`
    /// to medium `to`, and of a metal beyond it.
    ///
    /// The farthest boundary first, then layer by layer towards the light (Stokes 1862): what the boundary r reflects, and
    /// what it lets through, (1 − r)² R' / (1 − r R'), where R' = R e^(−2τ/cosθ) lies behind it.
    fn add(&self, from: usize, to: usize, metal: bool, lane: usize, cos: f32) -> (f32, f32) {
        let towards = |medium: usize| if to > from { medium + 1 } else { medium - 1 };
        // The last medium that light reaches.
        let mut reached = from;
        let mut cos_reached = cos;
        while reached != to {
            let next = towards(reached);
            let c = self.cosine(from, next, lane, cos);
            if c == 0.0 {
                break;
            }
            (reached, cos_reached) = (next, c);
        }
        let (mut r, mut t) = if reached != to {
            ([1.0, 1.0], [0.0, 0.0])
        } else if let (true, Some(metal)) = (metal, &self.metal) {
            let n = self.media[to].eta[lane];
            let f = fresnel::conductor_polarized(cos_reached, metal.eta[lane] / n, metal.k[lane] / n);
            ([f.s, f.p], [0.0, 0.0])
        } else {
            ([0.0, 0.0], [1.0, 1.0])
        };
        let mut near = reached;
        let mut c_far = cos_reached;
        while near != from {
            let far = near;
            near = if to > from { far - 1 } else { far + 1 };
            // The medium beyond all boundaries is no layer; one before a total reflection or a metal is.
            let is_layer = far != to || metal;
            let passed =
                if is_layer { absorption::bouguer(self.media[far].depth[lane] / c_far, 1.0) } else { 1.0 };
            let c_near = self.cosine(from, near, lane, cos);
            let (n_near, n_far) = (self.media[near].eta[lane], self.media[far].eta[lane]);
            let amplitudes = [
                (n_near * c_near - n_far * c_far) / (n_near * c_near + n_far * c_far),
                (n_far * c_near - n_near * c_far) / (n_far * c_near + n_near * c_far),
            ];
            for p in 0..2 {
                let boundary = amplitudes[p] * amplitudes[p];
                let through = 1.0 - boundary;
                if through <= 0.0 {
                    (r[p], t[p]) = (1.0, 0.0);
                    continue;
                }
                let behind = r[p] * passed * passed;
                let orders = 1.0 / (1.0 - boundary * behind);
                (r[p], t[p]) =
                    (boundary + through * through * behind * orders, through * t[p] * passed * orders);
            }
            c_far = c_near;
        }
        (0.5 * (r[0] + r[1]), 0.5 * (t[0] + t[1]))
    }

    fn draw_discrete(
        &self,
        element: usize,
        wo: LocalDir,
        uc: f32,
        mode: Mode,
        sides: Sides,
    ) -> Option<Drawn> {
        let Shares { reflected, transmitted } = self.shares(element, wo);
        let (r, t) = (reflected.mean(), transmitted.mean());
        let share = r / (r + t);
        // Nothing is left where all is absorbed.
        if share.is_nan() {
            return None;
        }
        let p = sides.reflection_probability(share);
        if uc < p {
            let wi = LocalDir::new_unchecked(Vec3::new(-wo.x, -wo.y, wo.z));
            return (r > 0.0).then(|| Drawn { wi, weight: reflected / p, pdf: None });
        }
        if t <= 0.0 || p >= 1.0 {
            return None;
        }
        let (wi, eta) = self.refracted(element, wo)?;
        let scale = match mode {
            Mode::Radiance => 1.0 / (eta * eta),
            Mode::Importance => 1.0,
        };
        Some(Drawn { wi, weight: transmitted * (scale / (1.0 - p)), pdf: None })
    }

    /// The direction beyond an element, at the hero's indices, and the index there over the one here.
    fn refracted(&self, element: usize, wo: LocalDir) -> Option<(LocalDir, f32)> {
        let (above, below) = (self.medium_above(element), self.medium_below(element));
        let (from, to) = if wo.z > 0.0 { (above, below) } else { (below, above) };
        let eta = self.media[to].eta[0] / self.media[from].eta[0];
        let cos = self.cosine(from, to, 0, wo.abs_cos_theta());
        let wi = Vec3::new(-wo.x / eta, -wo.y / eta, -cos.copysign(wo.z));
        (cos > 0.0).then(|| (LocalDir::new_unchecked(wi), eta))
    }
}

impl Value {
    /// Whether there is anything to add.
    pub(super) fn is_zero(&self) -> bool {
        self.f.is_zero()
    }
}

fn from_base(s: BsdfSample) -> Option<Drawn> {
    debug_assert!(s.side == Side::Reflection);
    let pdf = match s.density {
        Density::SolidAngle(p) => Some(p.0),
        Density::Delta => None,
    };
    (s.wi.z != 0.0).then_some(Drawn { wi: s.wi, weight: s.weight, pdf })
}

/// cosθ/π over a hemisphere times this is what a Lambertian base emits.
pub(super) const LAMBERT: f32 = FRAC_1_PI;
