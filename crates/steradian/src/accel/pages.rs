//! Memory in large pages: a query touches a few cache lines all over the tree, and with pages of 4 KiB every other one
//! also misses the processor's table of pages.
//!
//! The system clears a page before it gives it away, which costs as much as to fill it: what has served is used again.
#![expect(unsafe_code, reason = "the advice to the system has no safe interface among our dependencies")]

use bytemuck::{Pod, Zeroable};

/// An empty vector with room for `count` elements which, where the system follows the advice, lie in large pages.
pub(super) fn reserved<T>(count: usize) -> Vec<T> {
    let values = Vec::with_capacity(count);
    advise(&values);
    values
}

/// `count` elements of zero bytes in such pages. Where the system hands out zeros, what is not used takes no memory.
pub(super) fn zeroed<T: Zeroable>(count: usize) -> Vec<T> {
    let values = bytemuck::zeroed_vec(count);
    advise(&values);
    values
}

/// The memory of `values` as elements of another type, from the first place on that suits them: all that its bytes hold
/// but for one, perhaps.
pub(super) fn lent<T: Pod, U: Pod>(values: &mut [T]) -> &mut [U] {
    let bytes: &mut [u8] = bytemuck::cast_slice_mut(values);
    let begin = bytes.as_ptr().addr();
    let skipped = begin.next_multiple_of(align_of::<U>()) - begin;
    let aligned = bytes.get_mut(skipped..).unwrap_or_default();
    let used = aligned.len() / size_of::<U>() * size_of::<U>();
    bytemuck::cast_slice_mut(&mut aligned[..used])
}

#[cfg(target_os = "linux")]
fn advise<T>(values: &Vec<T>) {
    const LARGE: usize = 2 << 20;
    let begin = values.as_ptr().addr();
    let end = begin + values.capacity() * size_of::<T>();
    let (first, last) = (begin.next_multiple_of(LARGE), end / LARGE * LARGE);
    if first >= last {
        return;
    }
    let address = values.as_ptr().cast::<libc::c_void>().wrapping_byte_add(first - begin).cast_mut();
    // SAFETY: the range lies within the vector's allocation; the advice changes how its pages are backed, never what is
    // in them, and may be refused.
    unsafe { libc::madvise(address, last - first, libc::MADV_HUGEPAGE) };
}

#[cfg(not(target_os = "linux"))]
fn advise<T>(_values: &Vec<T>) {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn advised_memory_holds_what_is_put_there() {
        for count in [0, 3, 1 << 20] {
            let mut v = reserved::<u64>(count);
            assert!(v.is_empty() && v.capacity() >= count);
            v.extend((0..count as u64).map(|i| i * i));
            assert!(v.iter().enumerate().all(|(i, x)| *x == (i * i) as u64));
        }
    }

    #[test]
    fn lent_memory_is_aligned_and_nearly_all_of_it() {
        let mut bytes = zeroed::<u8>(1000);
        for first in 0..16 {
            let lent = lent::<u8, u64>(&mut bytes[first..]);
            assert!(lent.as_ptr().is_aligned() && lent.len() >= (1000 - first) / 8 - 1);
            assert!(first > 0 || lent.iter().all(|x| *x == 0));
            lent.fill(u64::MAX);
        }
        assert!(bytes[16..984].iter().all(|x| *x == 255));
    }
}
