//! From material statements to materials.

use super::pictures::Reading;
use super::spectra::Meaning;
use super::textures::TextureCompiler;
use crate::material::schema::{Argument, File, Quantity, Value};
use crate::material::{
    Arguments, Detail, MaterialId, Materials, NormalMapId, Parameter, ParameterKind, Role,
};
use crate::scene::desc::{ArgumentValue, FileRef, Id, MaterialDesc};
use crate::spectrum::{LAMBDA_MAX, LAMBDA_MIN};
use crate::texture::FloatInput;
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
    for mix in descs.iter().filter(|d| mixes_interface(d, descs)) {
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
        waiting.retain(|&i| match parts(&descs[i], &ids) {
            Some(parts) => {
                ids[i] = Some(compiler.add(i, &descs[i], &parts));
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
fn mixes_interface(desc: &MaterialDesc, descs: &[MaterialDesc]) -> bool {
    desc.class.role == Role::Mix
        && desc.parts().any(|id| descs.get(id.index()).is_some_and(MaterialDesc::is_interface))
}

/// The compiled materials that a material refers to; `None` while one is missing.
fn parts(desc: &MaterialDesc, ids: &[Option<MaterialId>]) -> Option<Vec<MaterialId>> {
    desc.parts().map(|id| ids.get(id.index()).copied().flatten()).collect()
}

struct MaterialCompiler<'a, 'b> {
    textures: &'a mut TextureCompiler<'b>,
    materials: Materials,
    normal_maps: BTreeMap<PathBuf, NormalMapId>,
}

impl MaterialCompiler<'_, '_> {
    /// Adds a material; one that cannot be made is reported, and the first material stands in for it.
    fn add(&mut self, index: usize, desc: &MaterialDesc, parts: &[MaterialId]) -> MaterialId {
        let detail = self.detail(desc);
        let Some(arguments) = self.arguments(desc, parts) else { return MaterialId(0) };
        let built = (desc.class.build)(&arguments).map_err(|fault| {
            let span = desc.argument(fault.parameter).map_or(desc.span, |a| a.span);
            (span, fault.message)
        });
        let added = built.and_then(|material| {
            self.materials.push(material, detail).map_err(|e| (desc.span, e.to_string()))
        });
        match added {
            Ok(id) => {
                let label = desc.name.clone().unwrap_or_else(|| format!("{}#{index}", desc.class.name));
                self.materials.set_label(id, label);
                self.materials.set_range(id, arguments.range());
                self.check_range(desc, id);
                id
            }
            Err((span, message)) => {
                self.textures.diagnostics.error(span, message);
                MaterialId(0)
            }
        }
    }

    /// What a file has no data for, a film cannot record; spectra say so themselves.
    fn check_range(&mut self, desc: &MaterialDesc, id: MaterialId) {
        let Some([from, to]) = self.textures.spectra.beyond_visible() else { return };
        let file = desc.class.parameters.iter().find(|p| matches!(p.kind, ParameterKind::File { .. }));
        let Some(argument) = file.and_then(|file| desc.argument(file.name)) else { return };
        let (first, last) = self.materials.range(id);
        // Ends are held over the film's default range.
        if from < first.min(LAMBDA_MIN) || to > last.max(LAMBDA_MAX) {
            let message =
                format!("the film records {from}–{to} nm, but there are data for {first}–{last} nm only");
            self.textures.diagnostics.error(argument.span, message);
        }
    }

    /// The values of all parameters; `None` when a file cannot be read.
    fn arguments(&mut self, desc: &MaterialDesc, parts: &[MaterialId]) -> Option<Arguments> {
        let mut values = Vec::with_capacity(desc.arguments.len());
        for (parameter, a) in desc.class.parameters.iter().zip(&desc.arguments) {
            let value = self.value(parameter, &a.value, parts)?;
            values.push(Argument { name: a.name, value, given: a.given });
        }
        Some(Arguments::new(values))
    }

    fn value(&mut self, parameter: &Parameter, value: &ArgumentValue, parts: &[MaterialId]) -> Option<Value> {
        let textures = &mut *self.textures;
        Some(match value {
            ArgumentValue::Spectrum(v) => {
                let meaning = match parameter.kind {
                    ParameterKind::Spectrum { quantity: Quantity::Fraction, .. } => Meaning::Albedo,
                    _ => Meaning::Unbounded,
                };
                Value::Spectrum(v.as_ref().map(|v| textures.spectrum(v, meaning)))
            }
            ArgumentValue::Index(v) => Value::Index(
                v.as_ref().map(|v| textures.spectra.compile(v, Meaning::Unbounded, textures.diagnostics)),
            ),
            ArgumentValue::Float(v) => Value::Float(v.as_ref().map(|v| textures.float(v))),
            ArgumentValue::Number(v) => Value::Number(*v),
            ArgumentValue::Numbers(v) => Value::Numbers(v.clone()),
            ArgumentValue::Spectra(v) => {
                let compile = |v| textures.spectra.compile(v, Meaning::Unbounded, textures.diagnostics);
                Value::Spectra(v.iter().map(compile).collect())
            }
            ArgumentValue::Flag(v) => Value::Flag(*v),
            ArgumentValue::Count(v) => Value::Count(*v),
            ArgumentValue::Choice(v) => Value::Choice(v),
            ArgumentValue::File(None) => Value::File(None),
            ArgumentValue::File(Some(file)) => {
                Value::File(Some(File { path: file.path.clone(), bytes: textures.file(file)? }))
            }
            // A class has one such parameter at most.
            ArgumentValue::Materials(_) => Value::Materials(parts.to_vec()),
        })
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
}
