//! Materials: parameters that may be textured, and the scattering function they make at a point.
//!
//! Each material declares its parameters ([`Declared`]); importers and the compiler follow the schema.

pub mod coated;
pub mod conductor;
pub mod declared;
mod detail;
pub mod dielectric;
pub mod diffuse;
pub mod finish;
pub mod hair;
pub mod inputs;
pub mod leaf;
pub mod legacy_phong;
pub mod mirror;
pub mod measured;
pub mod mix;
pub mod modified_phong;
pub mod oren_nayar;
mod passive;
pub mod openpbr;
pub mod schema;
pub mod stack;
pub mod surface;

pub use coated::{CoatedConductorMaterial, CoatedDiffuseMaterial};
pub use conductor::ConductorMaterial;
pub use declared::{Declared, Role};
pub use dielectric::{DielectricMaterial, ThinDielectricMaterial};
pub use diffuse::{DiffuseMaterial, DiffuseTransmissionMaterial};
pub use hair::{HairMaterial, Pigment};
pub use inputs::{CoatInput, Lookup, Metal, Roughness, RoughnessScale};
pub use leaf::LeafMaterial;
pub use legacy_phong::LegacyPhongMaterial;
pub use measured::MeasuredMaterial;
pub use mirror::MirrorMaterial;
pub use mix::{InterfaceMaterial, MixMaterial};
pub use modified_phong::ModifiedPhongMaterial;
pub use openpbr::OpenPbrMaterial;
pub use oren_nayar::OrenNayarMaterial;
pub use schema::{Arguments, Fault, MaterialId, Parameter, ParameterKind};
pub use stack::{StackBase, StackMaterial};
pub use surface::{Evaluation, SurfaceBsdf, SurfaceSample};

use crate::bsdf::Bsdf;
use crate::image::Image;
use crate::math::{Dir, Footprint, Shading, SurfacePoint, hash};
use crate::spectrum::Wavelengths;
use crate::texture::{FloatInput, TextureContext, Textures};
use std::sync::Arc;

/// A map of normals of a [`Materials`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct NormalMapId(pub u32);

/// A class of materials, as importers see it.
#[derive(Clone, Copy, Debug)]
pub struct Class {
    /// Its name in scene files.
    pub name: &'static str,
    /// The parameters that it takes.
    pub parameters: &'static [Parameter],
    /// What it is to the scene.
    pub role: Role,
    /// Makes a material from their values.
    pub build: fn(&Arguments) -> Result<Material, Fault>,
}

/// The closed set: one line for each material.
macro_rules! materials {
    ($($(#[$doc:meta])* $name:ident($type:ty),)*) => {
        /// What a surface is made of.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Material {
            $($(#[$doc])* $name($type),)*
        }

        /// All classes of materials.
        pub const CLASSES: &[Class] = &[$(Class {
            name: <$type>::CLASS,
            parameters: <$type>::PARAMETERS,
            role: <$type>::ROLE,
            build: |arguments| <$type>::build(arguments).map(Material::$name),
        },)*];

        impl Material {
            /// Its class.
            pub fn class(&self) -> &'static str {
                match self {
                    $(Self::$name(_) => <$type>::CLASS,)*
                }
            }

            /// Whether a parameter varies over the surface; of a mix, its amount.
            pub fn is_textured(&self) -> bool {
                match self {
                    $(Self::$name(m) => m.is_textured(),)*
                }
            }

            /// The scattering function at a point; `None` for a mix and for a boundary of media.
            fn scatterer<'a>(&'a self, lookup: &mut Lookup<'_>, seed: u64) -> Option<Bsdf<'a>> {
                match self {
                    $(Self::$name(m) => m.scatterer(lookup, seed),)*
                }
            }
        }
    };
}

materials! {
    /// Lambertian reflection.
    Diffuse(DiffuseMaterial),
    /// Lambertian reflection and transmission.
    DiffuseTransmission(DiffuseTransmissionMaterial),
    /// A metal.
    Conductor(ConductorMaterial),
    /// The interface to a transparent medium.
    Dielectric(DielectricMaterial),
    /// A pane without thickness.
    ThinDielectric(ThinDielectricMaterial),
    /// A dielectric coat over a Lambertian base.
    CoatedDiffuse(CoatedDiffuseMaterial),
    /// A dielectric coat over a metal.
    CoatedConductor(CoatedConductorMaterial),
    /// Rough diffuse reflection.
    OrenNayar(OrenNayarMaterial),
    /// A perfect mirror.
    Mirror(MirrorMaterial),
    /// The modified Phong model.
    ModifiedPhong(ModifiedPhongMaterial),
    /// Phong's legacy shading: not a BRDF.
    LegacyPhong(LegacyPhongMaterial),
    /// Scattering as it was measured.
    Measured(MeasuredMaterial),
    /// A hair.
    Hair(HairMaterial),
    /// A stack of layers.
    Stack(StackMaterial),
    /// A leaf by what it holds.
    Leaf(LeafMaterial),
    /// OpenPBR Surface.
    OpenPbr(OpenPbrMaterial),
    /// One of two materials.
    Mix(MixMaterial),
    /// The boundary of a medium.
    Interface(InterfaceMaterial),
}

impl Material {
    /// The materials that it chooses from; none for one that scatters itself.
    pub fn parts(&self) -> &[MaterialId] {
        match self {
            Self::Mix(mix) => &mix.materials,
            _ => &[],
        }
    }
}

/// The class of that name.
pub fn class(name: &str) -> Option<&'static Class> {
    CLASSES.iter().find(|c| c.name == name)
}

/// Relief that is shaded but not built.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Detail {
    /// None.
    #[default]
    Flat,
    /// Displacement along the normal [scene units].
    Bump(FloatInput),
    /// Normals from a picture.
    Normals(NormalMapId),
}

