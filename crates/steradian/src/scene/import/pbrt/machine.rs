//! The state machine: which directive may come where, what it does to the graphics state, and files within files.

use super::args::Preset;
use super::context::Context;
use super::input::Input;
use super::options::set_option;
use super::state::{Ctm, State, Target};
use crate::color::ColorSpaceKind;
use crate::material;
use crate::math::{Point, Transform, Vec3};
use crate::scene::desc::{
    AreaLightDesc, CameraDesc, FilmDesc, FilterDesc, Id, InstanceDesc, IntegratorDesc, LightDesc,
    MaterialDesc, ObjectDesc, OptionsDesc, SamplerDesc, ShapeDesc,
};
use crate::scene::diagnostic::Diagnostic;
use crate::scene::files::{FileBytes, FileSystem, reason};
use crate::scene::source::{SourceMap, Span};
use crate::scene::text::{ActiveTransform, Directive, Entity, Params, Parser, Statement, Text};
use glam::Mat4;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;

/// Files inside files inside files: beyond this depth something is wrong.
const MAX_DEPTH: usize = 64;
/// Number of Include and Import directives that are followed.
const MAX_INCLUDES: usize = 1_000_000;

/// The part of the file that the reader is in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Section {
    /// Before `WorldBegin`.
    Header,
    /// After it.
    World,
}

/// Where a directive may stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    Header,
    World,
    Anywhere,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum BlockKind {
    Attribute,
    Object,
}

/// A block that is open, with the state to return to.
#[derive(Debug)]
struct Block {
    kind: BlockKind,
    span: Span,
    saved: State,
}

/// A file that is being read.
struct Frame {
    path: PathBuf,
    parser: Parser,
    import: Option<BeforeImport>,
}

/// What an `Import` leaves as it was.
struct BeforeImport {
    state: State,
    blocks: usize,
    coordinate_systems: HashMap<String, Ctm>,
}

/// An object definition that is open.
#[derive(Debug)]
pub(super) struct OpenObject {
    pub(super) id: Option<Id<ObjectDesc>>,
    pub(super) desc: ObjectDesc,
}

/// An import in progress.
pub(super) struct Importer<'f> {
    files: &'f dyn FileSystem,
    cache: HashMap<PathBuf, Arc<FileBytes>>,
    stack: Vec<Frame>,
    includes: usize,
    blocks: Vec<Block>,
    coordinate_systems: HashMap<String, Ctm>,
    pub(super) section: Section,
    /// Something that belongs into the world came before it.
    pub(super) world_too_early: bool,
    pub(super) sources: SourceMap,
    pub(super) ctx: Context,
    pub(super) state: State,
    pub(super) object: Option<OpenObject>,
    pub(super) options: OptionsDesc,
    pub(super) camera: Option<CameraDesc>,
    pub(super) film: Option<FilmDesc>,
    pub(super) filter: Option<FilterDesc>,
    pub(super) sampler: Option<SamplerDesc>,
    pub(super) integrator: Option<IntegratorDesc>,
    /// The last Accelerator directive.
    pub(super) accelerator: Option<Span>,
    pub(super) lights: Vec<LightDesc>,
    pub(super) area_lights: Vec<AreaLightDesc>,
    pub(super) shapes: Vec<ShapeDesc>,
    pub(super) instances: Vec<InstanceDesc>,
    /// The end of the last main file.
    pub(super) end: Option<Span>,
}

impl<'f> Importer<'f> {
    pub(super) fn new(files: &'f dyn FileSystem) -> Self {
        Self {
            files,
            cache: HashMap::new(),
            stack: Vec::new(),
            includes: 0,
            blocks: Vec::new(),
            coordinate_systems: HashMap::new(),
            section: Section::Header,
            world_too_early: false,
            sources: SourceMap::new(),
            ctx: Context::default(),
            // The id of the default material, which `read` adds with the place of the first file.
            state: State::new(Id::new(0)),
            object: None,
            options: OptionsDesc::default(),
            camera: None,
            film: None,
            filter: None,
            sampler: None,
            integrator: None,
            accelerator: None,
            lights: Vec::new(),
            area_lights: Vec::new(),
            shapes: Vec::new(),
            instances: Vec::new(),
            end: None,
        }
    }

