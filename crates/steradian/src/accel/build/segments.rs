//! Lists laid end to end: which of them holds the element of a given number.

/// Where each of several lists begins in their concatenation.
#[derive(Debug)]
pub(super) struct Segments(Vec<usize>);

/// An element's list and its place there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Located {
    pub(super) list: usize,
    pub(super) index: usize,
}

impl Segments {
    pub(super) fn new(lengths: impl Iterator<Item = usize>) -> Self {
        let mut starts = vec![0];
        let mut sum = 0;
        starts.extend(lengths.map(|n| {
            sum += n;
            sum
        }));
        Self(starts)
    }

    pub(super) fn total(&self) -> usize {
        self.0.last().copied().unwrap_or(0)
    }

    pub(super) fn start(&self, list: usize) -> usize {
        self.0[list]
    }

    /// Finds element `i` < total; `hint` is the list of the element asked for before, which is most often the answer.
    #[inline]
    pub(super) fn locate(&self, i: usize, hint: &mut usize) -> Located {
        let holds = |list: usize| self.0[list] <= i && self.0.get(list + 1).is_some_and(|&end| i < end);
        if !holds(*hint) {
            *hint = self.0.partition_point(|&start| start <= i).saturating_sub(1);
        }
        Located { list: *hint, index: i - self.0[*hint] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_are_found_across_empty_lists() {
        let lengths = [0, 3, 0, 0, 2, 1, 0];
        let s = Segments::new(lengths.into_iter());
        assert_eq!(s.total(), 6);
        let expected: Vec<Located> = lengths
            .iter()
            .enumerate()
            .flat_map(|(list, &n)| (0..n).map(move |index| Located { list, index }))
            .collect();
        let mut hint = 0;
        let found: Vec<Located> = (0..6).map(|i| s.locate(i, &mut hint)).collect();
        assert_eq!(found, expected);
        assert_eq!((0..6).rev().map(|i| s.locate(i, &mut hint)).rev().collect::<Vec<_>>(), expected);
    }
}
