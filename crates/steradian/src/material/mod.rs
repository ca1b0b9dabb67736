//! Materials: parameters that may be textured, and the scattering function they make at a point.

mod detail;
pub mod inputs;
pub mod surface;

pub use inputs::{CoatInput, Metal, Roughness, RoughnessScale};
pub use surface::{SurfaceBsdf, SurfaceSample};

use crate::bsdf::{
    Bsdf, Dielectric, Diffuse, DiffuseTransmission, ExitWeights, Layered, ThinDielectric, VarnishedDiffuse,
};
use crate::image::Image;
use crate::math::{Dir, Footprint, Shading, SurfacePoint, hash};
use crate::spectrum::{Spectrum, Wavelengths};
use crate::texture::{FloatInput, SpectrumInput, TextureContext, Textures};
use inputs::Lookup;
use std::sync::Arc;

/// A material of a [`Materials`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MaterialId(pub u32);

/// A map of normals of a [`Materials`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct NormalMapId(pub u32);

/// What a surface is made of.
#[derive(Clone, Debug, PartialEq)]
pub enum Material {
    /// Lambertian reflection.
    Diffuse {
        /// Reflectance, limited to [0, 1].
        reflectance: SpectrumInput,
    },
    /// Lambertian reflection and transmission.
    DiffuseTransmission {
        /// Reflectance before scaling.
        reflectance: SpectrumInput,
        /// Transmittance before scaling.
        transmittance: SpectrumInput,
        /// Factor on both, which are then limited to [0, 1].
        scale: f32,
    },
    /// A metal.
    Conductor {
        /// Its optical constants.
        metal: Metal,
        /// Its roughness.
        roughness: Roughness,
    },
    /// The interface to a transparent medium; a spectrum that varies makes it disperse.
    Dielectric {
        /// Index of the inside over the outside.
        eta: Spectrum,
        /// Roughness of the interface.
        roughness: Roughness,
    },
    /// A pane without thickness.
    ThinDielectric {
        /// Index of the pane.
        eta: Spectrum,
    },
    /// A dielectric coat over a Lambertian base.
    CoatedDiffuse {
        /// Reflectance of the base, limited to [0, 1].
        reflectance: SpectrumInput,
        /// The coat.
        coat: CoatInput,
    },
    /// A dielectric coat over a metal.
    CoatedConductor {
        /// The metal's optical constants, in air.
        metal: Metal,
        /// The metal's roughness.
        roughness: Roughness,
        /// The coat.
        coat: CoatInput,
    },
    /// One of two materials, chosen anew at each point and direction.
    Mix {
        /// The two.
        materials: [MaterialId; 2],
        /// Share of the second.
        amount: FloatInput,
    },
    /// The boundary of a medium: light passes straight.
    Interface,
}