    /// Reads one main file to its end.
    pub(super) fn read(&mut self, input: &Input<'_>) {
        let (name, path, bytes) = match input {
            Input::File(path) => match self.files.read(path) {
                Ok(bytes) => {
                    self.ctx.base = path.parent().map(Path::to_owned).unwrap_or_default();
                    (path.display().to_string(), path.to_path_buf(), bytes)
                }
                Err(e) => {
                    let message = format!("cannot read {}: {}", path.display(), reason(&e));
                    self.ctx.diagnostics.push(Diagnostic::unplaced_error(message));
                    return;
                }
            },
            Input::Text { name, bytes, base } => {
                self.ctx.base = base.to_path_buf();
                ((*name).to_owned(), PathBuf::new(), FileBytes::Owned(bytes.to_vec()))
            }
        };
        let bytes = Arc::new(bytes);
        let file = self.sources.add(name, Arc::clone(&bytes), None);
        if self.ctx.materials.len() == 0 {
            self.ctx.materials.push(default_material(self.sources.start_of(file)));
        }
        let parser = Parser::new(file, bytes);
        self.end = Some(parser.end());
        self.stack.push(Frame { path, parser, import: None });
        while let Some(frame) = self.stack.last_mut() {
            match frame.parser.next_directive(&mut self.ctx.diagnostics) {
                Some(directive) => self.execute(directive),
                None => self.close_file(),
            }
            if self.ctx.is_v3 {
                self.stack.clear();
            }
        }
    }

    fn error(&mut self, span: Span, message: impl Into<String>) {
        self.ctx.diagnostics.error(span, message);
    }

    fn execute(&mut self, directive: Directive) {
        let Directive { statement, span } = directive;
        if !self.check_place(&statement, span) {
            return;
        }
        match statement {
            Statement::LookAt(v) => {
                let look = Transform::look_at(
                    Point::new(v[0], v[1], v[2]),
                    Point::new(v[3], v[4], v[5]),
                    Vec3::new(v[6], v[7], v[8]),
                );
                let fault = "`LookAt` needs a target away from the eye and an up vector across the view";
                self.concatenate(look, span, fault);
            }
            Statement::Translate(v) => self.concatenate(Some(Transform::translate(v.into())), span, ""),
            Statement::Rotate([angle, x, y, z]) => {
                self.concatenate(
                    Transform::rotate(angle, Vec3::new(x, y, z)),
                    span,
                    "`Rotate` needs an axis that is not zero",
                );
            }
            Statement::Scale(v) => {
                let fault = "`Scale` by zero along an axis cannot be inverted";
                self.concatenate(Transform::scale(v.into()), span, fault);
            }
            Statement::Transform(m) => {
                if let Some(t) = self.matrix(&m, span) {
                    self.change_ctm(span, |_| t);
                }
            }
            Statement::ConcatTransform(m) => {
                if let Some(t) = self.matrix(&m, span) {
                    self.change_ctm(span, |ctm| *ctm * t);
                }
            }
            Statement::Identity => self.change_ctm(span, |_| Transform::IDENTITY),
            Statement::CoordinateSystem(name) => {
                self.coordinate_systems.insert(name.value, self.state.ctm);
            }
            Statement::CoordSysTransform(name) => self.coord_sys_transform(&name),
            Statement::ActiveTransform(which) => {
                self.state.active = match which {
                    ActiveTransform::StartTime => [true, false],
                    ActiveTransform::EndTime => [false, true],
                    ActiveTransform::All => [true, true],
                };
            }
            Statement::TransformTimes(times) => self.transform_times(times, span),
            Statement::ReverseOrientation => self.state.reverse_orientation ^= true,
            Statement::AttributeBegin => self.open_block(BlockKind::Attribute, span),
            Statement::AttributeEnd => self.attribute_end("AttributeEnd", span),
            Statement::TransformBegin => {
                let message = "`TransformBegin` is an old name of `AttributeBegin`, which it behaves as";
                self.ctx.diagnostics.notice(span, message);
                self.open_block(BlockKind::Attribute, span);
            }
            Statement::TransformEnd => self.attribute_end("TransformEnd", span),
            Statement::Attribute(target, params) => self.attribute(&target, params),
            Statement::Entity(entity, class, params) => self.entity(entity, &class, params, span),
            Statement::NamedMaterial(name) => self.state.material = self.ctx.materials.refer(&name),
            Statement::Texture(texture) => self.texture(*texture, span),
            Statement::MediumInterface(inside, outside) => {
                self.state.media = Some(self.ctx.media(&inside, &outside));
            }
            Statement::ObjectBegin(name) => self.object_begin(&name, span),
            Statement::ObjectEnd => self.object_end(span),
            Statement::ObjectInstance(name) => self.object_instance(&name, span),
            Statement::Include(name) => self.open_file(&name, span, None),
            Statement::Import(name) => self.import_file(&name, span),
            Statement::ColorSpace(name) => self.color_space(&name),
            Statement::Option(param) => set_option(&mut self.options, &param, &mut self.ctx.diagnostics),
            Statement::WorldBegin => self.world_begin(),
            Statement::WorldEnd => self.ctx.found_v3(span, "which has no `WorldEnd`"),
        }
    }

