//! Work around queries, compiled for the instructions that the queries use.
#![expect(unsafe_code, reason = "a function compiled for instructions that the processor was found to have")]

use super::kernel::KernelChoice;
use super::structure::Accel;

/// Something to do that gains from wide registers where the processor has them.
///
/// What is inlined into `run` is compiled for each set of instructions. The results have the same bits on all of them:
/// no multiplication is fused with an addition that is not written so.
pub trait Work {
    /// What comes of it.
    type Output;

    /// Does it. To be marked `#[inline(always)]`.
    fn run(self) -> Self::Output;
}

impl Accel {
    /// Does `work` with the instructions that the queries use.
    #[inline]
    pub fn work<W: Work>(&self, work: W) -> W::Output {
        match self.kernel {
            KernelChoice::Portable => work.run(),
            #[cfg(target_arch = "x86_64")]
            KernelChoice::Avx2(_) => {
                #[target_feature(enable = "avx2")]
                fn compiled<W: Work>(work: W) -> W::Output {
                    work.run()
                }
                // SAFETY: the kernel is chosen only where AVX2 was detected.
                unsafe { compiled(work) }
            }
        }
    }
}