impl Material {
    /// Whether a parameter varies over the surface; of a mix, its amount.
    fn is_textured(&self) -> bool {
        match self {
            Self::Diffuse { reflectance } => reflectance.is_textured(),
            Self::DiffuseTransmission { reflectance, transmittance, .. } => {
                reflectance.is_textured() || transmittance.is_textured()
            }
            Self::Conductor { metal, roughness } => metal.is_textured() || roughness.is_textured(),
            Self::Dielectric { roughness, .. } => roughness.is_textured(),
            Self::CoatedDiffuse { reflectance, coat } => reflectance.is_textured() || coat.is_textured(),
            Self::CoatedConductor { metal, roughness, coat } => {
                metal.is_textured() || roughness.is_textured() || coat.is_textured()
            }
            Self::Mix { amount, .. } => amount.is_textured(),
            Self::ThinDielectric { .. } | Self::Interface => false,
        }
    }
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
        if let Material::Mix { materials, .. } = &material
            && materials.iter().any(|id| id.0 as usize >= self.entries.len())
        {
            return Err(MaterialError::UnknownMaterial);
        }
        if let Detail::Normals(id) = detail
            && id.0 as usize >= self.normal_maps.len()
        {
            return Err(MaterialError::UnknownNormalMap);
        }
        let of = |id: MaterialId| self.needs_footprint(id);
        let needs_footprint = material.is_textured()
            || detail != Detail::Flat
            || matches!(&material, Material::Mix { materials, .. } if materials.iter().any(|&id| of(id)));
        self.entries.push(Entry { material, detail, needs_footprint });
        Ok(MaterialId(self.entries.len() as u32 - 1))
    }

    /// The material behind an id of this collection; an id of another one is a broken invariant.
    pub fn get(&self, id: MaterialId) -> &Material {
        &self.entries[id.0 as usize].material
    }

    /// Whether some coat is rough and weighs its walks in pbrt-v4's inconsistent way: a bias that belongs into the
    /// picture's metadata.
    pub fn has_inconsistent_coats(&self) -> bool {
        self.entries.iter().any(|e| match &e.material {
            Material::CoatedDiffuse { coat, .. } | Material::CoatedConductor { coat, .. } => {
                coat.weights == ExitWeights::Pbrt4 && !coat.roughness.is_smooth()
            }
            _ => false,
        })
    }

    /// Whether light passes the material straight, wherever it meets it.
    pub fn is_interface(&self, id: MaterialId) -> bool {
        matches!(self.get(id), Material::Interface)
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
        let mut entry = &self.entries[id.0 as usize];
        if let Material::Mix { .. } = entry.material {
            entry = self.unmixed(id, &TextureContext { point, footprint }, wo, textures);
        }
        let relief =
            self.relief(entry, point, footprint, textures).map(|shading| SurfacePoint { shading, ..*point });
        let point = relief.as_ref().unwrap_or(point);
        let mut lookup = Lookup::new(textures, point, footprint, w);
        let bsdf = scatterer(&entry.material, &mut lookup, seed)?;
        Some(SurfaceBsdf::new(bsdf, &point.shading))
    }

    /// Follows mixes to a material that is none. Ends, since a mix refers to earlier materials only.
    ///
    /// Out of line: the hash does not depend on the loop, so that it would be computed before it, for every material.
    #[inline(never)]
    fn unmixed(&self, id: MaterialId, at: &TextureContext<'_>, wo: Dir, textures: &Textures) -> &Entry {
        let mut entry = &self.entries[id.0 as usize];
        while let Material::Mix { materials: [first, second], amount } = &entry.material {
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

/// The scattering function of a material that is no mix; `None` for a boundary of media.
fn scatterer<'a>(material: &'a Material, lookup: &mut Lookup, seed: u64) -> Option<Bsdf<'a>> {
    Some(match material {
        Material::Diffuse { reflectance } => {
            Bsdf::Diffuse(Diffuse { reflectance: lookup.reflectance(reflectance) })
        }
        Material::DiffuseTransmission { reflectance, transmittance, scale } => {
            let scaled = |input| (lookup.spectrum(input) * *scale).clamp(0.0, 1.0);
            Bsdf::DiffuseTransmission(DiffuseTransmission {
                reflectance: scaled(reflectance),
                transmittance: scaled(transmittance),
            })
        }
        Material::Conductor { metal, roughness } => Bsdf::Conductor(metal.at(roughness, lookup)),
        Material::Dielectric { eta, roughness } => {
            Bsdf::Dielectric(Dielectric { eta: lookup.index(eta), roughness: roughness.at(lookup) })
        }
        Material::ThinDielectric { eta } => Bsdf::ThinDielectric(ThinDielectric { eta: lookup.index(eta) }),
        Material::CoatedDiffuse { reflectance, coat } => {
            let base = Diffuse { reflectance: lookup.reflectance(reflectance) };
            let layers = Layered { coat: coat.at(lookup), base, seed };
            VarnishedDiffuse::new(layers).map_or(Bsdf::CoatedDiffuse(layers), Bsdf::VarnishedDiffuse)
        }
        Material::CoatedConductor { metal, roughness, coat } => {
            let coat = coat.at(lookup);
            let mut base = metal.at(roughness, lookup);
            // The metal meets the coat, not air.
            base.eta = base.eta / coat.interface.eta;
            base.k = base.k / coat.interface.eta;
            Bsdf::CoatedConductor(Layered { coat, base, seed })
        }
        Material::Mix { .. } | Material::Interface => return None,
    })
}

#[cfg(test)]
mod tests;
