//! Scattering functions: the closed set, in local coordinates.
//!
//! The contract of every method stands in [`contract`]; each variant's file documents only what differs.

pub mod albedo;
pub mod coating;
pub mod conductor;
pub mod conformance;
pub mod contract;
mod cosine_lobe;
pub mod dielectric;
pub mod diffuse;
pub mod finished_conductor;
pub mod finished_dielectric;
pub mod hair;
pub mod interface;
pub mod layered;
pub mod legacy_phong;
pub mod measured;
pub mod mirror;
pub mod modified_phong;
pub mod openpbr;
pub mod oren_nayar;
mod quadrature;
mod rough_varnish;
pub mod specimen;
pub mod stack;
mod varnish;
pub mod varnished;

pub use albedo::Albedo;
pub use coating::Coating;
pub use conductor::Conductor;
pub use contract::{BsdfSample, Evaluated, Lobe, Lobes, Mode, Side};
pub use dielectric::{Dielectric, ThinDielectric};
pub use diffuse::{Diffuse, DiffuseTransmission};
pub use finished_conductor::FinishedConductor;
pub use finished_dielectric::FinishedDielectric;
pub use hair::{Fibre, Hair};
pub use interface::Interface;
pub use layered::{Coat, ExitWeights, Layered};
pub use legacy_phong::LegacyPhong;
pub use measured::{Measured, MeasuredTable};
pub use mirror::Mirror;
pub use modified_phong::{ModifiedPhong, PhongLobe, PhongNormalization, PhongSampling};
pub use openpbr::OpenPbr;
pub use oren_nayar::OrenNayar;
pub use rough_varnish::RoughVarnish;
pub use specimen::{Claims, Energy, Reciprocity, Specimen, Values};
pub use stack::{Stack, StackCabinet};
pub use varnish::Varnish;
pub use varnished::VarnishedDiffuse;

use crate::math::{LocalDir, Vec2};
use crate::spectrum::Sampled;
use crate::units::{PdfSolidAngle, PerSteradian, Unitless};