    /// Whether a directive may stand here; reports it otherwise.
    fn check_place(&mut self, statement: &Statement, span: Span) -> bool {
        let place = place_of(statement);
        match (place, self.section) {
            (Place::Header, Section::World) if matches!(statement, Statement::WorldBegin) => {
                self.error(span, "a second `WorldBegin`");
                false
            }
            (Place::Header, Section::World) => {
                let keyword = self.keyword(span);
                self.error(span, format!("`{keyword}` must come before `WorldBegin`"));
                false
            }
            (Place::World, Section::Header) => {
                // One report is enough for a file that has forgotten it; the directive is checked all the same.
                if !self.world_too_early {
                    let keyword = self.keyword(span);
                    self.error(span, format!("`{keyword}` must come after `WorldBegin`"));
                }
                self.world_too_early = true;
                true
            }
            _ => true,
        }
    }

    fn keyword(&self, span: Span) -> String {
        let Some(file) = self.sources.file(span.file) else { return String::new() };
        let start = usize::try_from(span.start).unwrap_or(usize::MAX).min(file.bytes.len());
        let end = (start + span.len as usize).min(file.bytes.len());
        String::from_utf8_lossy(&file.bytes[start..end]).into_owned()
    }

    fn world_begin(&mut self) {
        self.section = Section::World;
        self.state.ctm = Ctm::IDENTITY;
        self.state.active = [true, true];
        self.coordinate_systems.insert("world".to_owned(), Ctm::IDENTITY);
    }

    fn matrix(&mut self, m: &[f32; 16], span: Span) -> Option<Transform> {
        let t = Transform::from_matrix(Mat4::from_cols_array(m));
        if t.is_none() {
            let keyword = self.keyword(span);
            self.error(span, format!("the matrix of `{keyword}` cannot be inverted"));
        }
        t
    }

    fn concatenate(&mut self, t: Option<Transform>, span: Span, fault: &str) {
        match t {
            Some(t) => self.change_ctm(span, |ctm| *ctm * t),
            None => self.error(span, fault),
        }
    }

    fn change_ctm(&mut self, span: Span, change: impl Fn(&Transform) -> Transform) {
        if !self.state.change_ctm(change) {
            self.error(span, "the current transform becomes too large or too small for 32-bit floats");
        }
    }

    fn coord_sys_transform(&mut self, name: &Text) {
        if let Some(ctm) = self.coordinate_systems.get(&name.value) {
            self.state.ctm = *ctm;
            return;
        }
        let message = format!("unknown coordinate system \"{}\"; the directive has no effect", name.value);
        let mut known: Vec<&str> = self.coordinate_systems.keys().map(String::as_str).collect();
        known.sort_unstable();
        self.ctx.diagnostics.push(Diagnostic::warning(name.span, message).with_nearest(&name.value, known));
    }

    /// Remembers where the camera is, for `CoordSysTransform "camera"`.
    pub(super) fn name_camera_space(&mut self) {
        self.coordinate_systems.insert("camera".to_owned(), self.state.ctm.inverse());
    }

