//! What a stack is made of.

use crate::optics::TrowbridgeReitz;
use crate::spectrum::Spectrum;

/// Most layers of one stack.
pub const MAX_LAYERS: usize = 64;

/// One homogeneous layer.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Thickness [m], finite and not negative.
    pub thickness: f32,
    /// Index of refraction, over that of the outside.
    pub eta: Spectrum,
    /// Natural absorption coefficient a of B (2.21) [1/m].
    pub absorption: Spectrum,
}

/// Why layers are no stack.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum LayersError {
    /// There is nothing to scatter.
    #[error("a stack needs at least one layer")]
    Empty,
    /// Too deep.
    #[error("a stack has at most {MAX_LAYERS} layers, not {0}")]
    TooMany(usize),
    /// A length that is none.
    #[error("layer {layer} is {thickness} m thick: a thickness is finite and not negative")]
    Thickness {
        /// Which, from 1.
        layer: usize,
        /// Its thickness [m].
        thickness: f32,
    },
    /// A roughness for neither one nor all boundaries.
    #[error("a stack of {layers} layers takes one roughness, or {boundaries} of them, not {found}")]
    Roughness {
        /// Number of layers.
        layers: usize,
        /// Number of boundaries that may be rough.
        boundaries: usize,
        /// Number of values.
        found: usize,
    },
}

/// Layers from the top, with what bounds them: owned by a material, referred to by its scattering functions.
#[derive(Clone, Debug, PartialEq)]
pub struct Layers {
    layers: Vec<Layer>,
    boundaries: Vec<TrowbridgeReitz>,
    /// What a Lambertian base under smooth layers gets back of its emission, where it is the same at all wavelengths.
    pub(super) returned: Option<f32>,
}

/// Whether what lies below the last layer is a boundary that may be rough.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LastBoundary {
    /// A medium or a metal.
    Interface,
    /// A Lambertian base, whose own shape does not matter.
    Lambertian,
}

impl Layers {
    /// Layers from the top, with the microfacets of their boundaries: one for all, or one each from the top.
    ///
    /// # Errors
    /// When there are no or too many layers, when a thickness is none, or when the numbers do not fit each other.
    pub fn new(
        layers: Vec<Layer>,
        roughness: &[TrowbridgeReitz],
        last: LastBoundary,
    ) -> Result<Self, LayersError> {
        let n = layers.len();
        if n == 0 {
            return Err(LayersError::Empty);
        }
        if n > MAX_LAYERS {
            return Err(LayersError::TooMany(n));
        }
        for (i, &Layer { thickness, .. }) in layers.iter().enumerate() {
            if !(thickness >= 0.0 && thickness.is_finite()) {
                return Err(LayersError::Thickness { layer: i + 1, thickness });
            }
        }
        let count = n + usize::from(last == LastBoundary::Interface);
        let boundaries = match *roughness {
            [] => vec![TrowbridgeReitz::SMOOTH; count],
            [one] => vec![one; count],
            _ if roughness.len() == count => roughness.to_vec(),
            _ => {
                let found = roughness.len();
                return Err(LayersError::Roughness { layers: n, boundaries: count, found });
            }
        };
        Ok(Self { layers, boundaries, returned: None })
    }

    /// The layers from the top.
    pub fn layers(&self) -> &[Layer] {
        &self.layers
    }

    /// Whether the layers are the same at all wavelengths.
    pub(super) fn is_grey(&self) -> bool {
        let grey = |s: &Spectrum| s.constant_value().is_some();
        self.layers.iter().all(|l| grey(&l.eta) && grey(&l.absorption))
    }

    /// The microfacets of each boundary from the top.
    pub(super) fn boundaries(&self) -> &[TrowbridgeReitz] {
        &self.boundaries
    }

    /// Whether the uppermost boundary is at most as rough as the lowest.
    pub(super) fn top_is_smoother(&self) -> bool {
        let alpha = |d: Option<&TrowbridgeReitz>| d.map_or(0.0, |d| d.alpha()[0]);
        alpha(self.boundaries.first()) <= alpha(self.boundaries.last())
    }

    /// Whether every boundary is smooth.
    pub fn is_smooth(&self) -> bool {
        self.boundaries.iter().all(TrowbridgeReitz::is_smooth)
    }
}
