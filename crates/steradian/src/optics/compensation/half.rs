//! The two sides of an interface.

use crate::math::LocalDir;

/// The side of an interface that light comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Half {
    /// The side of the normal; the only one of a mirror.
    Above,
    /// The other side.
    Below,
}

impl Half {
    /// The half that a direction lies in.
    pub fn of(w: LocalDir) -> Self {
        if w.z < 0.0 { Self::Below } else { Self::Above }
    }

    /// The other half.
    #[must_use]
    pub fn opposite(self) -> Self {
        match self {
            Self::Above => Self::Below,
            Self::Below => Self::Above,
        }
    }
}
