//! Scenes of our own, made by rule, without third-party data, in our format and in Mitsuba 3's.
//!
//! What differs between the two renderings of one scene: Mitsuba multiplies two one-sided shadowing terms where we
//! correlate heights, its rough coat transmits by a table that ignores absorption, bitmaps are interpolated at their finest
//! level, and the environment is a bilinear latitude–longitude map where ours is an equal-area square. The means of the
//! pictures agree to about a percent.

mod description;
mod glass;
mod interior;
mod mesh;
mod mitsuba;
mod pbrt;
mod pictures;
mod plaza;
mod solids;
mod street;

use std::fs;
use std::path::{Path, PathBuf};

/// A scene of the comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// A furnished room: more than 100 000 triangles, image textures, coats, area lights.
    Interior,
    /// Glass and metal under an environment map.
    Glass,
    /// A thousand lamps in a street at night.
    Street,
    /// The furnished room under a sky with its sun, through a window.
    Daylight,
    /// Sun, sky and some three hundred lamps.
    Plaza,
}

impl Kind {
    /// Name of its files.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Interior => "interior",
            Self::Glass => "glass",
            Self::Street => "street-at-night",
            Self::Daylight => "room-by-day",
            Self::Plaza => "plaza-at-sundown",
        }
    }
}

/// A scene that was written in both formats.
#[derive(Clone, Debug)]
pub(crate) struct Written {
    /// For us.
    pub(crate) pbrt: PathBuf,
    /// For Mitsuba 3.
    pub(crate) mitsuba: PathBuf,
    /// Columns [px].
    pub(crate) width: u32,
    /// Rows [px].
    pub(crate) height: u32,
    /// Mitsuba's `max_depth`: one more than the bounces of a path.
    pub(crate) max_depth: u32,
}

/// Writes a scene with its meshes and pictures into `directory`, which is made if need be.
///
/// # Errors
/// When a file cannot be written.
pub(crate) fn write(kind: Kind, directory: &Path) -> Result<Written, String> {
    fs::create_dir_all(directory).map_err(|e| format!("{}: {e}", directory.display()))?;
    let scene = match kind {
        Kind::Interior => interior::interior(),
        Kind::Glass => glass::glass(),
        Kind::Street => street::street(),
        Kind::Daylight => interior::by_day(),
        Kind::Plaza => plaza::plaza(),
    };
    for object in &scene.objects {
        put(&directory.join(format!("{}.ply", object.name)), &object.mesh.to_ply())?;
    }
    for (name, picture) in &scene.pictures {
        put(&directory.join(name), &picture.encoded()?)?;
    }
    let written = Written {
        pbrt: directory.join(format!("{}.pbrt", kind.name())),
        mitsuba: directory.join(format!("{}.xml", kind.name())),
        width: scene.view.width,
        height: scene.view.height,
        max_depth: scene.view.max_depth,
    };
    put(&written.pbrt, pbrt::text(&scene).as_bytes())?;
    put(&written.mitsuba, mitsuba::text(&scene).as_bytes())?;
    Ok(written)
}

fn put(path: &Path, bytes: &[u8]) -> Result<(), String> {
    fs::write(path, bytes).map_err(|e| format!("{}: {e}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[ignore = "writes the scenes to look at into the folder target/bench/scenes"]
    fn write_all() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/bench/scenes");
        for kind in [Kind::Interior, Kind::Glass, Kind::Street, Kind::Daylight, Kind::Plaza] {
            write(kind, &folder).unwrap();
        }
    }

    #[test]
    fn all_scenes_compile_and_hold_what_they_are_for() {
        use steradian::scene::Disk;
        use steradian::scene::import::pbrt::{Input, import};
        let directory = std::env::temp_dir().join(format!("steradian-scenes-{}", std::process::id()));
        for kind in [Kind::Interior, Kind::Glass, Kind::Street, Kind::Daylight, Kind::Plaza] {
            let written = write(kind, &directory).unwrap();
            let mut imported = import(&[Input::File(&written.pbrt)], &Disk);
            let job = imported
                .scene
                .take()
                .and_then(|desc| steradian::scene::compile(desc, &Disk, &mut imported.diagnostics));
            assert!(job.is_some(), "{kind:?}: {:?}", imported.diagnostics);
        }
        let triangles: usize = interior::interior().objects.iter().map(|o| o.mesh.triangles.len()).sum();
        assert!(triangles > 100_000, "{triangles}");
        let emitters = |scene: description::Scene| {
            let panes = scene.objects.iter().filter(|o| o.emission.is_some());
            scene.lamps.len() + panes.map(|o| o.mesh.triangles.len()).sum::<usize>()
        };
        let (street, plaza) = (emitters(street::street()), emitters(plaza::plaza()));
        assert!((900..1200).contains(&street) && (280..500).contains(&plaza), "{street} {plaza}");
        fs::remove_dir_all(&directory).unwrap();
    }
}
