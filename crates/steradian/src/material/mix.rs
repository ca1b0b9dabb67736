//! `Material "mix"` and `Material "interface"`: materials that do not scatter themselves.

use super::declared::{Declared, Role};
use super::inputs::Lookup;
use super::schema::{Arguments, Fault, MaterialId, Parameter};
use crate::bsdf::Bsdf;
use crate::texture::FloatInput;

/// One of two materials, chosen anew at each point and direction.
#[derive(Clone, Debug, PartialEq)]
pub struct MixMaterial {
    /// The two.
    pub materials: [MaterialId; 2],
    /// Share of the second.
    pub amount: FloatInput,
}

impl Declared for MixMaterial {
    const CLASS: &'static str = "mix";
    const PARAMETERS: &'static [Parameter] =
        &[Parameter::materials("materials", 2), Parameter::float("amount", 0.5)];
    const ROLE: Role = Role::Mix;

    fn build(arguments: &Arguments) -> Result<Self, Fault> {
        let &[first, second] = arguments.materials("materials") else {
            return Err(Fault::new("materials", "a mix needs two materials"));
        };
        Ok(Self { materials: [first, second], amount: arguments.float("amount") })
    }

    fn is_textured(&self) -> bool {
        self.amount.is_textured()
    }

    fn scatterer<'a>(&'a self, _lookup: &mut Lookup<'_>, _seed: u64) -> Option<Bsdf<'a>> {
        None
    }
}

/// The boundary of a medium: light passes straight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InterfaceMaterial;

impl Declared for InterfaceMaterial {
    const CLASS: &'static str = "interface";
    const PARAMETERS: &'static [Parameter] = &[];
    const ROLE: Role = Role::Interface;

    fn build(_arguments: &Arguments) -> Result<Self, Fault> {
        Ok(Self)
    }

    fn is_textured(&self) -> bool {
        false
    }

    fn scatterer<'a>(&'a self, _lookup: &mut Lookup<'_>, _seed: u64) -> Option<Bsdf<'a>> {
        None
    }
}
