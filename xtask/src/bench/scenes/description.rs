//! What both scene formats are written from.

use super::mesh::Mesh;
use super::pictures::Picture;

/// A scene.
pub(super) struct Scene {
    /// How it is looked at.
    pub(super) view: View,
    /// What stands in it.
    pub(super) objects: Vec<Object>,
    /// Small lamps in it.
    pub(super) lamps: Vec<Lamp>,
    /// Files of pictures, by name.
    pub(super) pictures: Vec<(&'static str, Picture)>,
    /// The surroundings, where there are any.
    pub(super) environment: Option<Environment>,
}

/// A camera without lens, its picture and the length of paths. y is up.
pub(super) struct View {
    pub(super) eye: [f32; 3],
    pub(super) target: [f32; 3],
    /// Angle of the shorter side [°].
    pub(super) fov: f32,
    pub(super) width: u32,
    pub(super) height: u32,
    /// One more than the bounces of a path.
    pub(super) max_depth: u32,
}

/// A mesh of one material.
pub(super) struct Object {
    /// Name of its file.
    pub(super) name: &'static str,
    pub(super) mesh: Mesh,
    pub(super) material: Material,
    /// Radiance that it emits along its normals, as linear sRGB of unit luminance.
    pub(super) emission: Option<[f32; 3]>,
}

/// A shining ball.
pub(super) struct Lamp {
    pub(super) center: [f32; 3],
    pub(super) radius: f32,
    /// As [`Object::emission`].
    pub(super) radiance: [f32; 3],
}

/// How a surface scatters.
pub(super) enum Material {
    /// Lambertian.
    Diffuse(Color),
    /// Lambertian on both sides, for sheets.
    Sheet(Color),
    /// A clear dielectric of index 1.5 over a Lambertian base, smooth where `alpha` is zero.
    Coated { base: Color, alpha: f32 },
    /// The boundary of glass, smooth where `alpha` is zero.
    Dielectric { eta: f32, alpha: f32 },
    /// A metal by its index at the wavelengths [`METAL_NM`].
    Conductor { eta: [f32; 5], k: [f32; 5], alpha: f32 },
}

/// Wavelengths of the metals' indices [nm].
pub(super) const METAL_NM: [f32; 5] = [360.0, 450.0, 540.0, 640.0, 830.0];

/// A reflectance.
pub(super) enum Color {
    /// Linear sRGB.
    Rgb([f32; 3]),
    /// A picture of the scene.
    Picture(&'static str),
}

/// The same surroundings as either program wants them.
pub(super) struct Environment {
    /// Name of an equal-area octahedral square.
    pub(super) square: &'static str,
    /// Name of a latitude–longitude picture.
    pub(super) latlong: &'static str,
}
