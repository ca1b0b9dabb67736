//! The light that a goniometer sends.

use super::super::probe::Angles;
use super::cells::CellGrid;
use crate::math::{LocalDir, Vec2, Vec3};

/// The side of the sample that light comes to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Face {
    /// The one that its normal, z, points to.
    #[default]
    Front,
    /// The other.
    Back,
}

impl Face {
    /// For people and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Front => "front",
            Self::Back => "back",
        }
    }

    /// The opposite one.
    pub(super) fn other(self) -> Self {
        match self {
            Self::Front => Self::Back,
            Self::Back => Self::Front,
        }
    }

    /// A direction of the front side, or its mirror image on the back.
    pub(super) fn turn(self, w: LocalDir) -> LocalDir {
        match self {
            Self::Front => w,
            Self::Back => LocalDir::new_unchecked(Vec3::new(w.x, w.y, -w.z)),
        }
    }
}

/// Where light comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Incidence {
    /// One direction, seen from the sample: θ below 90° to the normal of the side that it comes to.
    Direction(Angles),
    /// All directions of a cell of the instrument's grid, of even radiance.
    Cell(usize),
}

impl Incidence {
    /// Whether directions must be drawn.
    pub(super) fn is_spread(self) -> bool {
        matches!(self, Self::Cell(_))
    }

    /// The direction that light comes from; `u` chooses within a cell.
    pub(super) fn direction(self, grid: &CellGrid, face: Face, u: Vec2) -> LocalDir {
        face.turn(match self {
            Self::Direction(angles) => angles.direction(),
            Self::Cell(index) => grid.cell(index).direction(u),
        })
    }

    /// The direction, or the middle of the cell [degrees].
    pub fn angles(self, grid: &CellGrid) -> Angles {
        match self {
            Self::Direction(angles) => angles,
            Self::Cell(index) => {
                let [theta, phi] = grid.cell(index).centre();
                Angles { theta, phi }
            }
        }
    }
}