/// Why a material was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MaterialError {
    /// A mix names a material that was not added before it.
    #[error("mix refers to a material that does not exist yet")]
    UnknownMaterial,
    /// A detail names a map that was not added before it.
    #[error("material refers to a normal map that does not exist yet")]
    UnknownNormalMap,
    /// A map of normals needs three channels.
    #[error("normal map has {0} channels, but needs red, green and blue")]
    NormalMapChannels(usize),
}

/// All materials of a scene.
#[derive(Clone, Debug, Default)]
pub struct Materials {
    entries: Vec<Entry>,
    normal_maps: Vec<Arc<Image>>,
}

#[derive(Clone, Debug)]
struct Entry {
    material: Material,
    detail: Detail,
    needs_footprint: bool,
    label: String,
    range: (f32, f32),
}

impl Materials {
    /// No materials.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a map of normals, whose channels are 2 c − 1 along the shading frame, linear.
    ///
    /// # Errors
    /// When the picture has fewer than three channels.
    pub fn push_normal_map(&mut self, map: impl Into<Arc<Image>>) -> Result<NormalMapId, MaterialError> {
        let map = map.into();
        let channels = map.layout().channels();
        if channels < 3 {
            return Err(MaterialError::NormalMapChannels(channels));
        }
        self.normal_maps.push(map);
        Ok(NormalMapId(self.normal_maps.len() as u32 - 1))
    }

    /// Adds a material.
    ///
    /// # Errors
    /// When it refers to a material or map that was not added before it, so that mixes cannot form cycles.
    pub fn push(&mut self, material: Material, detail: Detail) -> Result<MaterialId, MaterialError> {
        if material.parts().iter().any(|id| id.0 as usize >= self.entries.len()) {
            return Err(MaterialError::UnknownMaterial);
        }
        if let Detail::Normals(id) = detail
            && id.0 as usize >= self.normal_maps.len()
        {
            return Err(MaterialError::UnknownNormalMap);
        }
        let of = |id: MaterialId| self.needs_footprint(id);
        let needs_footprint =
            material.is_textured() || detail != Detail::Flat || material.parts().iter().any(|&id| of(id));
        self.entries.push(Entry {
            material,
            detail,
            needs_footprint,
            label: String::new(),
            range: (0.0, f32::INFINITY),
        });
        Ok(MaterialId(self.entries.len() as u32 - 1))
    }

    /// The material behind an id of this collection; an id of another one is a broken invariant.
    pub fn get(&self, id: MaterialId) -> &Material {
        &self.entries[id.0 as usize].material
    }

    /// All ids, in the order of adding.
    pub fn ids(&self) -> impl Iterator<Item = MaterialId> + use<> {
        (0..self.entries.len() as u32).map(MaterialId)
    }

    /// What people call the material; empty until it is said.
    pub fn label(&self, id: MaterialId) -> &str {
        &self.entries[id.0 as usize].label
    }

    /// Says what people call the material.
    pub fn set_label(&mut self, id: MaterialId, label: impl Into<String>) {
        self.entries[id.0 as usize].label = label.into();
    }

    /// The wavelengths for which all of the material's spectra have data [nm]; all of them until it is said. Beyond them the
    /// material is not known: its spectra are zero there.
    pub fn range(&self, id: MaterialId) -> (f32, f32) {
        let entry = &self.entries[id.0 as usize];
        match &entry.material {
            Material::Measured(m) => m.table.range(),
            Material::Leaf(m) => m.range(),
            _ => entry.range,
        }
    }

    /// Says for which wavelengths there are data.
    pub fn set_range(&mut self, id: MaterialId, range: (f32, f32)) {
        self.entries[id.0 as usize].range = range;
    }

