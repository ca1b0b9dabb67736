//! The two tests of the inner loop, over eight boxes and over four triangles, in portable code and in AVX2.
//!
//! Both kernels decide alike: the box test is conservative and only prunes, and the triangle test performs the same
//! roundings in the same order, unfused, in both.

#[cfg(target_arch = "x86_64")]
use super::locate;
use super::tree::{Child, LANES, Node, Packet, Tree, WIDTH};
use crate::math::{Bounds3, Ray, Vec3, float};
use crate::shape::PrimHit;
use crate::shape::watertight::{self, Shear, Side};

/// A ray prepared for box tests by differences: (plane − o)/d.
#[derive(Clone, Copy, Debug)]
pub(super) struct BoxRay {
    origin: [f32; 3],
    /// 1/d per axis; ±∞ where d counts as zero.
    inverse: [f32; 3],
    /// Rows of [`Node::bounds`] in which the ray enters, per axis; it leaves in the neighbouring row.
    enter: [usize; 3],
}

/// Factor on the exit distance that outweighs the rounding of both distances (Ize 2013) and of the shear of the
/// triangle test, so that a box never hides a triangle that the ray passes.
pub(super) const EXIT_SLACK: f32 = 1.0 + 2.0 * float::gamma(8);

/// Distances at which the ray enters the children, valid where the mask of [`Kernel::boxes`] is set.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct Entries(pub(super) [f32; WIDTH]);

/// What the test of a packet found, a bit per lane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lanes {
    /// Which triangles the ray may meet.
    pub(super) met: u32,
    /// Of these, which edge functions are all positive, and so exactly.
    pub(super) positive: u32,
    /// Of these, which edge functions are all negative, and so exactly.
    pub(super) negative: u32,
    /// Of these, which are met for certain and by nobody's leave, as far as the kernel finds out.
    pub(super) certain: u32,
}

pub(super) trait Kernel: Copy {
    /// What box tests need of a ray.
    type BoxRay: Copy;

    /// Prepares a ray for a tree within `bounds`; `None` for one that this kernel cannot test: not finite, or, where
    /// the kernel says so, with numbers near the ends of the range of floats.
    fn prepare(self, ray: &Ray, bounds: &Bounds3) -> Option<(Self::BoxRay, Shear)>;

    /// Which children's boxes the ray meets in [0, `t_max`] (bit per child), and where it enters them.
    ///
    /// Where a plane distance is 0·∞ = NaN (the ray runs in the plane of a face) the plane is ignored. Vacant
    /// children are never met.
    fn boxes(self, node: &Node, ray: &Self::BoxRay, t_max: f32, entries: &mut Entries) -> u32;

    /// Which triangles the ray may meet in (0, `t_max`]: a superset of those that [`Shear::intersect`] accepts.
    fn triangles(self, packet: &Packet, shear: &Shear, t_max: f32) -> Lanes;

    /// Where the ray meets the triangle in a lane of `packet`, from a side that is decided: [`Shear::locate`].
    fn locate(self, packet: &Packet, lane: usize, shear: &Shear, side: Side, t_max: f32) -> Option<PrimHit>;

    /// Starts loading a node or the first packet of a leaf that will be needed soon.
    fn prefetch(self, tree: &Tree, child: Child);
}

