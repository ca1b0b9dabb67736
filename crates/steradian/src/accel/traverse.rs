//! One ray through the tree: nearest child first, the others on a stack, instances by descending once.
#![expect(
    unsafe_code,
    reason = "the stack is not initialised: zeroing it would cost as much as short traversals"
)]

use super::contract::{Hit, InstanceId};
#[cfg(target_arch = "x86_64")]
use super::kernel::avx2::Avx2;
use super::kernel::{EXIT_SLACK, Entries, Kernel, KernelChoice, Lanes, Portable};
use super::structure::Accel;
use super::tree::{Child, Item, Owner, Packet, STACK, Target, Tree, WIDTH};
use crate::math::Ray;
use crate::shape::watertight::{Shear, Side};
use crate::shape::{PrimHit, ShapeId};
use std::mem::MaybeUninit;

/// The state of a query while it runs.
struct Query<'a, F> {
    /// Hits beyond are of no interest; shrinks to the best hit so far.
    t_max: f32,
    best: Option<Hit>,
    filter: &'a F,
}

/// Whether a query goes on.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Verdict {
    Continue,
    /// Any hit was asked for, and there is one.
    Done,
}

impl<F: Fn(&Hit) -> bool> Query<'_, F> {
    #[inline(always)]
    fn offer<const ANY: bool>(
        &mut self,
        h: PrimHit,
        owner: Owner,
        prim: u32,
        instance: Option<InstanceId>,
    ) -> Verdict {
        let shape: ShapeId = owner.shape();
        let hit = Hit { t: h.t, shape, prim, instance, u: h.u, v: h.v };
        let wins = match &self.best {
            Some(best) => hit.precedes(best),
            None => h.t < self.t_max,
        };
        if !wins || (owner.is_tested() && !(self.filter)(&hit)) {
            return Verdict::Continue;
        }
        self.t_max = h.t;
        self.best = Some(hit);
        if ANY { Verdict::Done } else { Verdict::Continue }
    }

    /// Locates the hits on the triangles that the packet test left over.
    #[inline(always)]
    fn offer_lanes<K: Kernel, const ANY: bool>(
        &mut self,
        kernel: K,
        packet: &Packet,
        lanes: Lanes,
        shear: &Shear,
        instance: Option<InstanceId>,
    ) -> Verdict {
        let mut met = lanes.met;
        while met != 0 {
            let lane = met.trailing_zeros() as usize & 3;
            met &= met - 1;
            let owner = packet.owners[lane];
            if owner == Owner::NONE {
                continue;
            }
            let side = if lanes.positive >> lane & 1 != 0 {
                Side::Positive
            } else if lanes.negative >> lane & 1 != 0 {
                Side::Negative
            } else if let Some(side) = shear.exact_side(&packet.permuted_triangle(lane, shear.axes)) {
                side
            } else {
                continue;
            };
            if let Some(h) = kernel.locate(packet, lane, shear, side, self.t_max)
                && self.offer::<ANY>(h, owner, packet.prims[lane], instance) == Verdict::Done
            {
                return Verdict::Done;
            }
        }
        Verdict::Continue
    }
}

/// A child to visit and where the ray enters it, in one word that sorts by distance: the bits of floats that are
/// not negative are ordered as they are.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Pending(u64);

impl Pending {
    #[inline(always)]
    fn new(child: Child, enter: f32) -> Self {
        Self(u64::from(enter.to_bits()) << 32 | u64::from(child.code()))
    }

    #[inline(always)]
    fn child(self) -> Child {
        Child::from_code(self.0 as u32)
    }

    #[inline(always)]
    fn enter(self) -> f32 {
        f32::from_bits((self.0 >> 32) as u32)
    }

    /// The nearer and the farther of two.
    #[inline(always)]
    fn sorted(self, other: Self) -> (Self, Self) {
        (self.min(other), self.max(other))
    }
}

/// A stack that is never read above its height. Its capacity suffices for every tree that the builder lets pass.
struct Stack {
    entries: [MaybeUninit<Pending>; STACK],
    height: usize,
}

impl Stack {
    #[inline(always)]
    fn new() -> Self {
        Self { entries: [const { MaybeUninit::uninit() }; STACK], height: 0 }
    }

    #[inline(always)]
    fn pop(&mut self) -> Option<Pending> {
        self.height = self.height.checked_sub(1)?;
        debug_assert!(self.height < STACK);
        // SAFETY: entries below the old height were written by `push`.
        Some(unsafe { self.entries.get_unchecked(self.height).assume_init() })
    }

    #[inline(always)]
    fn push(&mut self, p: Pending) {
        debug_assert!(self.height < STACK, "deeper than MAX_DEPTH");
        // SAFETY: the builder bounds the depth, so that height < STACK.
        unsafe { *self.entries.get_unchecked_mut(self.height) = MaybeUninit::new(p) };
        self.height += 1;
    }