    /// The scattering function of material `id` alone, without relief and in the frame of the shading normal; `None` for
    /// materials that are a mix or a mere boundary of media.
    ///
    /// Drops the companions of `w` where directions depend on the wavelength. `seed` starts random walks.
    pub fn scatterer<'a>(
        &'a self,
        id: MaterialId,
        point: &SurfacePoint,
        footprint: &Footprint,
        textures: &Textures,
        w: &mut Wavelengths,
        seed: u64,
    ) -> Option<Bsdf<'a>> {
        self.get(id).scatterer(&mut Lookup::new(textures, point, footprint, w), seed)
    }

    /// Whether some coat is rough and weighs its walks in pbrt-v4's inconsistent way: a bias that belongs into the
    /// picture's metadata.
    pub fn has_inconsistent_coats(&self) -> bool {
        self.entries.iter().any(|e| match &e.material {
            Material::CoatedDiffuse(m) => m.coat.is_inconsistent(),
            Material::CoatedConductor(m) => m.coat.is_inconsistent(),
            _ => false,
        })
    }

    /// Whether light passes the material straight, wherever it meets it.
    pub fn is_interface(&self, id: MaterialId) -> bool {
        matches!(self.get(id), Material::Interface(_))
    }

    /// Whether the material looks at how fast its texture coordinates change, at any point.
    ///
    /// Only textures and relief do; a footprint costs as much as an intersection.
    pub fn needs_footprint(&self, id: MaterialId) -> bool {
        self.entries[id.0 as usize].needs_footprint
    }

    /// The scattering function of material `id` at `point`, seen from `wo`; `None` for a mere boundary of media,
    /// which light passes straight.
    ///
    /// Applies relief to the shading frame, and chooses among mixed materials by a hash of point and direction.
    /// Drops the companions of `w` where directions depend on the wavelength. `seed` starts the random walks of
    /// layered materials.
    #[inline(always)]
    pub fn shade<'a>(
        &'a self,
        id: MaterialId,
        point: &SurfacePoint,
        footprint: &Footprint,
        wo: Dir,
        textures: &Textures,
        w: &mut Wavelengths,
        seed: u64,
    ) -> Option<SurfaceBsdf<'a>> {
        let entry = &self.entries[id.0 as usize];
        if let (Material::Diffuse(diffuse), Detail::Flat) = (&entry.material, entry.detail) {
            // The commonest, in the caller's loop; it has no use for the direction of the parametrisation.
            let bsdf = diffuse.scatterer(&mut Lookup::new(textures, point, footprint, w), seed)?;
            return Some(SurfaceBsdf::isotropic(bsdf, point.shading.n));
        }
        self.shade_rarer(id, point, footprint, wo, textures, w, seed)
    }

    #[inline(never)]
    fn shade_rarer<'a>(
        &'a self,
        id: MaterialId,
        point: &SurfacePoint,
        footprint: &Footprint,
        wo: Dir,
        textures: &Textures,
        w: &mut Wavelengths,
        seed: u64,
    ) -> Option<SurfaceBsdf<'a>> {
        let mut entry = &self.entries[id.0 as usize];
        if let Material::Mix(_) = entry.material {
            entry = self.unmixed(id, &TextureContext { point, footprint }, wo, textures);
        }
        let relief =
            self.relief(entry, point, footprint, textures).map(|shading| SurfacePoint { shading, ..*point });
        let point = relief.as_ref().unwrap_or(point);
        let mut lookup = Lookup::new(textures, point, footprint, w);
        let bsdf = entry.material.scatterer(&mut lookup, seed)?;
        Some(SurfaceBsdf::new(bsdf, &point.shading))
    }

    /// Follows mixes to a material that is none. Ends, since a mix refers to earlier materials only.
    ///
    /// Out of line: the hash does not depend on the loop, so that it would be computed before it, for every material.
    #[inline(never)]
    fn unmixed(&self, id: MaterialId, at: &TextureContext<'_>, wo: Dir, textures: &Textures) -> &Entry {
        let mut entry = &self.entries[id.0 as usize];
        while let Material::Mix(MixMaterial { materials: [first, second], amount }) = &entry.material {
            let amount = textures.float_input(amount, at);
            let p = at.point.p.p;
            let key = hash::hash_floats(&[p.x, p.y, p.z, wo.x, wo.y, wo.z]);
            let u = hash::to_unit(hash::combine(key, u64::from(first.0) << 32 | u64::from(second.0)));
            let chosen = if u < amount { second } else { first };
            entry = &self.entries[chosen.0 as usize];
        }
        entry
    }

    /// The shading geometry under the material's relief; `None` where that leaves it as it is.
    fn relief(
        &self,
        entry: &Entry,
        point: &SurfacePoint,
        footprint: &Footprint,
        textures: &Textures,
    ) -> Option<Shading> {
        match entry.detail {
            Detail::Flat => None,
            Detail::Bump(displacement) => detail::bump(point, footprint, |point| {
                textures.float_input(&displacement, &TextureContext { point, footprint })
            }),
            Detail::Normals(id) => detail::normal_map(point, &self.normal_maps[id.0 as usize]),
        }
    }
}

#[cfg(test)]
mod tests;
