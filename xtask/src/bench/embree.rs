//! Embree 4, loaded at run time: the few entry points that the comparison needs.
#![expect(unsafe_code, reason = "the library is called through its C interface")]

use libloading::Library;
use std::ffi::{CString, c_char, c_int, c_void};
use std::mem::ManuallyDrop;
use std::path::Path;
use std::sync::atomic::{AtomicIsize, Ordering};

/// A device, scene, geometry or user pointer.
pub(crate) type Handle = *mut c_void;

/// Build quality with a binned surface area heuristic.
const MEDIUM: c_int = 1;
const TRIANGLES: c_int = 0;
const INDEX_BUFFER: c_int = 0;
const VERTEX_BUFFER: c_int = 1;
const UINT3: c_int = 0x5003;
const FLOAT3: c_int = 0x9003;

/// Whether rays may pass between triangles that share an edge; the values are Embree's flags of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Edges {
    /// They may, rarely.
    Fast = 0,
    /// They may not.
    Robust = 4,
}

/// The library.
#[derive(Debug)]
pub(crate) struct Embree {
    /// Never unloaded: threads of its own may outlive the devices.
    library: ManuallyDrop<Library>,
}

/// Bytes that a device holds, now and at most.
#[derive(Debug, Default)]
struct Memory {
    now: AtomicIsize,
    peak: AtomicIsize,
}

/// A device with one scene of one mesh.
#[derive(Debug)]
pub(crate) struct Scene<'a> {
    embree: &'a Embree,
    device: Handle,
    scene: Handle,
    memory: Box<Memory>,
}

impl Embree {
    /// Loads the library at `path`.
    pub(crate) fn open(path: &Path) -> Result<Self, String> {
        // SAFETY: the initialisers of Embree and of its task library have no preconditions.
        let library = unsafe { Library::new(path) }.map_err(|e| format!("{}: {e}", path.display()))?;
        Ok(Self { library: ManuallyDrop::new(library) })
    }

    /// An entry point. `T` must be its type.
    pub(crate) fn entry<T: Copy>(&self, name: &str) -> Result<T, String> {
        // SAFETY: the callers write the types of Embree 4's header; the library stays loaded.
        unsafe { self.library.get::<T>(name.as_bytes()) }.map(|f| *f).map_err(|e| format!("{name}: {e}"))
    }

    /// A scene of one mesh, given but not yet built; builds and queries use at most `threads`.
    pub(crate) fn scene(
        &self,
        positions: &[[f32; 3]],
        indices: &[[u32; 3]],
        edges: Edges,
        threads: usize,
    ) -> Result<Scene<'_>, String> {
        type Monitor = unsafe extern "C" fn(Handle, isize, bool) -> bool;
        let new_device: unsafe extern "C" fn(*const c_char) -> Handle = self.entry("rtcNewDevice")?;
        let watch: unsafe extern "C" fn(Handle, Monitor, Handle) =
            self.entry("rtcSetDeviceMemoryMonitorFunction")?;
        let new_scene: unsafe extern "C" fn(Handle) -> Handle = self.entry("rtcNewScene")?;
        let set_quality: unsafe extern "C" fn(Handle, c_int) = self.entry("rtcSetSceneBuildQuality")?;
        let set_flags: unsafe extern "C" fn(Handle, c_int) = self.entry("rtcSetSceneFlags")?;
        let new_geometry: unsafe extern "C" fn(Handle, c_int) -> Handle = self.entry("rtcNewGeometry")?;
        let new_buffer: unsafe extern "C" fn(Handle, c_int, u32, c_int, usize, usize) -> Handle =
            self.entry("rtcSetNewGeometryBuffer")?;
        let commit: unsafe extern "C" fn(Handle) = self.entry("rtcCommitGeometry")?;
        let attach: unsafe extern "C" fn(Handle, Handle) -> u32 = self.entry("rtcAttachGeometry")?;
        let release: unsafe extern "C" fn(Handle) = self.entry("rtcReleaseGeometry")?;
        let settings = CString::new(format!("threads={threads}")).map_err(|e| e.to_string())?;
        // SAFETY: the string ends with zero and lives across the call.
        let device = unsafe { new_device(settings.as_ptr()) };
        if device.is_null() {
            return Err("Embree makes no device".to_owned());
        }
        let memory = Box::<Memory>::default();
        // SAFETY: the handles are the ones that Embree has just given; buffers are as large as was asked for, and
        // aligned for numbers of 32 bits; the box of the monitor outlives the device.
        unsafe {
            watch(device, monitor, (&raw const *memory).cast_mut().cast());
            let scene = new_scene(device);
            set_quality(scene, MEDIUM);
            set_flags(scene, edges as c_int);
            let geometry = new_geometry(device, TRIANGLES);
            let vertices = new_buffer(geometry, VERTEX_BUFFER, 0, FLOAT3, 12, positions.len());
            let faces = new_buffer(geometry, INDEX_BUFFER, 0, UINT3, 12, indices.len());
            let made = Scene { embree: self, device, scene, memory };
            if vertices.is_null() || faces.is_null() {
                return Err("Embree has no memory for the mesh".to_owned());
            }
            positions.as_ptr().copy_to_nonoverlapping(vertices.cast(), positions.len());
            indices.as_ptr().copy_to_nonoverlapping(faces.cast(), indices.len());
            commit(geometry);
            attach(scene, geometry);
            release(geometry);
            Ok(made)
        }
    }
}

impl Scene<'_> {
    /// Builds the hierarchy.
    pub(crate) fn commit(&self) -> Result<(), String> {
        let commit: unsafe extern "C" fn(Handle) = self.embree.entry("rtcCommitScene")?;
        // SAFETY: the scene is alive until `self` is dropped.
        unsafe { commit(self.scene) };
        Ok(())
    }

    /// Bytes that Embree holds, the copies of vertices and indices included: now and at most so far.
    pub(crate) fn bytes(&self) -> [usize; 2] {
        [&self.memory.now, &self.memory.peak].map(|m| m.load(Ordering::Relaxed).unsigned_abs())
    }

    /// The scene, for queries.
    pub(crate) fn handle(&self) -> Handle {
        self.scene
    }
}

impl Drop for Scene<'_> {
    fn drop(&mut self) {
        type Release = unsafe extern "C" fn(Handle);
        let entries = (self.embree.entry("rtcReleaseScene"), self.embree.entry("rtcReleaseDevice"));
        if let (Ok::<Release, _>(scene), Ok::<Release, _>(device)) = entries {
            // SAFETY: both are alive, and nothing refers to them after this.
            unsafe {
                scene(self.scene);
                device(self.device);
            }
        }
    }
}

/// Counts what the device takes and gives back.
unsafe extern "C" fn monitor(memory: Handle, bytes: isize, _post: bool) -> bool {
    // SAFETY: the pointer is the one given with this function, to a box that outlives the device.
    let memory = unsafe { &*memory.cast::<Memory>() };
    let now = memory.now.fetch_add(bytes, Ordering::Relaxed) + bytes;
    memory.peak.fetch_max(now, Ordering::Relaxed);
    true
}
