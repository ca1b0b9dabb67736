//! Embree's answers, one ray at a time.
#![expect(unsafe_code, reason = "the library is called through its C interface")]

use super::super::embree::{Embree, Handle, Scene};
use super::world::Query;
use std::ffi::{c_char, c_int};

/// What Embree reads and writes for a ray.
#[repr(C, align(16))]
struct RayHit {
    origin: [f32; 3],
    near: f32,
    direction: [f32; 3],
    time: f32,
    far: f32,
    mask: u32,
    id: u32,
    flags: u32,
    normal: [f32; 3],
    uv: [f32; 2],
    primitive: u32,
    geometry: u32,
    instances: [u32; 8],
}

const NOTHING: u32 = u32::MAX;

impl RayHit {
    #[inline(always)]
    fn new(query: &Query) -> Self {
        Self {
            origin: query.ray.o.0.to_array(),
            near: 0.0,
            direction: query.ray.d.to_array(),
            time: 0.0,
            far: query.t_max,
            mask: u32::MAX,
            id: 0,
            flags: 0,
            normal: [0.0; 3],
            uv: [0.0; 2],
            primitive: NOTHING,
            geometry: NOTHING,
            instances: [NOTHING; 8],
        }
    }
}

/// Arguments of a query: two words and pointers, all of which may be zero; larger than what the library reads.
#[repr(C, align(16))]
struct Arguments {
    flags: u32,
    features: u32,
    rest: [usize; 14],
}

type Ask = unsafe extern "C" fn(Handle, *mut RayHit, *mut Arguments);

/// A built scene with its entry points.
pub(super) struct Peer {
    scene: Handle,
    nearest: Ask,
    any: Ask,
}

impl Peer {
    /// `scene` must stay alive and be committed.
    pub(super) fn new(embree: &Embree, scene: &Scene<'_>) -> Result<Self, String> {
        Self::of_handle(embree, scene.handle())
    }

    fn of_handle(embree: &Embree, scene: Handle) -> Result<Self, String> {
        Ok(Self { scene, nearest: embree.entry("rtcIntersect1")?, any: embree.entry("rtcOccluded1")? })
    }

    /// Flat cubic Bézier curves of one width, built; never released, as the process ends soon after.
    pub(super) fn of_curves(
        embree: &Embree,
        curves: &[[steradian::math::Vec3; 4]],
        width: f32,
    ) -> Result<Self, String> {
        const FLAT_BEZIER: c_int = 25;
        const VERTICES: c_int = 1;
        const INDICES: c_int = 0;
        const FLOAT4: c_int = 0x9004;
        const UINT: c_int = 0x5001;
        let new_device: unsafe extern "C" fn(*const c_char) -> Handle = embree.entry("rtcNewDevice")?;
        let new_scene: unsafe extern "C" fn(Handle) -> Handle = embree.entry("rtcNewScene")?;
        let new_geometry: unsafe extern "C" fn(Handle, c_int) -> Handle = embree.entry("rtcNewGeometry")?;
        let new_buffer: unsafe extern "C" fn(Handle, c_int, u32, c_int, usize, usize) -> Handle =
            embree.entry("rtcSetNewGeometryBuffer")?;
        let commit: unsafe extern "C" fn(Handle) = embree.entry("rtcCommitGeometry")?;
        let attach: unsafe extern "C" fn(Handle, Handle) -> u32 = embree.entry("rtcAttachGeometry")?;
        let commit_scene: unsafe extern "C" fn(Handle) = embree.entry("rtcCommitScene")?;
        let points: Vec<[f32; 4]> = curves.iter().flatten().map(|p| [p.x, p.y, p.z, 0.5 * width]).collect();
        let firsts: Vec<u32> = (0..curves.len() as u32).map(|k| 4 * k).collect();
        // SAFETY: the handles are those that Embree has just given, the buffers as large as was asked for.
        let scene = unsafe {
            let device = new_device(c"threads=1".as_ptr());
            let scene = new_scene(device);
            let geometry = new_geometry(device, FLAT_BEZIER);
            let vertices = new_buffer(geometry, VERTICES, 0, FLOAT4, 16, points.len());
            let indices = new_buffer(geometry, INDICES, 0, UINT, 4, firsts.len());
            if vertices.is_null() || indices.is_null() {
                return Err("Embree has no memory for the curves".to_owned());
            }
            points.as_ptr().copy_to_nonoverlapping(vertices.cast(), points.len());
            firsts.as_ptr().copy_to_nonoverlapping(indices.cast(), firsts.len());
            commit(geometry);
            attach(scene, geometry);
            commit_scene(scene);
            scene
        };
        Self::of_handle(embree, scene)
    }

    /// How many of the rays meet something.
    pub(super) fn nearest(&self, queries: &[Query]) -> usize {
        self.count(self.nearest, queries, |q| q.geometry != NOTHING)
    }

    /// How many of the rays are blocked.
    pub(super) fn any(&self, queries: &[Query]) -> usize {
        self.count(self.any, queries, |q| q.far < 0.0)
    }

    fn count(&self, ask: Ask, queries: &[Query], met: impl Fn(&RayHit) -> bool) -> usize {
        let mut arguments = Arguments { flags: 0, features: u32::MAX, rest: [0; 14] };
        let mut count = 0;
        for query in queries {
            let mut q = RayHit::new(query);
            // SAFETY: the scene is committed; both structures are laid out as in Embree 4's header.
            unsafe { ask(self.scene, &mut q, &mut arguments) };
            count += usize::from(met(&q));
        }
        count
    }
}
