//! The times of orbits that go with steps of their own, and the ends of their blocks.

use crate::statistics::BLOCKS;

/// `W` orbits, each at a time of its own.
pub(super) struct Clock<const W: usize> {
    transient: f64,
    block: f64,
    time: [f64; W],
    /// When the block in progress began.
    began: [f64; W],
    /// Blocks that have ended, of which the first is the transient.
    ended: [usize; W],
}

/// A block that has ended.
pub(super) struct Ended {
    /// Which; none of the transient.
    pub block: Option<usize>,
    /// How long it took, which is its nominal time and less than a few steps.
    pub time: f64,
}

impl<const W: usize> Clock<W> {
    pub fn new([transient, block]: [f64; 2]) -> Self {
        Self { transient, block, time: [0.0; W], began: [0.0; W], ended: [0; W] }
    }

    /// Lets time pass; where all blocks have ended it stands still, and so does the orbit.
    #[inline(always)]
    pub fn advance(&mut self, h: &mut [f64; W]) {
        for lane in 0..W {
            h[lane] = if self.ended[lane] > BLOCKS { 0.0 } else { h[lane] };
            self.time[lane] += h[lane];
        }
    }

    /// The block of each orbit that has ended now.
    #[inline(always)]
    pub fn ended(&mut self) -> [Option<Ended>; W] {
        let mut all = [const { None }; W];
        for lane in 0..W {
            let ended = self.ended[lane];
            let end = self.transient + ended as f64 * self.block;
            if ended <= BLOCKS && self.time[lane] >= end {
                let time = self.time[lane] - self.began[lane];
                all[lane] = Some(Ended { block: ended.checked_sub(1), time });
                self.began[lane] = self.time[lane];
                self.ended[lane] += 1;
            }
        }
        all
    }

    pub fn is_over(&self) -> bool {
        self.ended.iter().all(|&ended| ended > BLOCKS)
    }

    pub fn earliest(&self) -> f64 {
        self.time.iter().copied().fold(f64::INFINITY, f64::min)
    }

    pub fn latest(&self) -> f64 {
        self.time.iter().copied().fold(0.0, f64::max)
    }
}
