//! One ray through the tree: nearest child first, the others on a stack, instances by descending once.
#![expect(
    unsafe_code,
    reason = "the stack is not initialised: zeroing it would cost as much as short traversals"
)]

use super::contract::{Hit, InstanceId};
#[cfg(target_arch = "x86_64")]
use super::kernel::avx2::Avx2;
use super::kernel::{BoxRay, Entries, Kernel, KernelChoice, Portable};
use super::structure::Accel;
use super::tree::{Child, Item, Owner, STACK, Target, Tree, WIDTH};
use crate::math::Ray;
use crate::shape::{PrimHit, ShapeId, watertight::Shear};
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
}

#[derive(Clone, Copy)]
struct Pending {
    child: Child,
    enter: f32,
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
        // SAFETY: entries below the old height were written by `insert`.
        Some(unsafe { self.entries.get_unchecked(self.height).assume_init() })
    }

    /// Inserts so that entries from `base` up stay sorted with the nearest on top.
    #[inline(always)]
    fn insert(&mut self, base: usize, p: Pending) {
        debug_assert!(self.height < STACK, "deeper than MAX_DEPTH");
        let mut at = self.height;
        // SAFETY: the builder bounds the depth, so that height < STACK; entries below the height are initialised.
        unsafe {
            while at > base && self.entries.get_unchecked(at - 1).assume_init().enter < p.enter {
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
    // A NaN passes every box, empty slots included: the stack would overflow. Paths reach such places in scenes whose
    // numbers are near the end of the range of floats.
    if !(ray.o.is_finite() && ray.d.is_finite()) {
        return Verdict::Continue;
    }
    let box_ray = BoxRay::new(ray);
    let shear = Shear::new(ray);
    let mut entries = Entries([0.0; WIDTH]);
    let mut stack = Stack::new();
    stack.insert(0, Pending { child: Child::ROOT, enter: 0.0 });
    'pop: while let Some(Pending { child, enter }) = stack.pop() {
        if enter > query.t_max {
            continue;
        }
        let mut current = child;
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
            let first = mask.trailing_zeros() as usize & 7;
            mask &= mask - 1;
            let mut nearest = Pending { child: node.children[first], enter: entries.0[first] };
            let base = stack.height;
            while mask != 0 {
                let i = mask.trailing_zeros() as usize & 7;
                mask &= mask - 1;
                let mut other = Pending { child: node.children[i], enter: entries.0[i] };
                if other.enter < nearest.enter {
                    std::mem::swap(&mut other, &mut nearest);
                }
                stack.insert(base, other);
            }
            current = nearest.child;
            if stack.height > base
                && let Target::Inner(index) = current.target()
            {
                // SAFETY: as above.
                kernel.prefetch(unsafe { tree.nodes.get_unchecked(index as usize) });
            }
        };
        let (first, count, mixed) = match leaf {
            Target::Inner(_) => continue,
            Target::Packets { first, count } => (first, count, None),
            Target::Mixed(index) => {
                let leaf = &tree.mixed[index as usize];
                (leaf.first_packet, leaf.packet_count, Some(leaf))
            }
        };
        for index in first..first + count {
            // SAFETY: the builder refers only to packets that it has made.
            let packet = unsafe { tree.packets.get_unchecked(index as usize) };
            let mut mask = kernel.triangles(packet, &shear, query.t_max);
            while mask != 0 {
                let lane = mask.trailing_zeros() as usize & 3;
                mask &= mask - 1;
                let owner = packet.owners[lane];
                if owner == Owner::NONE {
                    continue;
                }
                if let Some(h) =
                    shear.intersect_permuted(packet.permuted_triangle(lane, shear.axes), query.t_max)
                    && query.offer::<ANY>(h, owner, packet.prims[lane], instance) == Verdict::Done
                {
                    return Verdict::Done;
                }
            }
        }
        let Some(mixed) = mixed else { continue };
        for item in &tree.items[mixed.first_item as usize..(mixed.first_item + mixed.item_count) as usize] {
            let verdict = match item {
                Item::Prim { owner, prim, primitive } => match primitive.intersect(ray, query.t_max) {
                    Some(h) => query.offer::<ANY>(h, *owner, *prim, instance),
                    None => Verdict::Continue,
                },
                Item::Instance(id) if TOP => {
                    let placed = &accel.instances[id.0 as usize];
                    let object = &accel.objects[placed.object.0 as usize];
                    let object_ray = placed.object_ray(ray);
                    descend::<K, ANY, F>(kernel, accel, object, &object_ray, *id, query)
                }
                Item::Instance(_) => Verdict::Continue,
            };
            if verdict == Verdict::Done {
                return Verdict::Done;
            }
        }
    }
    Verdict::Continue
}

/// The traversal of an instance's object, kept out of line so that scenes without instances do not pay for it.
#[inline(never)]
fn descend<K: Engine, const ANY: bool, F: Fn(&Hit) -> bool>(
    kernel: K,
    accel: &Accel,
    tree: &Tree,
    ray: &Ray,
    instance: InstanceId,
    query: &mut Query<'_, F>,
) -> Verdict {
    kernel.run::<ANY, false, F>(accel, tree, ray, Some(instance), query)
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
        #[target_feature(enable = "avx2")]
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
}

/// The nearest (or, for `ANY`, some) hit of `ray` with 0 < t < `t_max` in the world.
#[inline]
pub(super) fn query<const ANY: bool, F: Fn(&Hit) -> bool>(
    accel: &Accel,
    ray: &Ray,
    t_max: f32,
    filter: &F,
) -> Option<Hit> {
    let mut query = Query { t_max, best: None, filter };
    match accel.kernel {
        KernelChoice::Portable => Portable.run::<ANY, true, F>(accel, &accel.world, ray, None, &mut query),
        #[cfg(target_arch = "x86_64")]
        KernelChoice::Avx2(k) => k.run::<ANY, true, F>(accel, &accel.world, ray, None, &mut query),
    };
    query.best
}