/// How a surface scatters light at one point and at one path's wavelengths.
#[derive(Clone, Copy, Debug)]
pub enum Bsdf<'a> {
    /// Lambertian reflection.
    Diffuse(Diffuse),
    /// Lambertian reflection and transmission.
    DiffuseTransmission(DiffuseTransmission),
    /// Rough diffuse reflection.
    OrenNayar(OrenNayar),
    /// A perfect mirror.
    Mirror(Mirror),
    /// The modified Phong model.
    ModifiedPhong(ModifiedPhong),
    /// Phong's legacy shading: not a BRDF.
    LegacyPhong(LegacyPhong),
    /// A metal.
    Conductor(Conductor),
    /// The interface between two transparent media.
    Dielectric(Dielectric),
    /// A metal with other facets, a film, or without the loss of single scattering.
    FinishedConductor(FinishedConductor<'a>),
    /// An interface with other facets, a film, or without the loss of single scattering.
    FinishedDielectric(FinishedDielectric<'a>),
    /// A pane without thickness.
    ThinDielectric(ThinDielectric),
    /// A smooth clear coat over a Lambertian base.
    VarnishedDiffuse(VarnishedDiffuse),
    /// A rough clear coat over a Lambertian base.
    RoughVarnish(RoughVarnish<'a>),
    /// A dielectric coat over a Lambertian base.
    CoatedDiffuse(Layered<Diffuse>),
    /// A dielectric coat over a metal.
    CoatedConductor(Layered<Conductor>),
    /// OpenPBR Surface: a metal, glass or diffuse base under film, coat and fuzz.
    OpenPbr(OpenPbr),
    /// A table of measurements.
    Measured(Measured<'a>),
    /// A hair.
    Hair(Hair),
    /// A stack of layers.
    Stack(Stack<'a>),
}

// One per path vertex, passed by value.
const _: () = assert!(size_of::<Bsdf<'static>>() <= 192);

impl<'a> Bsdf<'a> {
    /// f [sr⁻¹] for light that arrives from `wi` and is seen from `wo`, without the cosine and without
    /// discrete directions. Zero for directions in the surface; never NaN.
    pub fn eval(&self, wo: LocalDir, wi: LocalDir, mode: Mode) -> Sampled<PerSteradian> {
        match self {
            Self::Diffuse(b) => b.eval(wo, wi),
            Self::DiffuseTransmission(b) => b.eval(wo, wi),
            Self::OrenNayar(b) => b.eval(wo, wi),
            Self::Mirror(_) => Sampled::ZERO,
            Self::ModifiedPhong(b) => b.eval(wo, wi),
            Self::LegacyPhong(b) => b.eval(wo, wi, mode),
            Self::Conductor(b) => b.eval(wo, wi),
            Self::Dielectric(b) => b.eval(wo, wi, mode),
            Self::FinishedConductor(b) => b.eval(wo, wi),
            Self::FinishedDielectric(b) => b.eval(wo, wi, mode),
            Self::ThinDielectric(_) => Sampled::ZERO,
            Self::VarnishedDiffuse(b) => b.eval(wo, wi),
            Self::RoughVarnish(b) => b.eval(wo, wi),
            Self::CoatedDiffuse(b) => b.eval(wo, wi, mode),
            Self::CoatedConductor(b) => b.eval(wo, wi, mode),
            Self::OpenPbr(b) => b.eval(wo, wi, mode),
            Self::Measured(b) => b.eval(wo, wi, mode),
            Self::Hair(b) => b.eval(wo, wi),
            Self::Stack(b) => b.eval(wo, wi, mode),
        }
    }

    /// Density of `wi` among the continuous directions that [`Bsdf::sample`] draws for `wo`.
    pub fn pdf(&self, wo: LocalDir, wi: LocalDir, _mode: Mode) -> PdfSolidAngle {
        match self {
            Self::Diffuse(b) => b.pdf(wo, wi),
            Self::DiffuseTransmission(b) => b.pdf(wo, wi),
            Self::OrenNayar(b) => b.pdf(wo, wi),
            Self::Mirror(_) => PdfSolidAngle(0.0),
            Self::ModifiedPhong(b) => b.pdf(wo, wi),
            Self::LegacyPhong(b) => b.pdf(wo, wi),
            Self::Conductor(b) => b.pdf(wo, wi),
            Self::Dielectric(b) => b.pdf(wo, wi),
            Self::FinishedConductor(b) => b.pdf(wo, wi),
            Self::FinishedDielectric(b) => b.pdf(wo, wi),
            Self::ThinDielectric(_) => PdfSolidAngle(0.0),
            Self::VarnishedDiffuse(b) => b.pdf(wo, wi),
            Self::RoughVarnish(b) => b.pdf(wo, wi),
            Self::CoatedDiffuse(b) => b.pdf(wo, wi),
            Self::CoatedConductor(b) => b.pdf(wo, wi),
            Self::OpenPbr(b) => b.pdf(wo, wi),
            Self::Measured(b) => b.pdf(wo, wi),
            Self::Hair(b) => b.pdf(wo, wi),
            Self::Stack(b) => b.pdf(wo, wi),
        }
    }

    /// [`Bsdf::eval`] and [`Bsdf::pdf`] at once: they share most of their work.
    pub fn evaluate(&self, wo: LocalDir, wi: LocalDir, mode: Mode) -> Evaluated {
        match self {
            Self::Conductor(b) => b.evaluate(wo, wi),
            Self::Dielectric(b) => b.evaluate(wo, wi, mode),
            Self::VarnishedDiffuse(b) => b.evaluate(wo, wi),
            Self::RoughVarnish(b) => b.evaluate(wo, wi),
            _ => Evaluated { f: self.eval(wo, wi, mode), pdf: self.pdf(wo, wi, mode) },
        }
    }

    /// Draws `wi` for `wo` with `uc` ∈ [0, 1) for the choice among lobes and `u` ∈ [0, 1)² for the direction;
    /// `None` when the light is absorbed or falls to the wrong side of the surface.
    pub fn sample(&self, wo: LocalDir, uc: f32, u: Vec2, mode: Mode) -> Option<BsdfSample> {
        match self {
            Self::Diffuse(b) => b.sample(wo, u),
            Self::DiffuseTransmission(b) => b.sample(wo, uc, u),
            Self::OrenNayar(b) => b.sample(wo, uc, u),
            Self::Mirror(b) => b.sample(wo),
            Self::ModifiedPhong(b) => b.sample(wo, uc, u),
            Self::LegacyPhong(b) => b.sample(wo, uc, u, mode),
            Self::Conductor(b) => b.sample(wo, u),
            Self::Dielectric(b) => b.sample(wo, uc, u, mode),
            Self::FinishedConductor(b) => b.sample(wo, uc, u),
            Self::FinishedDielectric(b) => b.sample(wo, uc, u, mode),
            Self::ThinDielectric(b) => b.sample(wo, uc),
            Self::VarnishedDiffuse(b) => b.sample(wo, uc, u),
            Self::RoughVarnish(b) => b.sample(wo, uc, u),
            Self::CoatedDiffuse(b) => b.sample(wo, uc, u, mode),
            Self::CoatedConductor(b) => b.sample(wo, uc, u, mode),
            Self::OpenPbr(b) => b.sample(wo, uc, u, mode),
            Self::Measured(b) => b.sample(wo, uc, u, mode),
            Self::Hair(b) => b.sample(wo, uc, u),
            Self::Stack(b) => b.sample(wo, uc, u, mode),
        }
    }

    /// ρ and τ for light that arrives from `wi`, discrete directions included: in closed form where the variant knows
    /// one, else by a deterministic average over its own samples.
    pub fn albedo(&self, wi: LocalDir) -> Albedo {
        self.closed_albedo(wi).unwrap_or_else(|| {
            // Towards sensors, weights are ratios of power.
            Albedo::by_sampling(|uc, u| self.sample(wi, uc, u, Mode::Importance))
        })
    }

    /// The same where it is a closed form or an integral by Gauss' rule; `None` where only samples can tell.
    pub fn closed_albedo(&self, wi: LocalDir) -> Option<Albedo> {
        match self {
            Self::Diffuse(b) => Some(b.albedo()),
            Self::DiffuseTransmission(b) => Some(b.albedo()),
            Self::OrenNayar(b) => Some(b.albedo(wi)),
            Self::Mirror(b) => Some(b.albedo()),
            Self::ModifiedPhong(_) | Self::LegacyPhong(_) => None,
            Self::Conductor(b) => b.albedo(wi),
            Self::Dielectric(b) => b.albedo(wi),
            Self::FinishedConductor(b) => b.albedo(wi),
            Self::FinishedDielectric(b) => b.albedo(wi),
            Self::ThinDielectric(b) => Some(b.albedo(wi)),
            Self::VarnishedDiffuse(b) => Some(b.albedo(wi)),
            Self::Stack(b) => b.albedo(wi),
            Self::RoughVarnish(_)
            | Self::CoatedDiffuse(_)
            | Self::CoatedConductor(_)
            | Self::OpenPbr(_)
            | Self::Measured(_)
            | Self::Hair(_) => None,
        }
    }

    /// The interface that light meets first, without any film; `None` where there is no single one.
    pub fn interface(&self) -> Option<Interface> {
        match self {
            Self::Conductor(b) => Some(Interface { eta: b.eta, k: b.k }),
            Self::Dielectric(b) => Some(Interface::clear(b.eta)),
            Self::FinishedConductor(b) => b.interface(),
            Self::FinishedDielectric(b) => b.interface(),
            Self::ThinDielectric(b) => Some(Interface::clear(b.eta)),
            Self::VarnishedDiffuse(b) => Some(Interface::clear(b.layers().coat.interface.eta)),
            Self::RoughVarnish(b) => Some(Interface::clear(b.varnish.coat().interface.eta)),
            Self::CoatedDiffuse(b) => Some(Interface::clear(b.coat.interface.eta)),
            Self::CoatedConductor(b) => Some(Interface::clear(b.coat.interface.eta)),
            Self::Stack(b) => Some(Interface { eta: b.top_eta(), k: Sampled::ZERO }),
            _ => None,
        }
    }

    /// Which continuous lobes are present.
    pub fn lobes(&self) -> Lobes {
        match self {
            Self::Diffuse(b) => b.lobes(),
            Self::DiffuseTransmission(b) => b.lobes(),
            Self::OrenNayar(b) => b.lobes(),
            Self::Mirror(b) => b.lobes(),
            Self::ModifiedPhong(b) => b.lobes(),
            Self::LegacyPhong(b) => b.lobes(),
            Self::Conductor(b) => b.lobes(),
            Self::Dielectric(b) => b.lobes(),
            Self::FinishedConductor(b) => b.lobes(),
            Self::FinishedDielectric(b) => b.lobes(),
            Self::ThinDielectric(_) => Lobes::default(),
            Self::VarnishedDiffuse(b) => b.lobes(),
            Self::RoughVarnish(b) => b.lobes(),
            Self::CoatedDiffuse(b) => b.lobes(),
            Self::CoatedConductor(b) => b.lobes(),
            Self::OpenPbr(b) => b.lobes(),
            Self::Measured(b) => b.lobes(),
            Self::Hair(b) => b.lobes(),
            Self::Stack(b) => b.lobes(),
        }
    }

    /// Widens narrow lobes after a wide one, so that no path finds a light by luck alone: a named bias,
    /// off unless asked for (pbrt-v4 book, 14.2).
    pub fn regularize(&mut self) {
        match self {
            Self::Diffuse(_)
            | Self::DiffuseTransmission(_)
            | Self::ThinDielectric(_)
            | Self::Measured(_)
            | Self::OrenNayar(_)
            | Self::Hair(_) => {}
            Self::Mirror(b) => *self = Self::ModifiedPhong(b.regularized()),
            Self::ModifiedPhong(b) => b.regularize(),
            Self::LegacyPhong(b) => b.regularize(),
            Self::Conductor(b) => b.regularize(),
            Self::Dielectric(b) => b.regularize(),
            Self::FinishedConductor(b) => b.regularize(),
            Self::FinishedDielectric(b) => b.regularize(),
            Self::VarnishedDiffuse(b) => {
                // Widened, the coat is rough: the closed form ends.
                let mut layers = *b.layers();
                layers.regularize();
                *self = Self::CoatedDiffuse(layers);
            }
            Self::RoughVarnish(b) => {
                // The tables are those of the coat as it is.
                let mut layers = b.layers();
                layers.regularize();
                *self = Self::CoatedDiffuse(layers);
            }
            Self::OpenPbr(b) => b.regularize(),
            Self::CoatedDiffuse(b) => b.regularize(),
            Self::CoatedConductor(b) => b.regularize(),
            Self::Stack(b) => b.regularize(),
        }
    }

    /// The same function with other random walks, where it is estimated by such.
    #[must_use]
    pub fn with_seed(mut self, seed: u64) -> Self {
        match &mut self {
            Self::RoughVarnish(b) => b.seed = seed,
            Self::CoatedDiffuse(b) => b.seed = seed,
            Self::CoatedConductor(b) => b.seed = seed,
            Self::Stack(b) => b.seed = seed,
            Self::Diffuse(_)
            | Self::DiffuseTransmission(_)
            | Self::OrenNayar(_)
            | Self::Mirror(_)
            | Self::ModifiedPhong(_)
            | Self::LegacyPhong(_)
            | Self::Conductor(_)
            | Self::Dielectric(_)
            | Self::FinishedConductor(_)
            | Self::FinishedDielectric(_)
            | Self::ThinDielectric(_)
            | Self::VarnishedDiffuse(_)
            | Self::OpenPbr(_)
            | Self::Measured(_)
            | Self::Hair(_) => {}
        }
        self
    }

    /// The ambient reflection coefficient ra of A (36), where it is stated apart from how light is scattered: by legacy
    /// shading alone.
    pub fn legacy_ambient(&self) -> Option<Sampled<Unitless>> {
        if let Self::LegacyPhong(b) = self { Some(b.ambient) } else { None }
    }

    /// What holds for this scattering function: what the conformance suite tests when a user asks.
    pub fn claims(&self) -> Claims {
        match self {
            Self::Diffuse(b) => b.claims(),
            Self::DiffuseTransmission(b) => b.claims(),
            Self::OrenNayar(b) => b.claims(),
            Self::Mirror(b) => b.claims(),
            Self::ModifiedPhong(b) => b.claims(),
            Self::LegacyPhong(b) => b.claims(),
            Self::Conductor(b) => b.claims(),
            Self::Dielectric(b) => b.claims(),
            Self::FinishedConductor(b) => b.claims(),
            Self::FinishedDielectric(b) => b.claims(),
            Self::ThinDielectric(b) => b.claims(),
            Self::VarnishedDiffuse(b) => b.claims(),
            Self::RoughVarnish(b) => b.claims(),
            Self::CoatedDiffuse(b) => b.claims(),
            Self::CoatedConductor(b) => b.claims(),
            Self::OpenPbr(b) => b.claims(),
            Self::Measured(b) => b.claims(),
            Self::Hair(b) => b.claims(),
            Self::Stack(b) => b.claims(),
        }
    }

    /// The specimens of every variant.
    pub fn specimens(cabinet: &'a Cabinet) -> Vec<Specimen<Self>> {
        let mut all = Vec::new();
        all.extend(Diffuse::specimens().map(|s| s.map(Self::Diffuse)));
        all.extend(DiffuseTransmission::specimens().map(|s| s.map(Self::DiffuseTransmission)));
        all.extend(OrenNayar::specimens().map(|s| s.map(Self::OrenNayar)));
        all.extend(Mirror::specimens().map(|s| s.map(Self::Mirror)));
        all.extend(ModifiedPhong::specimens().map(|s| s.map(Self::ModifiedPhong)));
        all.extend(LegacyPhong::specimens().map(|s| s.map(Self::LegacyPhong)));
        all.extend(Conductor::specimens().map(|s| s.map(Self::Conductor)));
        all.extend(Dielectric::specimens().map(|s| s.map(Self::Dielectric)));
        all.extend(FinishedConductor::specimens(&cabinet.conductors).map(|s| s.map(Self::FinishedConductor)));
        all.extend(
            FinishedDielectric::specimens(&cabinet.dielectrics).map(|s| s.map(Self::FinishedDielectric)),
        );
        all.extend(ThinDielectric::specimens().map(|s| s.map(Self::ThinDielectric)));
        all.extend(VarnishedDiffuse::specimens().map(|s| s.map(Self::VarnishedDiffuse)));
        all.extend(RoughVarnish::specimens(&cabinet.varnishes).map(|s| s.map(Self::RoughVarnish)));
        all.extend(Layered::<Diffuse>::specimens().map(|s| s.map(Self::CoatedDiffuse)));
        all.extend(Layered::<Conductor>::specimens().map(|s| s.map(Self::CoatedConductor)));
        all.extend(OpenPbr::specimens().map(|s| s.map(Self::OpenPbr)));
        all.extend(Measured::specimens(&cabinet.measured).map(|s| s.map(Self::Measured)));
        all.extend(Hair::specimens().map(|s| s.map(Self::Hair)));
        all.extend(Stack::specimens(&cabinet.stacks).map(|s| s.map(Self::Stack)));
        all
    }
}

/// The data that some specimens refer to.
#[derive(Debug)]
pub struct Cabinet {
    /// Small synthetic measurements.
    pub measured: Vec<measured::Synthetic>,
    /// Tables of rough coats.
    pub varnishes: Vec<Varnish>,
    /// Layers of stacks.
    pub stacks: StackCabinet,
    /// Losses of rough metals.
    pub conductors: finished_conductor::ConductorTables,
    /// Losses of rough interfaces.
    pub dielectrics: finished_dielectric::DielectricTables,
}

impl Default for Cabinet {
    fn default() -> Self {
        Self {
            measured: measured::synthetic_tables(),
            varnishes: rough_varnish::varnishes(),
            conductors: finished_conductor::ConductorTables::default(),
            dielectrics: finished_dielectric::DielectricTables::default(),
            stacks: StackCabinet::default(),
        }
    }
}