    /// Inserts so that entries from `base` up stay sorted with the nearest on top.
    #[inline(always)]
    fn insert(&mut self, base: usize, p: Pending) {
        debug_assert!(self.height < STACK, "deeper than MAX_DEPTH");
        let mut at = self.height;
        // SAFETY: the builder bounds the depth, so that height < STACK; entries below the height are initialised.
        unsafe {
            while at > base && self.entries.get_unchecked(at - 1).assume_init() < p {
                *self.entries.get_unchecked_mut(at) = *self.entries.get_unchecked(at - 1);
                at -= 1;
            }
            *self.entries.get_unchecked_mut(at) = MaybeUninit::new(p);
        }
        self.height += 1;
    }
}

/// Traverses the world (`TOP`, the level at which instances may occur) or one object's tree.
///
/// Always inlined: the entry points below fix the kernel and its instruction set.
#[inline(always)]
fn trace<K: Engine, const ANY: bool, const TOP: bool, F: Fn(&Hit) -> bool>(
    kernel: K,
    accel: &Accel,
    tree: &Tree,
    ray: &Ray,
    instance: Option<InstanceId>,
    query: &mut Query<'_, F>,
) -> Verdict {
    let Some(bounds) = &tree.bounds else { return Verdict::Continue };
    let Some((box_ray, shear)) = kernel.prepare(ray, bounds) else {
        return kernel.unprepared::<ANY, TOP, F>(accel, tree, ray, instance, query);
    };
    let mut entries = Entries([0.0; WIDTH]);
    let mut stack = Stack::new();
    stack.push(Pending::new(Child::ROOT, 0.0));
    'pop: while let Some(pending) = stack.pop() {
        // With the slack of the box test: rounding must not hide an equally near hit.
        if !ANY && pending.enter() > query.t_max * EXIT_SLACK {
            continue;
        }
        let mut current = pending.child();
        let leaf = loop {
            let index = match current.target() {
                Target::Inner(index) => index,
                leaf => break leaf,
            };
            // SAFETY: the builder refers only to nodes that it has made.
            let node = unsafe { tree.nodes.get_unchecked(index as usize) };
            let mut mask = kernel.boxes(node, &box_ray, query.t_max, &mut entries);
            if mask == 0 {
                continue 'pop;
            }
            let child = |mask: u32| node.children[mask.trailing_zeros() as usize & 7];
            let pending = |mask: u32| {
                let child = child(mask);
                kernel.prefetch(tree, child);
                Pending::new(child, entries.0[mask.trailing_zeros() as usize & 7])
            };
            let first = mask;
            mask &= mask - 1;
            if mask == 0 {
                current = child(first);
                continue;
            }
            if ANY {
                // Any hit will do, and most rays that ask for one have none: the order is not worth a sort.
                while mask != 0 {
                    stack.push(Pending::new(child(mask), 0.0));
                    mask &= mask - 1;
                }
                current = child(first);
                continue;
            }
            // Which children are hit is hard to foretell for the processor: few branches, and sorting without any.
            let (a, b) = pending(first).sorted(pending(mask));
            mask &= mask - 1;
            if mask == 0 {
                stack.push(b);
                current = a.child();
                continue;
            }
            let c = pending(mask);
            mask &= mask - 1;
            let (a, c) = a.sorted(c);
            let (b, c) = b.sorted(c);
            let base = stack.height;
            stack.push(c);
            stack.push(b);
            let mut nearest = a;
            while mask != 0 {
                let (near, far) = nearest.sorted(pending(mask));
                mask &= mask - 1;
                stack.insert(base, far);
                nearest = near;
            }
            current = nearest.child();
        };
        let (first, count) = match leaf {
            Target::Inner(_) => continue,
            Target::Packets { first, count } => (first, count),
            Target::Item(index) => {
                let item = &tree.items[index as usize];
                if visit_item::<K, ANY, TOP, F>(kernel, accel, item, ray, instance, query) == Verdict::Done {
                    return Verdict::Done;
                }
                continue;
            }
            Target::Bunch(index) => {
                if kernel.visit_bunch::<ANY, F>(tree, index, ray, instance, query) == Verdict::Done {
                    return Verdict::Done;
                }
                continue;
            }
        };
        for index in first..first + count {
            // SAFETY: the builder refers only to packets that it has made.
            let packet = unsafe { tree.packets.get_unchecked(index as usize) };
            let lanes = kernel.triangles(packet, &shear, query.t_max);
            if ANY && lanes.certain != 0 {
                return Verdict::Done;
            }
            if lanes.met != 0
                && kernel.offer_lanes::<ANY, F>(query, packet, lanes, &shear, instance) == Verdict::Done
            {
                return Verdict::Done;
            }
        }
    }
    Verdict::Continue
}

