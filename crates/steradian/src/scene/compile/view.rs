//! Camera, sampler and the space in which rays are traced.

use crate::camera::{Camera, CameraError, Lens, Projection, Screen, SphereMap};
use crate::light::Handedness;
use crate::math::{AnimatedTransform, Point, Transform, Vec3};
use crate::sampler;
use crate::scene::desc::{
    CameraDesc, CameraKind, ProjectionDesc, Randomization, RenderingSpace, SamplerDesc, SamplerKind,
    SphericalMapping,
};
use crate::scene::diagnostic::Diagnostics;

/// `render_from_world`: where the origin lies decides how much precision is left far from it.
pub(super) fn render_from_world(camera: &CameraDesc, space: RenderingSpace) -> Transform {
    let middle = 0.5 * (camera.shutter_open + camera.shutter_close);
    let world_from_camera = camera.world_from_camera.at(middle);
    match space {
        RenderingSpace::World => Transform::IDENTITY,
        RenderingSpace::Camera => world_from_camera.inverse(),
        RenderingSpace::CameraWorld => {
            Transform::translate(Vec3::ZERO - *world_from_camera.point(Point::ORIGIN))
        }
    }
}

/// How the picture shows the axes of render space.
pub(super) fn handedness(camera: &CameraDesc, render_from_world: &Transform) -> Handedness {
    let render_from_camera = *render_from_world * *camera.world_from_camera.start();
    if render_from_camera.swaps_handedness() { Handedness::Right } else { Handedness::Left }
}

/// `target_from_world` after an animated transform.
pub(super) fn rebase(target_from_world: &Transform, animated: &AnimatedTransform) -> AnimatedTransform {
    if animated.is_animated() {
        let (start, end) = (*animated.start(), *animated.end());
        AnimatedTransform::new(*target_from_world * start, *target_from_world * end, animated.times())
    } else {
        AnimatedTransform::fixed(*target_from_world * *animated.start())
    }
}

pub(super) fn camera(
    desc: &CameraDesc,
    resolution: [u32; 2],
    render_from_world: &Transform,
) -> Result<Camera, CameraError> {
    let screen = |p: &ProjectionDesc| Screen::new(resolution, p.frame_aspect_ratio, p.screen_window);
    let lens = |p: &ProjectionDesc| Lens { radius: p.lens_radius, focal_distance: p.focal_distance };
    let projection = match &desc.kind {
        CameraKind::Perspective { fov, projection } => {
            Projection::perspective(screen(projection)?, *fov, lens(projection))?
        }
        CameraKind::Orthographic { projection } => {
            Projection::orthographic(screen(projection)?, lens(projection))?
        }
        CameraKind::Spherical { mapping } => {
            let map = match mapping {
                SphericalMapping::EqualArea => SphereMap::EqualArea,
                SphericalMapping::Equirectangular => SphereMap::Equirectangular,
            };
            Projection::spherical(resolution, map)?
        }
    };
    let placement = rebase(render_from_world, &desc.world_from_camera);
    Camera::new(projection, placement, [desc.shutter_open, desc.shutter_close])
}

/// The family of sample points for a statement; a family that is not built in is replaced by its nearest, with a notice.
pub(super) fn sampler_kind(desc: &SamplerDesc, diagnostics: &mut Diagnostics) -> sampler::SamplerKind {
    let random = |r: Randomization| match r {
        Randomization::None => sampler::Randomization::None,
        Randomization::PermuteDigits => sampler::Randomization::PermuteDigits,
        Randomization::FastOwen => sampler::Randomization::FastOwen,
        Randomization::Owen => sampler::Randomization::Owen,
    };
    match desc.kind {
        SamplerKind::Independent => sampler::SamplerKind::Independent,
        SamplerKind::Stratified { x, y, jitter } => sampler::SamplerKind::Stratified { x, y, jitter },
        SamplerKind::Halton(r) => sampler::SamplerKind::Halton(random(r)),
        SamplerKind::PaddedSobol(r) => sampler::SamplerKind::PaddedSobol(random(r)),
        SamplerKind::ZSobol(r) => sampler::SamplerKind::ZSobol(random(r)),
        SamplerKind::Sobol(r) => {
            diagnostics
                .notice(desc.span, "sampler \"sobol\" is rendered with \"zsobol\", its nearest relative");
            sampler::SamplerKind::ZSobol(random(r))
        }
        SamplerKind::Pmj02bn => {
            diagnostics
                .notice(desc.span, "sampler \"pmj02bn\" is rendered with \"zsobol\", its nearest relative");
            sampler::SamplerKind::ZSobol(sampler::Randomization::FastOwen)
        }
    }
}
