//! The two tests of the inner loop, over eight boxes and over four triangles, in portable code and in AVX2.
//!
//! Both kernels decide alike: the box test is conservative and only prunes, and the triangle test performs the same
//! roundings in the same order, unfused, in both.

use super::tree::{LANES, Node, Packet, WIDTH};
use crate::math::{Ray, float};
use crate::shape::watertight::Shear;

/// A ray prepared for box tests.
#[derive(Clone, Copy, Debug)]
pub(super) struct BoxRay {
    origin: [f32; 3],
    /// 1/d per axis; ±∞ where d is ±0.
    inverse: [f32; 3],
    /// Rows of [`Node::bounds`] in which the ray enters, per axis; it leaves in the neighbouring row.
    enter: [usize; 3],
}

impl BoxRay {
    #[inline(always)]
    pub(super) fn new(ray: &Ray) -> Self {
        let negative = |axis: usize| usize::from(ray.d[axis].is_sign_negative());
        Self {
            origin: ray.o.0.to_array(),
            inverse: [1.0 / ray.d.x, 1.0 / ray.d.y, 1.0 / ray.d.z],
            enter: [negative(0), 2 + negative(1), 4 + negative(2)],
        }
    }
}

/// Factor on the exit distance that outweighs the rounding of both distances (Ize 2013) and of the shear of the
/// triangle test, so that a box never hides a triangle that the ray passes.
const EXIT_SLACK: f32 = 1.0 + 2.0 * float::gamma(6);

/// Distances at which the ray enters the children, valid where the mask of [`Kernel::boxes`] is set.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct Entries(pub(super) [f32; WIDTH]);

pub(super) trait Kernel: Copy {
    /// Which children's boxes the ray meets in [0, `t_max`] (bit per child), and where it enters them.
    ///
    /// Where a plane distance is 0·∞ = NaN (the ray runs in the plane of a face) the plane is ignored.
    fn boxes(self, node: &Node, ray: &BoxRay, t_max: f32, entries: &mut Entries) -> u32;

    /// Which triangles the ray may meet in (0, `t_max`] (bit per lane): a superset of those that
    /// [`Shear::intersect`] accepts.
    fn triangles(self, packet: &Packet, shear: &Shear, t_max: f32) -> u32;

    /// Starts loading a node that will be needed soon.
    fn prefetch(self, node: &Node);
}

/// The kernel that this processor runs, found once when the structure is built.
#[derive(Clone, Copy, Debug)]
pub(super) enum KernelChoice {
    Portable,
    #[cfg(target_arch = "x86_64")]
    Avx2(avx2::Avx2),
}

impl KernelChoice {
    pub(super) fn detect() -> Self {
        #[cfg(target_arch = "x86_64")]
        if let Some(k) = avx2::Avx2::detect() {
            return Self::Avx2(k);
        }
        Self::Portable
    }
}

/// Plain arrays, which compilers turn into whatever vectors the target has.
#[derive(Clone, Copy, Debug)]
pub(super) struct Portable;

impl Kernel for Portable {
    #[inline(always)]
    fn boxes(self, node: &Node, ray: &BoxRay, t_max: f32, entries: &mut Entries) -> u32 {
        let mut enter = [0.0_f32; WIDTH];
        let mut exit = [t_max; WIDTH];
        for axis in 0..3 {
            let (o, inverse) = (ray.origin[axis], ray.inverse[axis]);
            let (near, far) = (&node.bounds[ray.enter[axis]], &node.bounds[ray.enter[axis] ^ 1]);
            for i in 0..WIDTH {
                // Comparisons instead of max and min: a NaN must leave the interval as it is.
                let (t0, t1) = ((near[i] - o) * inverse, (far[i] - o) * inverse);
                enter[i] = if t0 > enter[i] { t0 } else { enter[i] };
                exit[i] = if t1 < exit[i] { t1 } else { exit[i] };
            }
        }
        let mut mask = 0;
        for i in 0..WIDTH {
            mask |= u32::from(enter[i] <= exit[i] * EXIT_SLACK) << i;
        }
        entries.0 = enter;
        mask
    }

