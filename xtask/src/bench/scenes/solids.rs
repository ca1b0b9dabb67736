//! Bodies that the rooms are furnished with; all of them face outwards.

use super::mesh::Mesh;
use std::f32::consts::{PI, TAU};

impl Mesh {
    /// A box between two corners; texture coordinates grow by `per_length` of its edges.
    pub(super) fn block(&mut self, low: [f32; 3], high: [f32; 3], per_length: f32) {
        let [x, y, z] = std::array::from_fn(|i| high[i] - low[i]);
        // So that blocks do not repeat each other's texture.
        let uv = [(low[0] * 7.31 + low[1] * 3.17).rem_euclid(1.0), (low[2] * 5.93 + low[1]).rem_euclid(1.0)];
        let mut side = |corner, u, v| self.quad(corner, u, v, uv, per_length);
        side([low[0], high[1], high[2]], [x, 0.0, 0.0], [0.0, 0.0, -z]);
        side(low, [x, 0.0, 0.0], [0.0, 0.0, z]);
        side([low[0], low[1], high[2]], [x, 0.0, 0.0], [0.0, y, 0.0]);
        side([high[0], low[1], low[2]], [-x, 0.0, 0.0], [0.0, y, 0.0]);
        side([high[0], low[1], high[2]], [0.0, 0.0, -z], [0.0, y, 0.0]);
        side(low, [0.0, 0.0, z], [0.0, y, 0.0]);
    }

    /// A surface of revolution about the vertical through `base`, `nu` × `nv` cells: `profile` gives radius and height along
    /// it from below, `relief` what is added to the radius at (φ/2π, v).
    pub(super) fn turned(
        &mut self,
        base: [f32; 3],
        [nu, nv]: [u32; 2],
        profile: impl Fn(f32) -> [f32; 2],
        relief: impl Fn(f32, f32) -> f32,
    ) {
        let at = |u: f32, v: f32| {
            let [radius, height] = profile(v);
            let r = radius + relief(u, v) * radius.min(1.0);
            let (sin, cos) = (TAU * u).sin_cos();
            [base[0] + r * sin, base[1] + height, base[2] + r * cos]
        };
        self.sheet(nu, nv, at, [2.0, 1.0]);
    }

    /// A sphere as a mesh.
    pub(super) fn ball(&mut self, center: [f32; 3], radius: f32, [nu, nv]: [u32; 2]) {
        // Poles of a hair's width, so that no triangle lacks an area.
        let profile = |v: f32| {
            let theta = PI * (1.0 - v).clamp(1e-3, 1.0 - 1e-3);
            [radius * theta.sin(), radius * theta.cos()]
        };
        self.turned(center, [nu, nv], profile, |_, _| 0.0);
    }

    /// An upright cylinder, closed at its top.
    pub(super) fn post(&mut self, base: [f32; 3], radius: f32, height: f32) {
        let profile =
            |v: f32| if v < 0.9 { [radius, height * v / 0.9] } else { [radius * (1.0 - v) * 10.0, height] };
        self.turned(base, [24, 10], profile, |_, _| 0.0);
    }
}
