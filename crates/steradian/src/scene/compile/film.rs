//! Whether the film can be exposed: what its parameters, each right for itself, come to together.

use crate::scene::desc::{CameraDesc, FilmDesc, FilmKind, GBufferSpace};
use crate::scene::diagnostic::{Diagnostic, Diagnostics};

/// Memory that a film may take while rendering [B]; beyond it a resolution is taken for a slip.
const MAX_BYTES: u64 = 64 << 30;

/// Reports films without pixels, beyond all memory, or without a usable exposure.
pub(super) fn check(film: &FilmDesc, camera: &CameraDesc, diagnostics: &mut Diagnostics) {
    let [x0, x1, y0, y1] = film.window();
    if x0 >= x1 || y0 >= y1 {
        let [width, height] = film.resolution;
        diagnostics.error(
            film.span,
            format!("the part to be rendered contains none of the {width} x {height} pixels"),
        );
        return;
    }
    let bytes = u64::from(x1 - x0) * u64::from(y1 - y0) * bytes_per_pixel(film.kind);
    if bytes > MAX_BYTES {
        let message = format!(
            "{} x {} pixels of this film need about {} GiB of memory, more than {}",
            x1 - x0,
            y1 - y0,
            bytes >> 30,
            MAX_BYTES >> 30
        );
        diagnostics
            .push(Diagnostic::error(film.span, message).with_help("render it in parts by \"cropwindow\""));
    }
    let exposure = (camera.shutter_close - camera.shutter_open) * film.sensor.iso / 100.0;
    if !(exposure.is_normal() && exposure > 0.0) {
        let message =
            format!("shutter time and ISO make an exposure of {exposure:e}, which no picture can show");
        let error = Diagnostic::error(film.span, message);
        diagnostics.push(error.with_related(camera.span, "the shutter times are the camera's"));
    }
}

/// What a film keeps of a pixel and what it develops into, roughly [B].
fn bytes_per_pixel(kind: FilmKind) -> u64 {
    const RGB: u64 = 64;
    match kind {
        FilmKind::Rgb => RGB,
        FilmKind::GBuffer { space: GBufferSpace::Camera | GBufferSpace::World } => RGB + 320,
        FilmKind::Spectral { n_buckets, .. } => RGB + 24 * u64::from(n_buckets),
    }
}
