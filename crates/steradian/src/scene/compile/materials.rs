//! From material statements to materials.

use super::pictures::Reading;
use super::spectra::Meaning;
use super::textures::TextureCompiler;
use crate::material::{
    CoatInput, Detail, Material, MaterialId, Materials, Metal, NormalMapId, Roughness, RoughnessScale,
};
use crate::scene::desc::{
    ConductorOptics, FileRef, Id, LayerDesc, MaterialDesc, MaterialKind, RoughnessDesc, SpectrumParam,
};
use crate::spectrum::Spectrum;
use crate::texture::{FloatInput, SpectrumInput};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// The materials, and which of them a description's material became.
pub(super) struct CompiledMaterials {
    pub(super) materials: Materials,
    ids: Vec<MaterialId>,
}

impl CompiledMaterials {
    /// The compiled material of a described one.
    pub(super) fn id(&self, id: Id<MaterialDesc>) -> MaterialId {
        self.ids.get(id.index()).copied().unwrap_or(MaterialId(0))
    }
}

/// Compiles every material of the scene, used or not, so that every fault is reported.
pub(super) fn compile(descs: &[MaterialDesc], textures: &mut TextureCompiler<'_>) -> CompiledMaterials {
    let mut compiler =
        MaterialCompiler { textures, materials: Materials::new(), normal_maps: BTreeMap::new() };
    for mix in descs.iter().filter(|d| mixes_interface(&d.kind, descs)) {
        let message =
            "an interface inside a mix is not supported: it would let rays pass, but not the light of lamps";
        compiler.textures.diagnostics.error(mix.span, message);
    }
    let mut ids: Vec<Option<MaterialId>> = vec![None; descs.len()];
    // A mix may name materials that are stated after it: whoever has all its parts is next. No mix contains itself, so
    // every round makes progress until all are done.
    let mut waiting: Vec<usize> = (0..descs.len()).collect();
    while !waiting.is_empty() {
        let before = waiting.len();
        waiting.retain(|&i| match parts(&descs[i].kind, &ids) {
            Some(parts) => {
                ids[i] = Some(compiler.add(&descs[i], parts));
                false
            }
            None => true,
        });
        if waiting.len() == before {
            break;
        }
    }
    let ids = ids.into_iter().map(|id| id.unwrap_or(MaterialId(0))).collect();
    CompiledMaterials { materials: compiler.materials, ids }
}

/// Whether a material chooses between an interface and something else.
fn mixes_interface(kind: &MaterialKind, descs: &[MaterialDesc]) -> bool {
    let is_interface = |id: &Id<MaterialDesc>| {
        descs.get(id.index()).is_some_and(|d| matches!(d.kind, MaterialKind::Interface))
    };
    matches!(kind, MaterialKind::Mix { materials, .. } if materials.iter().any(is_interface))
}

/// The compiled parts of a mix (any two for other materials); `None` while one is missing.
fn parts(kind: &MaterialKind, ids: &[Option<MaterialId>]) -> Option<[MaterialId; 2]> {
    match kind {
        MaterialKind::Mix { materials: [a, b], .. } => {
            let part = |id: &Id<MaterialDesc>| ids.get(id.index()).copied().flatten();
            Some([part(a)?, part(b)?])
        }
        _ => Some([MaterialId(0); 2]),
    }
}

struct MaterialCompiler<'a, 'b> {
    textures: &'a mut TextureCompiler<'b>,
    materials: Materials,
    normal_maps: BTreeMap<PathBuf, NormalMapId>,
}

impl MaterialCompiler<'_, '_> {
    fn add(&mut self, desc: &MaterialDesc, parts: [MaterialId; 2]) -> MaterialId {
        let material = self.material(&desc.kind, parts);
        let detail = self.detail(desc);
        self.materials.push(material, detail).unwrap_or_else(|e| {
            self.textures.diagnostics.error(desc.span, e.to_string());
            MaterialId(0)
        })
    }