/// Bound on the rounding of [`Kernel::triangles`]'s U + V + W, per product of the largest |sheared x or y| and its sum with
/// the largest |z|: of each sheared coordinate 8 ε of that sum, of each edge function 4·8 and 3·2 of the product, 114 for
/// three of them, and 2 for their sum. Times the largest |z| it bounds the rounding of Σ U z, too: 114, 4 for each product,
/// and 12 for their sum. Both are rounded up to 256, so that what lies beyond leaves no doubt to the exact test either.
const AREA_ERROR: f32 = 256.0 * float::MACHINE_EPSILON;

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
    type BoxRay = BoxRay;

    #[inline(always)]
    fn prepare(self, ray: &Ray, _bounds: &Bounds3) -> Option<(BoxRay, Shear)> {
        // A NaN passes every box, vacant ones included.
        let sound = ray.o.is_finite() && ray.d.is_finite() && ray.d != Vec3::ZERO;
        let negative = |axis: usize| usize::from(ray.d[axis].is_sign_negative());
        let shear = Shear::new(ray);
        let mut inverse = [1.0 / ray.d.x, 1.0 / ray.d.y, 1.0 / ray.d.z];
        for (axis, factor) in shear.axes.into_iter().zip(shear.factors) {
            if factor == 0.0 {
                inverse[axis] = f32::INFINITY.copysign(ray.d[axis]);
            }
        }
        let enter = [negative(0), 2 + negative(1), 4 + negative(2)];
        let box_ray = BoxRay { origin: ray.o.0.to_array(), inverse, enter };
        sound.then_some((box_ray, shear))
    }

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
    fn triangles(self, packet: &Packet, shear: &Shear, t_max: f32) -> Lanes {
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
        let mut lanes = Lanes { met: 0, positive: 0, negative: 0, certain: 0 };
        for i in 0..LANES {
            let (u, v, w) = (edge(&c, &b, i), edge(&a, &c, i), edge(&b, &a, i));
            let t = [a.2[i], b.2[i], c.2[i]].map(|z| z * shear.inverse_z);
            let behind = t.iter().all(|&t| t < 0.0);
            let beyond = t.iter().all(|&t| t > limit);
            let (least, most) = (u.min(v).min(w), u.max(v).max(w));
            lanes.met |= u32::from(!((least < 0.0 && most > 0.0) || behind || beyond)) << i;
            lanes.positive |= u32::from(u > 0.0 && v > 0.0 && w > 0.0) << i;
            lanes.negative |= u32::from(u < 0.0 && v < 0.0 && w < 0.0) << i;
        }
        lanes
    }

    #[inline(always)]
    fn locate(self, packet: &Packet, lane: usize, shear: &Shear, side: Side, t_max: f32) -> Option<PrimHit> {
        shear.locate(&packet.permuted_triangle(lane, shear.axes), side, t_max)
    }

    #[inline(always)]
    fn prefetch(self, _tree: &Tree, _child: Child) {}
}

