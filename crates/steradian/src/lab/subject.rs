//! A material of a scene on a flat patch, ready to be examined.

use crate::bsdf::Bsdf;
use crate::material::{Material, MaterialId};
use crate::math::{BoundedPoint, Footprint, Normal, Point, Shading, SurfacePoint, Vec2, Vec3};
use crate::scene::RenderJob;
use crate::spectrum::Wavelengths;

/// A material of a scene, on a flat patch with normal z and ∂p/∂u along x, without relief.
#[derive(Clone, Copy, Debug)]
pub struct Subject<'j> {
    job: &'j RenderJob,
    id: MaterialId,
    uv: Vec2,
}

/// A scene has no material of that name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the scene has no material \"{name}\"")]
pub struct UnknownMaterial {
    /// The name that was asked for.
    pub name: String,
    /// The names that the scene has.
    pub known: Vec<String>,
}

impl<'j> Subject<'j> {
    /// All materials of the scene, at the middle of their texture coordinates. The first is the format's default, which
    /// every scene has.
    pub fn all(job: &'j RenderJob) -> Vec<Self> {
        let uv = Vec2::splat(0.5);
        job.scene.materials().ids().map(|id| Self { job, id, uv }).collect()
    }

    /// The material of that name.
    ///
    /// # Errors
    /// When the scene has none.
    pub fn find(job: &'j RenderJob, name: &str) -> Result<Self, UnknownMaterial> {
        let all = Self::all(job);
        let found = all.iter().find(|s| s.name() == name).copied();
        found.ok_or_else(|| UnknownMaterial {
            name: name.to_owned(),
            known: all.iter().map(|s| s.name().to_owned()).collect(),
        })
    }

    /// The material's name; for one that is stated in place its class and number.
    pub fn name(&self) -> &'j str {
        self.job.scene.materials().label(self.id)
    }

    /// The wavelengths for which its spectra have data [nm]; the whole of [0, ∞) where it has none that end.
    pub fn range(&self) -> (f32, f32) {
        self.job.scene.materials().range(self.id)
    }

    /// The material.
    pub fn material(&self) -> &'j Material {
        self.job.scene.materials().get(self.id)
    }

    /// The two materials that a mix chooses from; none for others.
    pub fn parts(&self) -> Vec<Self> {
        self.material().parts().iter().map(|&id| Self { id, ..*self }).collect()
    }

    /// The same material at other texture coordinates.
    #[must_use]
    pub fn at_uv(self, uv: Vec2) -> Self {
        Self { uv, ..self }
    }

    /// Whether it looks different at different texture coordinates, as far as textures go.
    pub fn is_textured(&self) -> bool {
        self.material().is_textured()
    }

    /// The scattering function at the given wavelengths; `None` for a mix and for a mere boundary of media.
    ///
    /// Drops the companions of `w` where directions depend on the wavelength. `seed` starts random walks.
    pub fn scatterer(&self, w: &mut Wavelengths, seed: u64) -> Option<Bsdf<'j>> {
        let scene = &self.job.scene;
        let point = patch(self.uv);
        scene.materials().scatterer(self.id, &point, &Footprint::ZERO, scene.textures(), w, seed)
    }
}

fn patch(uv: Vec2) -> SurfacePoint {
    let n = Normal::Z;
    SurfacePoint {
        p: BoundedPoint::exact(Point::new(uv.x, uv.y, 0.0)),
        ng: n,
        uv,
        dpdu: Vec3::X,
        dpdv: Vec3::Y,
        shading: Shading { n, dpdu: Vec3::X, dpdv: Vec3::Y, dndu: Vec3::ZERO, dndv: Vec3::ZERO },
        time: 0.0,
        face: 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::diagnostic::Diagnostics;
    use crate::scene::import::pbrt::{Input, import};
    use crate::scene::{MemoryFiles, compile};
    use crate::spectrum::LANES;
    use std::path::Path;

    fn job(text: &str) -> RenderJob {
        let files = MemoryFiles::default();
        let input = Input::Text { name: "test", bytes: text.as_bytes(), base: Path::new("") };
        let imported = import(&[input], &files);
        let mut diagnostics: Diagnostics = imported.diagnostics;
        let job = compile(imported.scene.expect("a scene"), &files, &mut diagnostics);
        job.expect("compiles")
    }

    #[test]
    fn a_material_is_found_by_its_name_and_scatters_as_it_says() {
        let job = job(
            "WorldBegin MakeNamedMaterial \"paint\" \"string type\" \"diffuse\" \"spectrum reflectance\" [400 0.2 700 0.5] \
             Material \"interface\"",
        );
        let paint = Subject::find(&job, "paint").unwrap();
        let mut w = Wavelengths::exactly([400.0, 550.0, 700.0, 700.0]);
        let Some(Bsdf::Diffuse(d)) = paint.scatterer(&mut w, 0) else { panic!("diffuse") };
        for (lane, expected) in [0.2, 0.35, 0.5, 0.5].into_iter().enumerate().take(LANES) {
            assert!((d.reflectance[lane] - expected).abs() < 1e-6);
        }
        let unknown = Subject::find(&job, "pain").unwrap_err();
        assert_eq!(unknown.known, ["diffuse#0", "paint", "interface#2"]);
        assert!(Subject::find(&job, "interface#2").unwrap().scatterer(&mut w, 0).is_none());
    }
}