/// Intersects what lies alone in a leaf. Out of line, as [`Query::offer_lanes`].
#[inline(never)]
fn visit_item<K: Engine, const ANY: bool, const TOP: bool, F: Fn(&Hit) -> bool>(
    kernel: K,
    accel: &Accel,
    item: &Item,
    ray: &Ray,
    instance: Option<InstanceId>,
    query: &mut Query<'_, F>,
) -> Verdict {
    match item {
        Item::Prim { owner, prim, primitive } => match primitive.intersect(ray, query.t_max) {
            Some(h) => query.offer::<ANY>(h, *owner, *prim, instance),
            None => Verdict::Continue,
        },
        Item::Instance(id) if TOP => {
            let placed = &accel.instances[id.0 as usize];
            let object = &accel.objects[placed.object.0 as usize];
            let object_ray = placed.object_ray(ray);
            kernel.run::<ANY, false, F>(accel, object, &object_ray, Some(*id), query)
        }
        Item::Instance(_) => Verdict::Continue,
    }
}

/// Intersects the curves of a bunch that the ray may meet.
#[inline(always)]
fn visit_bunch<const ANY: bool, F: Fn(&Hit) -> bool>(
    tree: &Tree,
    index: u32,
    ray: &Ray,
    instance: Option<InstanceId>,
    query: &mut Query<'_, F>,
) -> Verdict {
    let near = tree.bunches[index as usize].near(ray, query.t_max);
    if near.is_empty() {
        return Verdict::Continue;
    }
    let members = tree.members[index as usize];
    for lane in near.take_while(|lane| *lane < members.count) {
        if let Item::Prim { owner, prim, primitive } = &tree.items[(members.first + lane) as usize]
            && let Some(h) = primitive.intersect(ray, query.t_max)
            && query.offer::<ANY>(h, *owner, *prim, instance) == Verdict::Done
        {
            return Verdict::Done;
        }
    }
    Verdict::Continue
}

/// A kernel with a traversal compiled for its instruction set.
trait Engine: Kernel {
    fn run<const ANY: bool, const TOP: bool, F: Fn(&Hit) -> bool>(
        self,
        accel: &Accel,
        tree: &Tree,
        ray: &Ray,
        instance: Option<InstanceId>,
        query: &mut Query<'_, F>,
    ) -> Verdict;

    /// [`Query::offer_lanes`], out of line: inlined, its numbers push those of the box test out of the registers.
    fn offer_lanes<const ANY: bool, F: Fn(&Hit) -> bool>(
        self,
        query: &mut Query<'_, F>,
        packet: &Packet,
        lanes: Lanes,
        shear: &Shear,
        instance: Option<InstanceId>,
    ) -> Verdict;

    /// [`visit_bunch`], out of line.
    fn visit_bunch<const ANY: bool, F: Fn(&Hit) -> bool>(
        self,
        tree: &Tree,
        index: u32,
        ray: &Ray,
        instance: Option<InstanceId>,
        query: &mut Query<'_, F>,
    ) -> Verdict;

    /// What becomes of a ray that [`Kernel::prepare`] refuses.
    fn unprepared<const ANY: bool, const TOP: bool, F: Fn(&Hit) -> bool>(
        self,
        accel: &Accel,
        tree: &Tree,
        ray: &Ray,
        instance: Option<InstanceId>,
        query: &mut Query<'_, F>,
    ) -> Verdict;
}

impl Engine for Portable {
    fn run<const ANY: bool, const TOP: bool, F: Fn(&Hit) -> bool>(
        self,
        accel: &Accel,
        tree: &Tree,
        ray: &Ray,
        instance: Option<InstanceId>,
        query: &mut Query<'_, F>,
    ) -> Verdict {
        trace::<Self, ANY, TOP, F>(self, accel, tree, ray, instance, query)
    }

    #[inline(never)]
    fn offer_lanes<const ANY: bool, F: Fn(&Hit) -> bool>(
        self,
        query: &mut Query<'_, F>,
        packet: &Packet,
        lanes: Lanes,
        shear: &Shear,
        instance: Option<InstanceId>,
    ) -> Verdict {
        query.offer_lanes::<Self, ANY>(self, packet, lanes, shear, instance)
    }

    #[inline(never)]
    fn visit_bunch<const ANY: bool, F: Fn(&Hit) -> bool>(
        self,
        tree: &Tree,
        index: u32,
        ray: &Ray,
        instance: Option<InstanceId>,
        query: &mut Query<'_, F>,
    ) -> Verdict {
        visit_bunch::<ANY, F>(tree, index, ray, instance, query)
    }