    fn transform_times(&mut self, times: [f32; 2], span: Span) {
        if times[0] > times[1] {
            self.error(span, "`TransformTimes` needs the start before the end");
        } else {
            self.state.times = times;
        }
    }

    fn color_space(&mut self, name: &Text) {
        match ColorSpaceKind::from_name(&name.value) {
            Some(kind) => self.state.color_space = kind,
            None => {
                let d = Diagnostic::error(name.span, format!("unknown colour space \"{}\"", name.value));
                let known = ColorSpaceKind::ALL.map(ColorSpaceKind::name);
                self.ctx.diagnostics.push(d.with_help(format!("known are {}", known.join(", "))));
            }
        }
    }

    fn attribute(&mut self, target: &Text, params: Params) {
        let Some((_, t)) = Target::NAMES.iter().find(|(name, _)| *name == target.value) else {
            let d = Diagnostic::error(target.span, format!("unknown attribute target \"{}\"", target.value));
            let known = Target::NAMES.map(|(name, _)| name);
            self.ctx.diagnostics.push(d.with_help(format!("known are {}", known.join(", "))));
            return;
        };
        let color_space = self.state.color_space;
        let presets = params.list.into_iter().map(|p| Preset { param: Rc::new(p), color_space });
        self.state.add_presets(*t, presets);
    }

    fn open_block(&mut self, kind: BlockKind, span: Span) {
        self.blocks.push(Block { kind, span, saved: self.state.clone() });
    }

    /// Closes the innermost block when it is of that kind and of this file, as far as an import is concerned.
    fn close_block(&mut self, kind: BlockKind) -> bool {
        let floor = self.stack.iter().rev().find_map(|f| f.import.as_ref()).map_or(0, |i| i.blocks);
        if self.blocks.len() > floor
            && let Some(block) = self.blocks.pop_if(|b| b.kind == kind)
        {
            self.state = block.saved;
            return true;
        }
        false
    }

    fn attribute_end(&mut self, keyword: &str, span: Span) {
        if self.close_block(BlockKind::Attribute) {
            return;
        }
        let begin = keyword.replace("End", "Begin");
        let d = Diagnostic::error(span, format!("`{keyword}` without `{begin}`"));
        self.ctx.diagnostics.push(match self.blocks.last() {
            Some(b) => d.with_related(b.span, "the innermost open block is this one"),
            None => d,
        });
    }

    fn object_begin(&mut self, name: &Text, span: Span) {
        if self.object.is_some() {
            self.error(span, "an object cannot be defined inside another");
        }
        self.open_block(BlockKind::Object, span);
        let id = match self.ctx.objects.define(name) {
            Ok(id) => Some(id),
            Err(first) => {
                let d = Diagnostic::error(name.span, format!("object \"{}\" is defined twice", name.value));
                self.ctx.diagnostics.push(d.with_related(first, "the first definition is here"));
                None
            }
        };
        let desc = ObjectDesc { name: name.value.clone(), shapes: Vec::new(), span };
        self.object = Some(OpenObject { id, desc });
    }

    fn object_end(&mut self, span: Span) {
        if !self.close_block(BlockKind::Object) {
            let d = Diagnostic::error(span, "`ObjectEnd` without `ObjectBegin`");
            self.ctx.diagnostics.push(match self.blocks.last() {
                Some(b) => d.with_related(b.span, "the innermost open block is this one"),
                None => d,
            });
            return;
        }
        if let Some(OpenObject { id: Some(id), desc }) = self.object.take() {
            self.ctx.objects.set(id, desc);
        }
    }

    fn object_instance(&mut self, name: &Text, span: Span) {
        if self.object.is_some() {
            self.error(span, "an object cannot be placed inside the definition of another");
            return;
        }
        let object = self.ctx.objects.refer(name);
        self.instances.push(InstanceDesc { object, world_from_instance: self.state.animated(), span });
    }

    fn import_file(&mut self, name: &Text, span: Span) {
        if self.object.is_some() {
            self.error(span, "`Import` is not allowed inside the definition of an object");
            return;
        }
        let before = BeforeImport {
            state: self.state.clone(),
            blocks: self.blocks.len(),
            coordinate_systems: self.coordinate_systems.clone(),
        };
        self.open_file(name, span, Some(before));
    }