    #[inline(always)]
    fn triangles(self, packet: &Packet, shear: &Shear, t_max: f32) -> u32 {
        let [ax, ay, az] = shear.axes;
        let [sx, sy] = shear.factors;
        let [ox, oy, oz] = shear.origin;
        let project = |k: usize| {
            let c = &packet.corners[k];
            let z: [f32; LANES] = std::array::from_fn(|i| c[az][i] - oz);
            let x: [f32; LANES] = std::array::from_fn(|i| (c[ax][i] - ox) + sx * z[i]);
            let y: [f32; LANES] = std::array::from_fn(|i| (c[ay][i] - oy) + sy * z[i]);
            (x, y, z)
        };
        let (a, b, c) = (project(0), project(1), project(2));
        type Projected = ([f32; LANES], [f32; LANES], [f32; LANES]);
        let edge = |p: &Projected, q: &Projected, i: usize| p.0[i] * q.1[i] - p.1[i] * q.0[i];
        let limit = t_max * EXIT_SLACK;
        let mut mask = 0;
        for i in 0..LANES {
            let (u, v, w) = (edge(&c, &b, i), edge(&a, &c, i), edge(&b, &a, i));
            let negative = u < 0.0 || v < 0.0 || w < 0.0;
            let positive = u > 0.0 || v > 0.0 || w > 0.0;
            let t = [a.2[i], b.2[i], c.2[i]].map(|z| z * shear.inverse_z);
            let behind = t.iter().all(|&t| t < 0.0);
            let beyond = t.iter().all(|&t| t > limit);
            mask |= u32::from(!((negative && positive) || behind || beyond)) << i;
        }
        mask
    }

    #[inline(always)]
    fn prefetch(self, _node: &Node) {}
}

#[cfg(target_arch = "x86_64")]
pub(super) mod avx2 {
    //! The same tests with AVX2 intrinsics.
    #![expect(unsafe_code, reason = "SIMD intrinsics need it")]

    use super::{BoxRay, EXIT_SLACK, Entries, Kernel, Node, Packet, Shear};
    use std::arch::x86_64::*;

    /// Proof that the processor has AVX2.
    #[derive(Clone, Copy, Debug)]
    pub(in super::super) struct Avx2(());

    impl Avx2 {
        /// The kernel, if this processor can run it.
        pub(in super::super) fn detect() -> Option<Self> {
            is_x86_feature_detected!("avx2").then_some(Self(()))
        }
    }

    impl Kernel for Avx2 {
        #[inline(always)]
        fn boxes(self, node: &Node, ray: &BoxRay, t_max: f32, entries: &mut Entries) -> u32 {
            // SAFETY: a value of this type exists only where AVX2 was detected.
            unsafe { boxes(node, ray, t_max, entries) }
        }

        #[inline(always)]
        fn triangles(self, packet: &Packet, shear: &Shear, t_max: f32) -> u32 {
            // SAFETY: a value of this type exists only where AVX2 was detected.
            unsafe { triangles(packet, shear, t_max) }
        }

        #[inline(always)]
        fn prefetch(self, node: &Node) {
            let p = std::ptr::from_ref(node).cast::<i8>();
            // SAFETY: prefetching has no effect on memory; every address is inside or just behind the node.
            unsafe {
                _mm_prefetch::<_MM_HINT_T0>(p);
                _mm_prefetch::<_MM_HINT_T0>(p.wrapping_add(64));
                _mm_prefetch::<_MM_HINT_T0>(p.wrapping_add(128));
                _mm_prefetch::<_MM_HINT_T0>(p.wrapping_add(192));
            }
        }
    }

