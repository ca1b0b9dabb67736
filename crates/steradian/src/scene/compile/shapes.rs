//! From shape statements to geometry and its placement.

use super::geometry;
use super::materials::CompiledMaterials;
use super::textures::TextureCompiler;
use super::view::rebase;
use crate::accel::{AccelError, Coverage, Instance, Layout, ObjectId};
use crate::math::{AnimatedTransform, Transform};
use crate::scene::compiled::ShapeAttributes;
use crate::scene::desc::{AreaLightDesc, FileRef, Id, MaterialDesc, SceneDesc, ShapeDesc, ShapeKind};
use crate::scene::diagnostic::Diagnostics;
use crate::scene::files::FileSystem;
use crate::scene::source::Span;
use crate::shape::{Orientation, Shape, ShapeId};
use crate::texture::FloatInput;

/// All geometry of a scene, in the order in which it was stated.
#[derive(Default)]
pub(super) struct ShapeSet {
    pub(super) shapes: Vec<Shape>,
    pub(super) attributes: Vec<ShapeAttributes>,
    pub(super) layout: Layout,
    /// The statement of each shape, and of each instance of the layout.
    spans: Vec<Span>,
    instance_spans: Vec<Span>,
    /// Shapes that emit, for the light compiler.
    pub(super) emitters: Vec<EmittingShape>,
}

impl ShapeSet {
    /// Reports an error of the acceleration structure at the statement that it is about, or else at `scene`.
    pub(super) fn report(&self, error: &AccelError, scene: Span, diagnostics: &mut Diagnostics) {
        const BEYOND: &str = "reaches beyond the range of floats in render space";
        let (span, message) = match error {
            AccelError::UnboundedShape { shape, .. } => {
                (self.spans.get(*shape as usize), format!("the shape {BEYOND}"))
            }
            AccelError::UnboundedInstance { instance } => {
                (self.instance_spans.get(*instance), format!("the instance {BEYOND}"))
            }
            other => (None, other.to_string()),
        };
        diagnostics.error(span.copied().unwrap_or(scene), message);
    }
}

/// A shape with an area light.
pub(super) struct EmittingShape {
    pub(super) shape: ShapeId,
    pub(super) light: Id<AreaLightDesc>,
    /// Picture of the emission that the shape itself names (bilinear patches).
    pub(super) picture: Option<FileRef>,
}

/// Takes the geometry out of `shapes`, `objects` and `instances`, so that large arrays are moved, not copied.
pub(super) struct ShapeCompiler<'a, 'b> {
    pub(super) files: &'a dyn FileSystem,
    pub(super) textures: &'b mut TextureCompiler<'a>,
    pub(super) materials: &'b CompiledMaterials,
    pub(super) material_descs: &'a [MaterialDesc],
    pub(super) render_from_world: Transform,
    pub(super) set: ShapeSet,
}

/// The geometry of a description, separated from what the compilers only read.
pub(super) struct Geometry {
    shapes: Vec<ShapeDesc>,
    objects: Vec<Vec<ShapeDesc>>,
    instances: Vec<(usize, AnimatedTransform, Span)>,
}

impl Geometry {
    /// Moves the geometry out of a description.
    pub(super) fn take(desc: &mut SceneDesc) -> Self {
        Self {
            shapes: std::mem::take(&mut desc.shapes),
            objects: desc.objects.iter_mut().map(|o| std::mem::take(&mut o.shapes)).collect(),
            instances: desc
                .instances
                .iter()
                .map(|i| (i.object.index(), i.world_from_instance.clone(), i.span))
                .collect(),
        }
    }
}

impl ShapeCompiler<'_, '_> {
    pub(super) fn compile(mut self, geometry: Geometry) -> ShapeSet {
        for shapes in geometry.objects {
            let mut object = Vec::new();
            for shape in shapes {
                if shape.world_from_object.is_animated() {
                    let message =
                        "a moving shape inside an object is not supported; move the instance instead";
                    self.textures.diagnostics.error(shape.span, message);
                    continue;
                }
                let object_from_shape = *shape.world_from_object.start();
                object.extend(self.add(shape, &object_from_shape));
            }
            self.set.layout.objects.push(object);
        }
        for (object, world_from_instance, span) in geometry.instances {
            self.set.instance_spans.push(span);
            let render_from_object = rebase(&self.render_from_world, &world_from_instance);
            self.set.layout.instances.push(Instance { object: ObjectId(object as u32), render_from_object });
        }
        for shape in geometry.shapes {
            let placement = rebase(&self.render_from_world, &shape.world_from_object);
            if placement.is_animated() {
                self.add_moving(shape, placement);
            } else {
                let added = self.add(shape, placement.start());
                self.set.layout.world.extend(added);
            }
        }
        self.set
    }

    /// A moving shape is an object with one instance.
    fn add_moving(&mut self, shape: ShapeDesc, render_from_object: AnimatedTransform) {
        if shape.area_light.is_some() {
            self.textures.diagnostics.error(shape.span, "an area light on a moving shape is not supported");
            return;
        }
        self.set.instance_spans.push(shape.span);
        let object = ObjectId(self.set.layout.objects.len() as u32);
        let ids = self.add(shape, &Transform::IDENTITY);
        self.set.layout.objects.push(ids);
        self.set.layout.instances.push(Instance { object, render_from_object });
    }

    /// Adds the shapes that one statement makes (a PLY file may hold triangles and patches) and returns their ids.
    fn add(&mut self, desc: ShapeDesc, render_from_object: &Transform) -> Vec<ShapeId> {
        let span = desc.span;
        let is_interface =
            self.material_descs.get(desc.material.index()).is_some_and(MaterialDesc::is_interface);
        if is_interface && desc.area_light.is_none() {
            // Without media on its sides a mere boundary does nothing.
            return Vec::new();
        }
        let alpha = self.textures.float(&desc.alpha);
        if alpha != FloatInput::Constant(1.0) && desc.area_light.is_some() {
            let message = "an area light with alpha is not supported: light would be sampled from its holes";
            self.textures.diagnostics.error(span, message);
        }
        let coverage = match alpha {
            // Shadow rays must be able to pass an emitting boundary.
            FloatInput::Constant(a) if a >= 1.0 && !is_interface => Coverage::Opaque,
            _ => Coverage::Tested,
        };
        let picture = match &desc.kind {
            ShapeKind::BilinearMesh { emission, .. } => emission.clone(),
            _ => None,
        };
        let pieces = geometry::build(
            desc.kind,
            if desc.reverse_orientation { Orientation::Reversed } else { Orientation::AsDefined },
            render_from_object,
            self.files,
            span,
            self.textures.diagnostics,
        );
        let mut ids = Vec::with_capacity(pieces.len());
        for shape in pieces {
            let id = ShapeId(self.set.shapes.len() as u32);
            self.set.shapes.push(shape);
            self.set.spans.push(span);
            self.set.layout.coverage.push(coverage);
            self.set.attributes.push(ShapeAttributes {
                material: self.materials.id(desc.material),
                light: None,
                alpha,
            });
            if let Some(light) = desc.area_light {
                self.set.emitters.push(EmittingShape { shape: id, light, picture: picture.clone() });
            }
            ids.push(id);
        }
        ids
    }
}
