//! The order of elimination where few nodes cut a network in halves: each half by approximate minimum
//! degree, then the cut. The halves are ordered, and systems of equations solved, side by side, while
//! minimum degree alone would eliminate a ring node after node.
//!
//! Source: A. George, SIAM J. Numer. Anal. 10, 345 (1973), one level of it.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::perm::Perm;
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;
use graph::Components;

/// A half that nodes belong to, or the cut.
#[derive(Clone, Copy, PartialEq)]
enum Side {
    Unknown,
    Half(u8),
    Cut,
}

/// Which node is eliminated first, second, …; none where the order cannot be found.
///
/// - `pattern`: a symmetric pattern.
pub(crate) fn order(pattern: SymbolicSparseColMatRef<'_, u32>, cut: &[u32]) -> Option<Perm<u32>> {
    let sides = sides(pattern, cut);
    let half = |half| {
        let nodes = (0..pattern.ncols() as u32).filter(|&i| sides[i as usize] == Side::Half(half));
        by_minimum_degree(pattern, &nodes.collect::<Vec<u32>>())
    };
    let (first, second) = rayon::join(|| half(0), || half(1));
    let order = [first?, second?, cut.to_vec()].concat();
    let mut inverse = vec![0; order.len()];
    (0..).zip(&order).for_each(|(k, &node)| inverse[node as usize] = k);
    let n_rows = order.len();
    Some(Perm::new_checked(order.into_boxed_slice(), inverse.into_boxed_slice(), n_rows))
}

/// The side of every node: what the cut leaves connected stays together.
fn sides(pattern: SymbolicSparseColMatRef<'_, u32>, cut: &[u32]) -> Vec<Side> {
    let mut sides = vec![Side::Unknown; pattern.ncols()];
    cut.iter().for_each(|&node| sides[node as usize] = Side::Cut);
    let neighbours = |node| pattern.row_idx_of_col_raw(node);
    let is_left = |node: usize| sides[node] != Side::Cut;
    let mut parts = Components::among(pattern.ncols(), neighbours, is_left).nodes();
    parts.sort_by_key(|part| std::cmp::Reverse(part.len()));
    let mut sizes = [0, 0];
    for part in parts {
        let half = usize::from(sizes[1] < sizes[0]);
        sizes[half] += part.len();
        part.iter().for_each(|&node| sides[node] = Side::Half(half as u8));
    }
    sides
}

/// Some of the nodes, ascending, in the order of approximate minimum degree.
fn by_minimum_degree(pattern: SymbolicSparseColMatRef<'_, u32>, nodes: &[u32]) -> Option<Vec<u32>> {
    let mut place = vec![u32::MAX; pattern.ncols()];
    (0..).zip(nodes).for_each(|(k, &node)| place[node as usize] = k);
    let (mut starts, mut rows) = (vec![0], Vec::new());
    for &node in nodes {
        let neighbours = pattern.row_idx_of_col_raw(node as usize).iter();
        rows.extend(neighbours.map(|&j| place[j as usize]).filter(|&j| j != u32::MAX));
        starts.push(rows.len() as u32);
    }
    let n = nodes.len();
    let inside = SymbolicSparseColMatRef::new_checked(n, n, &starts, None, &rows);
    let (mut order, mut inverse) = (vec![0; n], vec![0; n]);
    let mut memory = MemBuffer::new(amd::order_scratch::<u32>(n, rows.len()));
    let stack = MemStack::new(&mut memory);
    amd::order(&mut order, &mut inverse, inside, Default::default(), stack).ok()?;
    Some(order.into_iter().map(|k| nodes[k as usize]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ring_is_eliminated_half_by_half_and_the_cut_last() {
        let n = 40u32;
        let starts: Vec<u32> = (0..=n).map(|i| 2 * i).collect();
        let rows: Vec<u32> = (0..n)
            .flat_map(|i| {
                let (before, after) = ((i + n - 1) % n, (i + 1) % n);
                [before.min(after), before.max(after)]
            })
            .collect();
        let n = n as usize;
        let ring = SymbolicSparseColMatRef::new_checked(n, n, &starts, None, &rows);
        let order = order(ring, &[7, 27]).unwrap();
        let order = order.as_ref().arrays().0.to_vec();
        assert_eq!(order[38..], [7, 27]);
        let is_first = |&i: &u32| (8..27).contains(&i);
        assert!(order[..19].iter().all(is_first) || !order[..19].iter().any(is_first), "{order:?}");
        let mut sorted = order;
        sorted.sort_unstable();
        assert!(sorted.into_iter().eq(0..40));
    }
}
