//! What every material promises.

use super::inputs::Lookup;
use super::schema::{Arguments, Fault, Parameter};
use crate::bsdf::Bsdf;

/// What a class of materials is to the rest of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// It scatters.
    Surface,
    /// It scatters, perhaps into discrete directions, which light samples never meet.
    Specular,
    /// It chooses among others.
    Mix,
    /// It is a mere boundary of media.
    Interface,
}

/// A material, with the parameters it takes from a scene.
pub trait Declared: Sized {
    /// Its name in scene files.
    const CLASS: &'static str;
    /// The parameters that it takes.
    const PARAMETERS: &'static [Parameter];
    /// What it is to the scene.
    const ROLE: Role = Role::Surface;

    /// The material of these values.
    ///
    /// # Errors
    /// When values that are right by themselves do not go together.
    fn build(arguments: &Arguments) -> Result<Self, Fault>;

    /// Whether a parameter varies over the surface.
    fn is_textured(&self) -> bool;

    /// The scattering function at a point; `None` for materials that are none themselves. `seed` starts random walks.
    fn scatterer<'a>(&'a self, lookup: &mut Lookup<'_>, seed: u64) -> Option<Bsdf<'a>>;
}
