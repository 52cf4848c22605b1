//! The stable set that follows from certain signs of Λ and the zeros between them.

use crate::zero::Zero;
use crate::zeros::Signed;
use crate::{End, Interval, StableRegion};

/// The intervals between zeros, with what the lowest end is where the curve begins stable.
pub(crate) fn region(certain: &[Signed], zeros: &[Zero], from: Option<End>) -> StableRegion {
    let mut open = from;
    let mut intervals = Vec::new();
    for &zero in zeros {
        match (zero.falling, open) {
            (true, None) => open = Some(End::Zero(zero)),
            (false, Some(from)) => {
                intervals.push(Interval { from, to: End::Zero(zero) });
                open = None;
            }
            // Zeros alternate, since each is a change of sign.
            (true, Some(_)) | (false, None) => {}
        }
    }
    let last = certain.last().map_or(0.0, |last| last.sigma);
    intervals.extend(open.map(|from| Interval { from, to: End::Looked { sigma: last } }));
    StableRegion { intervals }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stable(from: Option<End>, zeros: &[(f64, bool)]) -> Vec<(f64, Option<f64>)> {
        let zeros: Vec<_> =
            zeros.iter().map(|&(sigma, falling)| Zero::exact(sigma, falling)).collect();
        let certain = [Signed { sigma: 10.0, negative: true }];
        let region = region(&certain, &zeros, from);
        region.intervals.iter().map(|interval| (interval.lower(), interval.upper())).collect()
    }

    #[test]
    fn the_stable_set_opens_at_falling_zeros_and_closes_at_rising_ones() {
        let origin = Some(End::Origin { included: false });
        assert_eq!(stable(None, &[]), []);
        assert_eq!(stable(origin, &[]), [(0.0, None)]);
        assert_eq!(stable(None, &[(8.0, true)]), [(8.0, None)]);
        assert_eq!(stable(None, &[(0.2, true), (4.6, false)]), [(0.2, Some(4.6))]);
        let twice = [(1.0, false), (2.0, true), (3.0, false), (4.0, true)];
        assert_eq!(stable(origin, &twice), [(0.0, Some(1.0)), (2.0, Some(3.0)), (4.0, None)]);
    }
}