#[cfg(target_arch = "x86_64")]
pub(super) mod avx2 {
    //! The same tests with AVX2 intrinsics.
    #![expect(unsafe_code, reason = "SIMD intrinsics need it")]
    #![expect(
        unsafe_op_in_unsafe_fn,
        reason = "what is inlined always cannot name its instruction set: every call is an intrinsic of AVX2 or FMA"
    )]

    use super::{
        AREA_ERROR, Bounds3, Child, EXIT_SLACK, Entries, Kernel, Lanes, Node, Packet, PrimHit, Ray, Shear,
        Side, Tree, float, locate, watertight,
    };
    use std::arch::x86_64::*;

    /// Proof that the processor has AVX2 and FMA.
    #[derive(Clone, Copy, Debug)]
    pub(in super::super) struct Avx2(());

    impl Avx2 {
        /// The kernel, if this processor can run it.
        pub(in super::super) fn detect() -> Option<Self> {
            (is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma")).then_some(Self(()))
        }
    }

    /// A ray prepared for box tests by one fused operation a plane: plane·(1/d) − o/d.
    ///
    /// The rounding of o/d is an absolute error, so that it is subtracted once rounded up and once rounded down.
    #[derive(Clone, Copy, Debug)]
    pub(in super::super) struct FusedRay {
        inverse: [__m256; 3],
        /// o/d, not below the exact value.
        above: [__m256; 3],
        /// o/d, not above the exact value.
        below: [__m256; 3],
        /// Offsets in bytes of the rows of [`Node::bounds`] in which the ray enters; it leaves in the neighbours.
        enter: [usize; 3],
    }

    /// Bytes of a row of [`Node::bounds`].
    const ROW: usize = 32;

    /// Components of the direction below this part of the largest count as zero; more than in the shear, as that is
    /// rounded.
    const STILL: f32 = 2.0 * watertight::STILL;
    /// Components below this count as zero, too: their inverses would be near the end of the range of floats.
    const LEAST: f32 = 1e-19;
    const MAX_OFFSET: f32 = 1e37;
    /// Bound on the rounding of o·(1/d) and of what is added to it.
    const ROUNDING: f32 = 4.0 * float::MACHINE_EPSILON;

    /// Lets the ray stand still along axes on which it hardly moves: within all of the tree it passes less than
    /// `reach`·|d|, for which the slabs of that axis are widened. The numbers are 1/d, o/d, and the margin of o/d.
    #[cold]
    #[inline(never)]
    fn flatten(ray: &Ray, bounds: &Bounds3, numbers: &mut [[f32; 4]; 3]) {
        let size = ray.d.abs().max_element();
        let least = LEAST.max(STILL * size);
        let corner = bounds.min.abs().max(bounds.max.abs());
        let reach = 4.0 * (corner + ray.o.abs()).element_sum() / size;
        let [inverses, offsets, margins] = numbers;
        for (k, ((inverse, offset), margin)) in inverses.iter_mut().zip(offsets).zip(margins).enumerate() {
            let (o, d) = (ray.o[k % 3], ray.d[k % 3]);
            if !(d.abs() >= least) {
                *inverse = (1.0 / least).copysign(d);
                *offset = o * *inverse;
                *margin = offset.abs() * ROUNDING + reach;
            }
        }
    }

    impl Kernel for Avx2 {
        type BoxRay = FusedRay;

        #[inline(always)]
        fn prepare(self, ray: &Ray, bounds: &Bounds3) -> Option<(FusedRay, Shear)> {
            // SAFETY: a value of this type exists only where AVX2 and FMA were detected.
            unsafe { prepare(ray, bounds) }
        }

        #[inline(always)]
        fn boxes(self, node: &Node, ray: &FusedRay, t_max: f32, entries: &mut Entries) -> u32 {
            // SAFETY: a value of this type exists only where AVX2 and FMA were detected.
            unsafe { boxes(node, ray, t_max, entries) }
        }

        #[inline(always)]
        fn triangles(self, packet: &Packet, shear: &Shear, t_max: f32) -> Lanes {
            // SAFETY: a value of this type exists only where AVX2 was detected.
            unsafe { triangles(packet, shear, t_max) }
        }

        #[inline(always)]
        fn locate(
            self,
            packet: &Packet,
            lane: usize,
            shear: &Shear,
            side: Side,
            t_max: f32,
        ) -> Option<PrimHit> {
            // SAFETY: a value of this type exists only where AVX2 and FMA were detected.
            unsafe { locate::locate(packet, lane, shear, side, t_max) }
        }

        #[inline(always)]
        fn prefetch(self, tree: &Tree, child: Child) {
            let p = child.address(tree);
            // SAFETY: prefetching has no effect on memory, whatever the address.
            unsafe {
                _mm_prefetch::<_MM_HINT_T0>(p);
                _mm_prefetch::<_MM_HINT_T0>(p.wrapping_add(64));
                _mm_prefetch::<_MM_HINT_T0>(p.wrapping_add(128));
                _mm_prefetch::<_MM_HINT_T0>(p.wrapping_add(192));
            }
        }
    }

    /// All in vectors: numbers that pass through memory in pieces and come back as vectors stall every ray.
    #[inline(always)]
    unsafe fn prepare(ray: &Ray, bounds: &Bounds3) -> Option<(FusedRay, Shear)> {
        let sign = _mm_set1_ps(-0.0);
        // The fourth lane repeats the first, so that it never decides.
        let d = _mm_set_ps(ray.d.x, ray.d.z, ray.d.y, ray.d.x);
        let o = _mm_set_ps(ray.o.x, ray.o.z, ray.o.y, ray.o.x);
        let length = _mm_andnot_ps(sign, d);
        let size = _mm_max_ps(length, _mm_shuffle_ps::<0b00_00_10_01>(length, length));
        let size = _mm_max_ps(size, _mm_shuffle_ps::<0b01_00_01_10>(length, length));
        let size = _mm_shuffle_ps::<0>(size, size);
        let mut inverse = _mm_div_ps(_mm_set1_ps(1.0), d);
        let mut offset = _mm_mul_ps(o, inverse);
        let rounding = _mm_mul_ps(_mm_andnot_ps(sign, offset), _mm_set1_ps(ROUNDING));
        let mut margin = _mm_add_ps(rounding, _mm_set1_ps(f32::MIN_POSITIVE));
        let least = _mm_max_ps(_mm_set1_ps(LEAST), _mm_mul_ps(size, _mm_set1_ps(STILL)));
        let z = (_mm_movemask_ps(_mm_cmpeq_ps(length, size)) as u32).trailing_zeros() as usize;
        let z = z.min(2);
        let mut inverses = [0.0_f32; 4];
        // SAFETY: the array holds four f32.
        unsafe { _mm_storeu_ps(inverses.as_mut_ptr(), inverse) };
        let inverse_z = inverses[z];
        if _mm_movemask_ps(_mm_cmpge_ps(length, least)) != 0xf {
            let mut numbers = [[0.0; 4]; 3];
            // SAFETY: each row holds four f32.
            unsafe {
                _mm_storeu_ps(numbers[0].as_mut_ptr(), inverse);
                _mm_storeu_ps(numbers[1].as_mut_ptr(), offset);
                _mm_storeu_ps(numbers[2].as_mut_ptr(), margin);
            }
            flatten(ray, bounds, &mut numbers);
            // SAFETY: as above.
            unsafe {
                inverse = _mm_loadu_ps(numbers[0].as_ptr());
                offset = _mm_loadu_ps(numbers[1].as_ptr());
                margin = _mm_loadu_ps(numbers[2].as_ptr());
            }
        }
        let largest = _mm_add_ps(_mm_andnot_ps(sign, offset), margin);
        // Comparisons that NaN fails.
        let tame = _mm_and_ps(
            _mm_cmplt_ps(largest, _mm_set1_ps(MAX_OFFSET)),
            _mm_cmplt_ps(length, _mm_set1_ps(f32::INFINITY)),
        );
        if _mm_movemask_ps(tame) != 0xf {
            return None;
        }
        let axes = |v: __m128| {
            [
                _mm256_broadcastss_ps(v),
                _mm256_broadcastss_ps(_mm_shuffle_ps::<1>(v, v)),
                _mm256_broadcastss_ps(_mm_shuffle_ps::<2>(v, v)),
            ]
        };
        let negative = _mm_movemask_ps(d) as usize;
        let fused = FusedRay {
            inverse: axes(inverse),
            above: axes(_mm_add_ps(offset, margin)),
            below: axes(_mm_sub_ps(offset, margin)),
            enter: [
                (negative & 1) * ROW,
                2 * ROW + (negative >> 1 & 1) * ROW,
                4 * ROW + (negative >> 2 & 1) * ROW,
            ],
        };
        Some((fused, Shear::along(ray, z, inverse_z)))
    }

    #[inline(always)]
    unsafe fn boxes(node: &Node, ray: &FusedRay, t_max: f32, entries: &mut Entries) -> u32 {
        let rows = std::ptr::from_ref(&node.bounds).cast::<u8>();
        let distance = |row: usize, axis: usize, offset: __m256| {
            // SAFETY: `entered_rows` gives offsets of rows, which are 32-byte aligned arrays of eight f32.
            let plane = unsafe { _mm256_load_ps(rows.add(row).cast()) };
            _mm256_fmsub_ps(plane, ray.inverse[axis], offset)
        };
        let near = |axis: usize| distance(ray.enter[axis], axis, ray.above[axis]);
        let far = |axis: usize| distance(ray.enter[axis] ^ ROW, axis, ray.below[axis]);
        let enter =
            _mm256_max_ps(_mm256_max_ps(near(0), near(1)), _mm256_max_ps(near(2), _mm256_setzero_ps()));
        let exit = _mm256_min_ps(_mm256_min_ps(far(0), far(1)), _mm256_min_ps(far(2), _mm256_set1_ps(t_max)));
        let exit = _mm256_mul_ps(exit, _mm256_set1_ps(EXIT_SLACK));
        let mask = _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(enter, exit)) as u32;
        // SAFETY: the array is 32-byte aligned and holds eight f32.
        unsafe { _mm256_store_ps(entries.0.as_mut_ptr(), enter) };
        mask
    }

    #[inline(always)]
    unsafe fn triangles(packet: &Packet, shear: &Shear, t_max: f32) -> Lanes {
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
            (x, y, z)
        };
        let (a, b, c) = (project(0), project(1), project(2));
        let edge = |p: (__m128, __m128, __m128), q: (__m128, __m128, __m128)| {
            _mm_sub_ps(_mm_mul_ps(p.0, q.1), _mm_mul_ps(p.1, q.0))
        };
        let (u, v, w) = (edge(c, b), edge(a, c), edge(b, a));
        let zero = _mm_setzero_ps();
        // min and max return their second operand when one is NaN (overflow), so that all of them but that are seen here: two
        // of opposite signs are a miss whatever the third is. Otherwise such a lane is neither all positive nor all
        // negative, and the exact test decides.
        let (least, most) = (_mm_min_ps(_mm_min_ps(u, v), w), _mm_max_ps(_mm_max_ps(u, v), w));
        let missed = _mm_and_ps(_mm_cmplt_ps(least, zero), _mm_cmpgt_ps(most, zero));
        let passed = !(_mm_movemask_ps(missed) as u32) & 0xf;
        if passed == 0 {
            return Lanes { met: 0, positive: 0, negative: 0, certain: 0 };
        }
        let sign = _mm_set1_ps(-0.0);
        let size = |v: __m128| _mm_andnot_ps(sign, v);
        let largest = |a: __m128, b: __m128, c: __m128| _mm_max_ps(_mm_max_ps(size(a), size(b)), size(c));
        let across = _mm_max_ps(largest(a.0, b.0, c.0), largest(a.1, b.1, c.1));
        let along = largest(a.2, b.2, c.2);
        let least_positive = _mm_set1_ps(f32::MIN_POSITIVE);
        let error = _mm_mul_ps(_mm_mul_ps(across, _mm_add_ps(across, along)), _mm_set1_ps(AREA_ERROR));
        let error = _mm_add_ps(error, least_positive);
        let depth_error = _mm_add_ps(_mm_mul_ps(error, along), least_positive);
        let depth = _mm_add_ps(_mm_add_ps(_mm_mul_ps(u, a.2), _mm_mul_ps(v, b.2)), _mm_mul_ps(w, c.2));
        // Seen from the side from which the edge functions are positive and along +z; the axis z itself may run against
        // the ray.
        let inverse = _mm_set1_ps(shear.inverse_z);
        let negative = _mm_cmplt_ps(most, zero);
        let side = _mm_xor_ps(_mm_and_ps(negative, sign), _mm_and_ps(inverse, sign));
        let depth = _mm_xor_ps(depth, side);
        let one_sided = _mm_or_ps(negative, _mm_cmpgt_ps(least, zero));
        let behind = _mm_cmplt_ps(depth, _mm_sub_ps(zero, depth_error));
        // t lies between those of the corners, which is narrow for small triangles. For large ones it is depth / area:
        // compared without dividing, and with room for products that leave the range of floats.
        let (ta, tb, tc) = (_mm_mul_ps(a.2, inverse), _mm_mul_ps(b.2, inverse), _mm_mul_ps(c.2, inverse));
        let far = _mm_set1_ps(t_max * EXIT_SLACK);
        let area = size(_mm_add_ps(_mm_add_ps(u, v), w));
        let scale = size(inverse);
        let at_least = _mm_mul_ps(_mm_sub_ps(depth, depth_error), scale);
        let over_far = _mm_add_ps(_mm_mul_ps(_mm_add_ps(area, error), far), least_positive);
        let beyond = _mm_or_ps(
            _mm_cmpgt_ps(_mm_min_ps(_mm_min_ps(ta, tb), tc), far),
            _mm_and_ps(_mm_cmpgt_ps(at_least, over_far), _mm_cmplt_ps(at_least, _mm_set1_ps(f32::INFINITY))),
        );
        let out = _mm_and_ps(one_sided, _mm_or_ps(behind, beyond));
        let ordered = _mm_movemask_ps(_mm_cmpord_ps(_mm_add_ps(u, v), w)) as u32;
        let met = passed & !(_mm_movemask_ps(out) as u32);
        let at_most = _mm_add_ps(_mm_mul_ps(_mm_add_ps(depth, depth_error), scale), least_positive);
        let near = _mm_set1_ps(t_max * (1.0 / EXIT_SLACK));
        let before = _mm_or_ps(
            _mm_cmplt_ps(_mm_max_ps(_mm_max_ps(ta, tb), tc), near),
            _mm_cmplt_ps(at_most, _mm_mul_ps(_mm_sub_ps(area, error), near)),
        );
        // Seen from one side, depth ≤ area × along, so that the area is beyond doubt, too; and a NaN is in the depth as well.
        let seen = _mm_cmpgt_ps(depth, depth_error);
        let certain = _mm_movemask_ps(_mm_and_ps(_mm_and_ps(one_sided, before), seen)) as u32;
        // SAFETY: an owner is 32 bits whose highest says that its hits are filtered, as that of unused lanes does.
        let owners = unsafe { _mm_load_ps(packet.owners.as_ptr().cast()) };
        Lanes {
            met,
            positive: _mm_movemask_ps(_mm_cmpgt_ps(least, zero)) as u32 & ordered,
            negative: _mm_movemask_ps(negative) as u32 & ordered,
            certain: passed & certain & !(_mm_movemask_ps(owners) as u32),
        }
    }
}
