//! What the builder sorts: a box and whose it is, in 32 bytes.

use super::super::contract::InstanceId;
use super::super::tree::LANES;
use crate::math::{Bounds3, Point};
use crate::shape::ShapeId;
use glam::Vec4;

/// A box whose corners fill a register each; the fourth components mean nothing here.
#[derive(Clone, Copy, Debug)]
pub(super) struct Box4 {
    pub(super) lo: Vec4,
    pub(super) hi: Vec4,
}

impl Box4 {
    pub(super) const EMPTY: Self = Self { lo: Vec4::INFINITY, hi: Vec4::NEG_INFINITY };

    #[inline(always)]
    pub(super) fn union(self, other: Self) -> Self {
        Self { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }

    /// Half the surface area; infinite or NaN where it is beyond the range of floats, which loses every comparison.
    #[inline(always)]
    pub(super) fn half_area(self) -> f32 {
        let d = self.hi - self.lo;
        d.x * (d.y + d.z) + d.y * d.z
    }

    #[inline(always)]
    pub(super) fn around([a, b, c]: [Point; 3]) -> Self {
        let [a, b, c] = [a.extend(0.0), b.extend(0.0), c.extend(0.0)];
        Self { lo: a.min(b).min(c), hi: a.max(b).max(c) }
    }

    pub(super) fn from_bounds(b: &Bounds3) -> Self {
        Self { lo: b.min.extend(0.0), hi: b.max.extend(0.0) }
    }

    pub(super) fn bounds(self) -> Bounds3 {
        Bounds3 { min: Point(self.lo.truncate()), max: Point(self.hi.truncate()) }
    }
}

/// One thing that a tree is built over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Subject {
    Triangle {
        shape: ShapeId,
        prim: u32,
    },
    /// A part of a curve.
    Strand {
        shape: ShapeId,
        prim: u32,
    },
    Other {
        shape: ShapeId,
        prim: u32,
    },
    Instance(InstanceId),
}

/// A subject with its box. Its numbers lie in the fourth components, as bits of floats around two: they go through the
/// arithmetic of the box and must neither be NaN nor so small that processors slow down.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C, align(32))]
pub(super) struct Reference {
    pub(super) lo: Vec4,
    pub(super) hi: Vec4,
}

impl Reference {
    const NORMAL: u32 = 1 << 30;
    const OTHER: u32 = 1 << 29;
    const STRAND: u32 = 1 << 28;
    const INSTANCE: u32 = Self::STRAND - 1;
    /// Shapes that can be told apart.
    pub(super) const MAX_SHAPES: usize = Self::INSTANCE as usize;

    #[inline(always)]
    pub(super) fn new(b: Box4, subject: Subject) -> Self {
        let (first, second) = match subject {
            Subject::Triangle { shape, prim } => (shape.0, prim),
            Subject::Strand { shape, prim } => (Self::OTHER | Self::STRAND | shape.0, prim),
            Subject::Other { shape, prim } => (Self::OTHER | shape.0, prim),
            Subject::Instance(id) => (Self::OTHER | Self::INSTANCE, id.0),
        };
        let word = |bits: u32| f32::from_bits(Self::NORMAL | bits);
        // Adding zero makes −0 positive: the smaller of the two zeros would depend on the order of comparison.
        let (lo, hi) = (b.lo + Vec4::ZERO, b.hi + Vec4::ZERO);
        Self { lo: lo.with_w(word(first)), hi: hi.with_w(word(second)) }
    }

    pub(super) fn subject(&self) -> Subject {
        let word = |x: f32| x.to_bits() & !Self::NORMAL;
        let (first, second) = (word(self.lo.w), word(self.hi.w));
        let shape = ShapeId(first & !(Self::OTHER | Self::STRAND));
        match first & Self::OTHER != 0 {
            false => Subject::Triangle { shape, prim: second },
            true if self.is_strand() => Subject::Strand { shape, prim: second },
            true if shape.0 == Self::INSTANCE => Subject::Instance(InstanceId(second)),
            true => Subject::Other { shape, prim: second },
        }
    }

    /// Whether it is a part of a curve.
    #[inline(always)]
    pub(super) fn is_strand(&self) -> bool {
        self.lo.w.to_bits() & Self::STRAND != 0
    }

    #[inline(always)]
    pub(super) fn as_box(&self) -> Box4 {
        Box4 { lo: self.lo, hi: self.hi }
    }

    /// Twice the centre of the box; infinite where that is beyond the range of floats.
    #[inline(always)]
    pub(super) fn center(&self) -> Vec4 {
        self.lo + self.hi
    }

    /// What testing it costs, in triangles: anything else costs a packet of its own.
    #[inline(always)]
    pub(super) fn weight(&self) -> u32 {
        1 + (LANES as u32 - 1) * ((self.lo.w.to_bits() / Self::OTHER) & 1)
    }
}

/// Packets of triangles that weigh so much.
#[inline(always)]
pub(super) fn packets(weight: u32) -> u32 {
    weight.div_ceil(LANES as u32)
}

/// How far some references reach, and their centres, and what they weigh.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    pub(super) boxes: Box4,
    /// Of [`Reference::center`].
    pub(super) centers: Box4,
    pub(super) weight: u32,
}

impl Extent {
    pub(super) const EMPTY: Self = Self { boxes: Box4::EMPTY, centers: Box4::EMPTY, weight: 0 };

    #[inline]
    pub(super) fn of(references: &[Reference]) -> Self {
        let mut e = Self::EMPTY;
        for r in references {
            let c = r.center();
            e.boxes = e.boxes.union(r.as_box());
            e.centers = e.centers.union(Box4 { lo: c, hi: c });
            e.weight += r.weight();
        }
        e
    }

    pub(super) fn union(self, other: Self) -> Self {
        Self {
            boxes: self.boxes.union(other.boxes),
            centers: self.centers.union(other.centers),
            weight: self.weight + other.weight,
        }
    }
}