    #[inline]
    #[target_feature(enable = "avx2")]
    fn boxes(node: &Node, ray: &BoxRay, t_max: f32, entries: &mut Entries) -> u32 {
        let distance = |row: usize, axis: usize| {
            // SAFETY: rows are 32-byte aligned arrays of eight f32.
            let plane = unsafe { _mm256_load_ps(node.bounds[row].as_ptr()) };
            let from_origin = _mm256_sub_ps(plane, _mm256_set1_ps(ray.origin[axis]));
            _mm256_mul_ps(from_origin, _mm256_set1_ps(ray.inverse[axis]))
        };
        let (mut enter, mut exit) = (_mm256_setzero_ps(), _mm256_set1_ps(t_max));
        for axis in 0..3 {
            let near = ray.enter[axis];
            // max and min return their second operand when the first is NaN.
            enter = _mm256_max_ps(distance(near, axis), enter);
            exit = _mm256_min_ps(distance(near ^ 1, axis), exit);
        }
        let exit = _mm256_mul_ps(exit, _mm256_set1_ps(EXIT_SLACK));
        let mask = _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(enter, exit)) as u32;
        // SAFETY: the array is 32-byte aligned and holds eight f32.
        unsafe { _mm256_store_ps(entries.0.as_mut_ptr(), enter) };
        mask
    }

    #[inline]
    #[target_feature(enable = "avx2")]
    fn triangles(packet: &Packet, shear: &Shear, t_max: f32) -> u32 {
        let [ax, ay, az] = shear.axes;
        let (sx, sy) = (_mm_set1_ps(shear.factors[0]), _mm_set1_ps(shear.factors[1]));
        let [ox, oy, oz] = shear.origin;
        let (ox, oy, oz) = (_mm_set1_ps(ox), _mm_set1_ps(oy), _mm_set1_ps(oz));
        let project = |k: usize| {
            // SAFETY: each coordinate is a 16-byte aligned array of four f32.
            let load = |axis: usize| unsafe { _mm_load_ps(packet.corners[k][axis].as_ptr()) };
            let z = _mm_sub_ps(load(az), oz);
            let x = _mm_add_ps(_mm_sub_ps(load(ax), ox), _mm_mul_ps(sx, z));
            let y = _mm_add_ps(_mm_sub_ps(load(ay), oy), _mm_mul_ps(sy, z));
            (x, y, _mm_mul_ps(z, _mm_set1_ps(shear.inverse_z)))
        };
        let (a, b, c) = (project(0), project(1), project(2));
        let edge = |p: (__m128, __m128, __m128), q: (__m128, __m128, __m128)| {
            _mm_sub_ps(_mm_mul_ps(p.0, q.1), _mm_mul_ps(p.1, q.0))
        };
        let (u, v, w) = (edge(c, b), edge(a, c), edge(b, a));
        let zero = _mm_setzero_ps();
        // A NaN (overflow) counts as neither sign and leaves the decision to the exact test.
        let negative =
            _mm_or_ps(_mm_or_ps(_mm_cmplt_ps(u, zero), _mm_cmplt_ps(v, zero)), _mm_cmplt_ps(w, zero));
        let positive =
            _mm_or_ps(_mm_or_ps(_mm_cmpgt_ps(u, zero), _mm_cmpgt_ps(v, zero)), _mm_cmpgt_ps(w, zero));
        let missed = _mm_and_ps(negative, positive);
        let nearest = _mm_min_ps(_mm_min_ps(a.2, b.2), c.2);
        let farthest = _mm_max_ps(_mm_max_ps(a.2, b.2), c.2);
        let behind = _mm_cmplt_ps(farthest, zero);
        let beyond = _mm_cmpgt_ps(nearest, _mm_set1_ps(t_max * EXIT_SLACK));
        !(_mm_movemask_ps(_mm_or_ps(missed, _mm_or_ps(behind, beyond))) as u32) & 0xf
    }
}
