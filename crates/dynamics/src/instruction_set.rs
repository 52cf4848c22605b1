//! Which vector instructions a kernel uses, chosen when the program runs.
//!
//! Kernels are written once, in plain Rust, and compiled once for each set; the sets differ in how
//! many numbers one instruction takes. None contracts a·b + c into one rounding, so that all give the
//! same bits.

/// The vector instructions that a kernel is compiled for, from the least to the most.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InstructionSet {
    /// What every processor of the architecture has: on x86-64, SSE2 with two doubles at a time.
    Baseline,
    /// AVX2, four doubles at a time.
    Avx2,
    /// AVX-512 (F, VL, DQ, BW), eight doubles at a time.
    Avx512,
}

/// Work with loops worth compiling for each instruction set.
///
/// Only what is inlined into [`Work::run`] is compiled so: mark it, and all that it calls,
/// `#[inline(always)]`.
pub trait Work {
    /// What comes out.
    type Output;

    /// Does the work.
    fn run(self) -> Self::Output;
}

impl InstructionSet {
    const ALL: [Self; 3] = [Self::Baseline, Self::Avx2, Self::Avx512];

    /// The sets that this processor has, from the least to the most.
    pub fn available() -> Vec<Self> {
        Self::ALL.into_iter().filter(|set| set.is_available()).collect()
    }

    /// The most that this processor has.
    pub fn best() -> Self {
        *Self::available().last().expect("the baseline is always there")
    }

    /// Its name in records.
    pub fn name(self) -> &'static str {
        match self {
            Self::Baseline if cfg!(target_arch = "x86_64") => "x86-64",
            Self::Baseline => std::env::consts::ARCH,
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
        }
    }

    /// Whether this processor has it.
    pub fn is_available(self) -> bool {
        #[cfg(target_arch = "x86_64")]
        match self {
            Self::Baseline => true,
            Self::Avx2 => is_x86_feature_detected!("avx2"),
            Self::Avx512 => {
                is_x86_feature_detected!("avx512f")
                    && is_x86_feature_detected!("avx512vl")
                    && is_x86_feature_detected!("avx512dq")
                    && is_x86_feature_detected!("avx512bw")
            }
        }
        #[cfg(not(target_arch = "x86_64"))]
        {
            self == Self::Baseline
        }
    }

    /// Does work with these instructions.
    ///
    /// # Panics
    /// When this processor does not have them.
    pub fn run<W: Work>(self, work: W) -> W::Output {
        assert!(self.is_available(), "this processor does not have {}", self.name());
        #[cfg(target_arch = "x86_64")]
        {
            wrappers::run(self, work)
        }
        #[cfg(not(target_arch = "x86_64"))]
        {
            work.run()
        }
    }
}

/// The only unsafe code of the crate: calls of functions compiled for instructions that not every
/// processor has. Such a call is sound when the processor has them, and the one caller of
/// [`wrappers::run`] has asked the processor just before.
#[cfg(target_arch = "x86_64")]
#[allow(unsafe_code)]
mod wrappers {
    use super::{InstructionSet, Work};

    pub(super) fn run<W: Work>(available: InstructionSet, work: W) -> W::Output {
        match available {
            InstructionSet::Baseline => work.run(),
            // SAFETY: the set is available, and it names every feature that the function enables.
            InstructionSet::Avx2 => unsafe { with_avx2(work) },
            // SAFETY: as above.
            InstructionSet::Avx512 => unsafe { with_avx512(work) },
        }
    }

    #[target_feature(enable = "avx2")]
    fn with_avx2<W: Work>(work: W) -> W::Output {
        work.run()
    }

    #[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw")]
    fn with_avx512<W: Work>(work: W) -> W::Output {
        work.run()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Sum<'a>(&'a [f64]);

    impl Work for Sum<'_> {
        type Output = f64;

        #[inline(always)]
        fn run(self) -> f64 {
            self.0.iter().sum()
        }
    }

    #[test]
    fn every_available_set_does_the_work_and_the_best_is_one_of_them() {
        let numbers = [0.1, 0.2, 0.3];
        for set in InstructionSet::available() {
            assert_eq!(set.run(Sum(&numbers)), numbers.iter().sum(), "{}", set.name());
        }
        assert!(InstructionSet::available().contains(&InstructionSet::best()));
        assert!(InstructionSet::Baseline.is_available());
    }
}