    fn open_file(&mut self, name: &Text, span: Span, import: Option<BeforeImport>) {
        let path = self.ctx.base.join(&name.value);
        self.includes += 1;
        let shown = &name.value;
        let fault = if self.stack.iter().any(|f| f.path == path) {
            format!("\"{shown}\" includes itself")
        } else if self.stack.len() >= MAX_DEPTH {
            format!("files are included more than {MAX_DEPTH} deep")
        } else if self.includes > MAX_INCLUDES {
            format!("more than {MAX_INCLUDES} files are included")
        } else {
            match self.cached(&path) {
                Ok(bytes) => {
                    let file = self.sources.add(path.display().to_string(), Arc::clone(&bytes), Some(span));
                    self.stack.push(Frame { path, parser: Parser::new(file, bytes), import });
                    return;
                }
                Err(e) => format!("cannot read \"{shown}\": {}", reason(&e)),
            }
        };
        self.error(name.span, fault);
    }

    fn cached(&mut self, path: &Path) -> std::io::Result<Arc<FileBytes>> {
        if let Some(bytes) = self.cache.get(path) {
            return Ok(Arc::clone(bytes));
        }
        let bytes = Arc::new(self.files.read(path)?);
        self.cache.insert(path.to_owned(), Arc::clone(&bytes));
        Ok(bytes)
    }

    fn close_file(&mut self) {
        let Some(frame) = self.stack.pop() else { return };
        if let Some(before) = frame.import {
            self.report_open_blocks(before.blocks);
            self.blocks.truncate(before.blocks);
            self.object = None;
            self.state = before.state;
            self.coordinate_systems = before.coordinate_systems;
        }
    }

    /// Reports the blocks beyond the first `from` as never closed.
    pub(super) fn report_open_blocks(&mut self, from: usize) {
        for block in self.blocks.iter().skip(from) {
            let keyword = match block.kind {
                BlockKind::Attribute => "AttributeBegin",
                BlockKind::Object => "ObjectBegin",
            };
            self.ctx.diagnostics.error(block.span, format!("this `{keyword}` is never closed"));
        }
    }
}

fn place_of(statement: &Statement) -> Place {
    match statement {
        Statement::WorldBegin
        | Statement::Entity(
            Entity::Camera
            | Entity::Film
            | Entity::PixelFilter
            | Entity::Sampler
            | Entity::Integrator
            | Entity::Accelerator,
            ..,
        ) => Place::Header,
        Statement::Entity(
            Entity::Material
            | Entity::MakeNamedMaterial
            | Entity::Shape
            | Entity::LightSource
            | Entity::AreaLightSource,
            ..,
        )
        | Statement::NamedMaterial(_)
        | Statement::Texture(_)
        | Statement::ReverseOrientation
        | Statement::AttributeBegin
        | Statement::AttributeEnd
        | Statement::TransformBegin
        | Statement::TransformEnd
        | Statement::ObjectBegin(_)
        | Statement::ObjectEnd
        | Statement::ObjectInstance(_)
        | Statement::Import(_) => Place::World,
        Statement::Entity(Entity::MakeNamedMedium, ..)
        | Statement::LookAt(_)
        | Statement::Translate(_)
        | Statement::Rotate(_)
        | Statement::Scale(_)
        | Statement::Transform(_)
        | Statement::ConcatTransform(_)
        | Statement::Identity
        | Statement::CoordinateSystem(_)
        | Statement::CoordSysTransform(_)
        | Statement::ActiveTransform(_)
        | Statement::TransformTimes(_)
        | Statement::Attribute(..)
        | Statement::MediumInterface(..)
        | Statement::Include(_)
        | Statement::ColorSpace(_)
        | Statement::Option(_)
        | Statement::WorldEnd => Place::Anywhere,
    }
}

/// The material of shapes that state none.
pub(super) fn default_material(span: Span) -> MaterialDesc {
    let class = &material::CLASSES[0];
    let arguments = super::material::defaults(class, span);
    MaterialDesc { name: None, class, arguments, displacement: None, normal_map: None, span }
}
