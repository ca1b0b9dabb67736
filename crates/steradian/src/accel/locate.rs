//! Where a ray meets a triangle, with AVX2: the roundings of [`Shear::locate`] with a lane for each corner.
#![cfg(target_arch = "x86_64")]

use super::tree::Packet;
use crate::shape::PrimHit;
use crate::shape::watertight::{ROUNDING_OF_DEPTH, Shear, Side};
use std::arch::x86_64::*;

/// [`Shear::locate`] for a lane of `packet`, of which it has the bits.
#[inline]
#[target_feature(enable = "avx2,fma")]
pub(super) fn locate(packet: &Packet, lane: usize, shear: &Shear, side: Side, t_max: f32) -> Option<PrimHit> {
    let coordinates = |axis: usize| {
        let corner = |k: usize| packet.corners[k][shear.axes[axis]][lane];
        let relative = _mm_setr_ps(corner(0), corner(1), corner(2), corner(0));
        _mm256_sub_pd(_mm256_cvtps_pd(relative), _mm256_set1_pd(f64::from(shear.origin[axis])))
    };
    let (x, y, z) = (coordinates(0), coordinates(1), coordinates(2));
    let [dx, dy, dz] = shear.d.map(f64::from);
    let along = |p: __m256d, d: f64| {
        _mm256_sub_pd(_mm256_mul_pd(p, _mm256_set1_pd(dz)), _mm256_mul_pd(_mm256_set1_pd(d), z))
    };
    let (px, py) = (along(x, dx), along(y, dy));
    let before = |p: __m256d| _mm256_permute4x64_pd::<0b10_01_00_10>(p);
    let after = |p: __m256d| _mm256_permute4x64_pd::<0b01_00_10_01>(p);
    let areas = _mm256_sub_pd(_mm256_mul_pd(before(px), after(py)), _mm256_mul_pd(before(py), after(px)));
    let areas = _mm256_mul_pd(areas, _mm256_set1_pd(side.sign()));
    let depths = _mm256_mul_pd(areas, z);
    // Both sums in two lanes.
    let (even, odd) = (_mm256_unpacklo_pd(areas, depths), _mm256_unpackhi_pd(areas, depths));
    let sums = _mm_add_pd(_mm256_castpd256_pd128(even), _mm256_castpd256_pd128(odd));
    let sums = _mm_add_pd(sums, _mm256_extractf128_pd::<1>(even));
    let (sum, depth) = (_mm_cvtsd_f64(sums), _mm_cvtsd_f64(_mm_unpackhi_pd(sums, sums)));

    let magnitude = |p: __m256d| _mm256_andnot_pd(_mm256_set1_pd(-0.0), p);
    let size = _mm256_max_pd(_mm256_max_pd(magnitude(x), magnitude(y)), magnitude(z));
    let size = _mm_max_pd(_mm256_castpd256_pd128(size), _mm256_extractf128_pd::<1>(size));
    let size = _mm_cvtsd_f64(_mm_max_sd(size, _mm_unpackhi_pd(size, size)));
    let rounding = (size * size * size) * (dz * dz) * ROUNDING_OF_DEPTH;
    let inside = _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_GE_OQ>(areas, _mm256_setzero_pd())) == 0xf;
    if !(inside && sum > 0.0 && sum < f64::INFINITY && depth.abs() > rounding) {
        return with_care(packet, lane, shear, side, t_max);
    }
    let scale = 1.0 / (sum * dz);
    let t = (depth * scale) as f32;
    let inverse = scale * dz;
    let shares = _mm256_cvtpd_ps(_mm256_mul_pd(areas, _mm256_set1_pd(inverse)));
    let share = |lane: __m128| _mm_cvtss_f32(lane);
    let (u, v) = (share(_mm_shuffle_ps::<1>(shares, shares)), share(_mm_shuffle_ps::<2>(shares, shares)));
    (t > 0.0 && t <= t_max).then_some(PrimHit { t, u, v })
}

/// The rare case in which the short way is in doubt.
#[cold]
#[inline(never)]
fn with_care(packet: &Packet, lane: usize, shear: &Shear, side: Side, t_max: f32) -> Option<PrimHit> {
    shear.locate(&packet.permuted_triangle(lane, shear.axes), side, t_max)
}
