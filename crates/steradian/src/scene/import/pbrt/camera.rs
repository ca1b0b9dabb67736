//! Camera classes.

use super::args::Args;
use crate::scene::desc::{CameraKind, ProjectionDesc, SphericalMapping};
use crate::scene::text::Text;

const CLASSES: &[&str] = &["perspective", "orthographic", "spherical", "realistic"];
const V3_CLASSES: &[&str] = &["environment"];

/// What a Camera directive says besides its placement.
pub(super) struct CameraSettings {
    pub(super) kind: CameraKind,
    pub(super) shutter_open: f32,
    pub(super) shutter_close: f32,
}

impl Default for CameraSettings {
    fn default() -> Self {
        let kind = CameraKind::Perspective { fov: 90.0, projection: PINHOLE };
        Self { kind, shutter_open: 0.0, shutter_close: 1.0 }
    }
}

const PINHOLE: ProjectionDesc =
    ProjectionDesc { lens_radius: 0.0, focal_distance: 1e6, frame_aspect_ratio: None, screen_window: None };

/// Reads the parameters of a camera class; `None` when it is unknown or unsupported (and reported).
pub(super) fn camera(class: &Text, args: &mut Args<'_>) -> Option<CameraSettings> {
    let kind = match class.value.as_str() {
        "perspective" => {
            let span = args.span_of("halffov");
            let mut fov = args.float_where("fov", 90.0, |v| v > 0.0 && v < 180.0, "between 0 and 180");
            if let Some(half) = args.float_opt("halffov").filter(|h| *h > 0.0) {
                if half >= 90.0 {
                    args.error(span, format!("parameter \"halffov\" must be between 0 and 90, found {half}"));
                } else {
                    fov = 2.0 * half;
                }
            }
            CameraKind::Perspective { fov, projection: projection(args) }
        }
        "orthographic" => CameraKind::Orthographic { projection: projection(args) },
        "spherical" => {
            // pbrt accepts and ignores a lens here.
            projection(args);
            let mappings = [
                ("equalarea", SphericalMapping::EqualArea),
                ("equirectangular", SphericalMapping::Equirectangular),
            ];
            CameraKind::Spherical { mapping: args.choice("mapping", SphericalMapping::EqualArea, &mappings) }
        }
        "realistic" => {
            args.unsupported_class("camera", class);
            return None;
        }
        _ => {
            args.unknown_class("camera", class, CLASSES, V3_CLASSES);
            return None;
        }
    };
    let span = args.span_of("shutterclose");
    let (open, close) = (args.float("shutteropen", 0.0), args.float("shutterclose", 1.0));
    if close < open {
        args.ctx.diagnostics.warning(span, "the shutter closes before it opens; the two times are swapped");
    }
    if close == open {
        args.error(span, "the shutter is open for no time: the picture would be black");
    }
    Some(CameraSettings { kind, shutter_open: open.min(close), shutter_close: open.max(close) })
}

fn projection(args: &mut Args<'_>) -> ProjectionDesc {
    let lens_radius = args.non_negative("lensradius", 0.0);
    let focal_distance = args.positive("focaldistance", 1e6);
    let frame_aspect_ratio = args.has("frameaspectratio").then(|| args.positive("frameaspectratio", 1.0));
    let screen_window = args.four_floats("screenwindow").and_then(|(w, span)| {
        let full = w[0] != w[1] && w[2] != w[3];
        if !full {
            args.error(span, "the screen window is empty");
        }
        full.then_some(w)
    });
    // Asked for even when absent, so that a slip in the name is recognised.
    if frame_aspect_ratio.is_none() {
        args.float_opt("frameaspectratio");
    }
    ProjectionDesc { lens_radius, focal_distance, frame_aspect_ratio, screen_window }
}