    fn material(&mut self, kind: &MaterialKind, parts: [MaterialId; 2]) -> Material {
        match kind {
            MaterialKind::Diffuse { reflectance } => {
                Material::Diffuse { reflectance: self.albedo(reflectance) }
            }
            MaterialKind::DiffuseTransmission { reflectance, transmittance, scale } => {
                Material::DiffuseTransmission {
                    reflectance: self.albedo(reflectance),
                    transmittance: self.albedo(transmittance),
                    scale: *scale,
                }
            }
            MaterialKind::Conductor { optics, roughness } => {
                Material::Conductor { metal: self.metal(optics), roughness: self.roughness(roughness) }
            }
            MaterialKind::Dielectric { eta, roughness } => {
                Material::Dielectric { eta: self.index(eta), roughness: self.roughness(roughness) }
            }
            MaterialKind::ThinDielectric { eta } => Material::ThinDielectric { eta: self.index(eta) },
            MaterialKind::CoatedDiffuse { reflectance, roughness, eta, layer } => Material::CoatedDiffuse {
                reflectance: self.albedo(reflectance),
                coat: self.coat(eta, roughness, layer),
            },
            MaterialKind::CoatedConductor {
                interface_roughness,
                interface_eta,
                optics,
                conductor_roughness,
                layer,
            } => Material::CoatedConductor {
                metal: self.metal(optics),
                roughness: self.roughness(conductor_roughness),
                coat: self.coat(interface_eta, interface_roughness, layer),
            },
            MaterialKind::Mix { amount, .. } => {
                Material::Mix { materials: parts, amount: self.textures.float(amount) }
            }
            MaterialKind::Interface => Material::Interface,
        }
    }

    fn detail(&mut self, desc: &MaterialDesc) -> Detail {
        if let Some(file) = &desc.normal_map {
            return self.normal_map(file).map_or(Detail::Flat, Detail::Normals);
        }
        match desc.displacement.as_ref().map(|height| self.textures.float(height)) {
            // A constant height moves the surface without tilting it.
            None | Some(FloatInput::Constant(_)) => Detail::Flat,
            Some(height) => Detail::Bump(height),
        }
    }

    fn normal_map(&mut self, file: &FileRef) -> Option<NormalMapId> {
        if let Some(&id) = self.normal_maps.get(&file.path) {
            return Some(id);
        }
        let map = self.textures.pictures.get(file, Reading::Vector, self.textures.diagnostics)?;
        match self.materials.push_normal_map(map) {
            Ok(id) => {
                self.normal_maps.insert(file.path.clone(), id);
                Some(id)
            }
            Err(e) => {
                let message = format!("{}: {e}", file.path.display());
                self.textures.diagnostics.error(file.span, message);
                None
            }
        }
    }

    fn albedo(&mut self, param: &SpectrumParam) -> SpectrumInput {
        self.textures.spectrum(param, Meaning::Albedo)
    }

    /// An index of refraction. The importer admits no texture here.
    fn index(&mut self, param: &SpectrumParam) -> Spectrum {
        match self.textures.spectrum(param, Meaning::Unbounded) {
            SpectrumInput::Constant(s) => s,
            SpectrumInput::Texture(_) => Spectrum::Constant(1.0),
        }
    }

    fn metal(&mut self, optics: &ConductorOptics) -> Metal {
        match optics {
            ConductorOptics::Index { eta, k } => Metal::Index {
                eta: self.textures.spectrum(eta, Meaning::Unbounded),
                k: self.textures.spectrum(k, Meaning::Unbounded),
            },
            ConductorOptics::Reflectance(r) => Metal::Reflectance(self.albedo(r)),
        }
    }

    fn roughness(&mut self, desc: &RoughnessDesc) -> Roughness {
        let scale = if desc.remap { RoughnessScale::Perceptual } else { RoughnessScale::Alpha };
        Roughness { u: self.textures.float(&desc.u), v: self.textures.float(&desc.v), scale }
    }

    fn coat(&mut self, eta: &SpectrumParam, roughness: &RoughnessDesc, layer: &LayerDesc) -> CoatInput {
        let limit = |n: u32| u16::try_from(n).unwrap_or(u16::MAX);
        CoatInput {
            eta: self.index(eta),
            roughness: self.roughness(roughness),
            thickness: self.textures.float(&layer.thickness),
            albedo: self.albedo(&layer.albedo),
            g: self.textures.float(&layer.g),
            max_depth: limit(layer.max_depth),
            samples: limit(layer.n_samples),
            ..CoatInput::default()
        }
    }
}
