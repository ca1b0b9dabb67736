//! Work on tiles by all threads, in any order, with the same result.

use std::sync::{Mutex, PoisonError};

/// The order in which tiles are handed out; the picture does not depend on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TileOrder {
    /// Row by row from the top.
    #[default]
    Scanline,
    /// Row by row from the bottom.
    Reverse,
    /// Every k-th tile, k near √n: spreads early work over the picture.
    Strided,
}

impl TileOrder {
    /// The permutation of 0..n in which tiles are handed out.
    pub fn permutation(self, n: usize) -> Vec<usize> {
        match self {
            Self::Scanline => (0..n).collect(),
            Self::Reverse => (0..n).rev().collect(),
            Self::Strided => {
                let stride = n.isqrt().max(1);
                (0..stride).flat_map(|first| (first..n).step_by(stride)).collect()
            }
        }
    }
}

/// Calls `work` once on each item, on `threads` threads, each with a state of its own made by `state`.
///
/// Items are taken from one queue, so that threads which meet expensive tiles take fewer of them.
/// Returns the states, one per thread. A panic in `work` is passed on once all threads have stopped.
pub(crate) fn for_each<T: Send, S: Send>(
    items: &mut [T],
    order: TileOrder,
    threads: usize,
    state: impl Fn() -> S + Sync,
    work: impl Fn(&mut S, &mut T) + Sync,
) -> Vec<S> {
    let mut slots: Vec<Option<&mut T>> = items.iter_mut().map(Some).collect();
    let permutation = order.permutation(slots.len());
    let queue = Mutex::new(permutation.into_iter().filter_map(|i| slots[i].take()));
    let run = || {
        let mut own = state();
        loop {
            // One lock per tile of thousands of samples. The iterator stays valid if another thread panicked.
            let next = queue.lock().unwrap_or_else(PoisonError::into_inner).next();
            match next {
                Some(item) => work(&mut own, item),
                None => return own,
            }
        }
    };
    std::thread::scope(|scope| {
        let others: Vec<_> = (1..threads.max(1)).map(|_| scope.spawn(run)).collect();
        let mut states = vec![run()];
        for handle in others {
            match handle.join() {
                Ok(own) => states.push(own),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        states
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_order_is_a_permutation_and_every_item_is_visited_once() {
        for order in [TileOrder::Scanline, TileOrder::Reverse, TileOrder::Strided] {
            for (n, threads) in [(0, 1), (1, 4), (37, 3)] {
                let mut items = vec![0; n];
                let states = for_each(
                    &mut items,
                    order,
                    threads,
                    || 0,
                    |count, item| {
                        *item += 1;
                        *count += 1;
                    },
                );
                assert!(items.iter().all(|&i| i == 1), "{order:?} {n}");
                assert_eq!(states.iter().sum::<usize>(), n);
            }
        }
    }
}