    fn unprepared<const ANY: bool, const TOP: bool, F: Fn(&Hit) -> bool>(
        self,
        _accel: &Accel,
        _tree: &Tree,
        _ray: &Ray,
        _instance: Option<InstanceId>,
        _query: &mut Query<'_, F>,
    ) -> Verdict {
        Verdict::Continue
    }
}

#[cfg(target_arch = "x86_64")]
impl Engine for Avx2 {
    #[inline]
    fn run<const ANY: bool, const TOP: bool, F: Fn(&Hit) -> bool>(
        self,
        accel: &Accel,
        tree: &Tree,
        ray: &Ray,
        instance: Option<InstanceId>,
        query: &mut Query<'_, F>,
    ) -> Verdict {
        #[target_feature(enable = "avx2,fma")]
        fn compiled<const ANY: bool, const TOP: bool, F: Fn(&Hit) -> bool>(
            kernel: Avx2,
            accel: &Accel,
            tree: &Tree,
            ray: &Ray,
            instance: Option<InstanceId>,
            query: &mut Query<'_, F>,
        ) -> Verdict {
            trace::<Avx2, ANY, TOP, F>(kernel, accel, tree, ray, instance, query)
        }
        // SAFETY: a value of `Avx2` exists only where AVX2 was detected.
        unsafe { compiled::<ANY, TOP, F>(self, accel, tree, ray, instance, query) }
    }

    #[inline(always)]
    fn offer_lanes<const ANY: bool, F: Fn(&Hit) -> bool>(
        self,
        query: &mut Query<'_, F>,
        packet: &Packet,
        lanes: Lanes,
        shear: &Shear,
        instance: Option<InstanceId>,
    ) -> Verdict {
        #[inline(never)]
        #[target_feature(enable = "avx2,fma")]
        fn compiled<const ANY: bool, F: Fn(&Hit) -> bool>(
            kernel: Avx2,
            query: &mut Query<'_, F>,
            packet: &Packet,
            lanes: Lanes,
            shear: &Shear,
            instance: Option<InstanceId>,
        ) -> Verdict {
            query.offer_lanes::<Avx2, ANY>(kernel, packet, lanes, shear, instance)
        }
        // SAFETY: a value of `Avx2` exists only where AVX2 and FMA were detected.
        unsafe { compiled::<ANY, F>(self, query, packet, lanes, shear, instance) }
    }

    #[inline(always)]
    fn visit_bunch<const ANY: bool, F: Fn(&Hit) -> bool>(
        self,
        tree: &Tree,
        index: u32,
        ray: &Ray,
        instance: Option<InstanceId>,
        query: &mut Query<'_, F>,
    ) -> Verdict {
        #[inline(never)]
        #[target_feature(enable = "avx2,fma")]
        fn compiled<const ANY: bool, F: Fn(&Hit) -> bool>(
            tree: &Tree,
            index: u32,
            ray: &Ray,
            instance: Option<InstanceId>,
            query: &mut Query<'_, F>,
        ) -> Verdict {
            visit_bunch::<ANY, F>(tree, index, ray, instance, query)
        }
        // SAFETY: a value of `Avx2` exists only where AVX2 and FMA were detected.
        unsafe { compiled::<ANY, F>(tree, index, ray, instance, query) }
    }

    #[cold]
    fn unprepared<const ANY: bool, const TOP: bool, F: Fn(&Hit) -> bool>(
        self,
        accel: &Accel,
        tree: &Tree,
        ray: &Ray,
        instance: Option<InstanceId>,
        query: &mut Query<'_, F>,
    ) -> Verdict {
        Portable.run::<ANY, TOP, F>(accel, tree, ray, instance, query)
    }
}

/// The nearest hit of `ray` with 0 < t < `t_max` in the world.
#[inline]
pub(super) fn nearest<F: Fn(&Hit) -> bool>(accel: &Accel, ray: &Ray, t_max: f32, filter: &F) -> Option<Hit> {
    let mut query = Query { t_max, best: None, filter };
    start::<false, F>(accel, ray, &mut query);
    query.best
}

/// Whether `ray` hits anything with 0 < t < `t_max` in the world.
#[inline]
pub(super) fn any<F: Fn(&Hit) -> bool>(accel: &Accel, ray: &Ray, t_max: f32, filter: &F) -> bool {
    start::<true, F>(accel, ray, &mut Query { t_max, best: None, filter }) == Verdict::Done
}

#[inline(always)]
fn start<const ANY: bool, F: Fn(&Hit) -> bool>(
    accel: &Accel,
    ray: &Ray,
    query: &mut Query<'_, F>,
) -> Verdict {
    match accel.kernel {
        KernelChoice::Portable => Portable.run::<ANY, true, F>(accel, &accel.world, ray, None, query),
        #[cfg(target_arch = "x86_64")]
        KernelChoice::Avx2(k) => k.run::<ANY, true, F>(accel, &accel.world, ray, None, query),
    }
}
