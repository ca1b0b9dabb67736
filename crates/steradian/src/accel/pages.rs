//! Memory in large pages: a query touches a few cache lines all over the tree, and with pages of 4 KiB every other one
//! also misses the processor's table of pages.
#![expect(unsafe_code, reason = "the advice to the system has no safe interface among our dependencies")]

/// An empty vector with room for `count` elements which, where the system follows the advice, lie in large pages.
pub(super) fn reserved<T>(count: usize) -> Vec<T> {
    let values = Vec::with_capacity(count);
    advise(&values);
    values
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
}
