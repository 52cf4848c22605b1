//! Sums that several rows of an unweighted network have in common, made once for all of them.
//!
//! The nodes of a community have most of their neighbours in common: where the rows of a, b and c all
//! add x_1 + x_2, that sum becomes a term of its own. Again and again the pair of terms that stands in
//! the most rows is replaced by its sum, so that sums of sums arise, as long as that saves work.
//!
//! Source: C. Paar, Proc. IEEE ISIT, 250 (1997), where rows are those of a binary matrix.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};

/// Rows from which on a shared sum costs less than it saves: it reads two terms and writes one.
const WORTHWHILE: u32 = 5;

/// Pairs of terms up to which the search is worth its time, a second or so; larger networks have
/// their rows summed as they are.
const MOST_PAIRS: usize = 1 << 22;

/// Two terms, the smaller number first.
type Pair = [u32; 2];

/// Replaces what rows have in common by numbers from the number of rows on, and says what these
/// stand for: two numbers each, of nodes or of sums before it. Rows are, and stay, ascending.
pub(crate) fn share(rows: &mut [Vec<u32>]) -> Vec<Pair> {
    let n_pairs: usize = rows.iter().map(|row| row.len() * row.len().saturating_sub(1) / 2).sum();
    if n_pairs > MOST_PAIRS {
        return Vec::new();
    }
    let mut search = Search::new(rows);
    let mut shared = Vec::new();
    while let Some(pair) = search.most_frequent() {
        let number = rows.len() + shared.len();
        search.replace(rows, pair, u32::try_from(number).expect("numbers of terms fit 32 bits"));
        shared.push(pair);
    }
    shared
}

/// How often each pair of terms occurs.
struct Search {
    counts: HashMap<Pair, u32>,
    /// Candidates, the most frequent first, then the smallest; counts may since have fallen.
    candidates: BinaryHeap<(u32, Reverse<Pair>)>,
    /// Of each term, the rows that have, or have had, it.
    rows_of: Vec<Vec<u32>>,
}

impl Search {
    fn new(rows: &[Vec<u32>]) -> Self {
        let mut counts = HashMap::new();
        let mut rows_of = vec![Vec::new(); rows.len()];
        for (number, row) in (0u32..).zip(rows) {
            for (position, &a) in row.iter().enumerate() {
                rows_of[a as usize].push(number);
                for &b in &row[position + 1..] {
                    *counts.entry([a, b]).or_insert(0) += 1;
                }
            }
        }
        let worthwhile = counts.iter().filter(|(_, count)| **count >= WORTHWHILE);
        let candidates = worthwhile.map(|(&pair, &count)| (count, Reverse(pair))).collect();
        Self { counts, candidates, rows_of }
    }

    /// The pair that occurs most often, if that is often enough.
    fn most_frequent(&mut self) -> Option<Pair> {
        while let Some((count, Reverse(pair))) = self.candidates.pop() {
            let now = self.counts[&pair];
            if now == count {
                return Some(pair);
            }
            if now >= WORTHWHILE {
                self.candidates.push((now, Reverse(pair)));
            }
        }
        None
    }

    /// Puts the sum of a pair in its place, in every row that has both.
    fn replace(&mut self, rows: &mut [Vec<u32>], pair: Pair, sum: u32) {
        let [a, b] = pair;
        let has = |row: &Vec<u32>, term: u32| row.binary_search(&term).is_ok();
        let of_a = std::mem::take(&mut self.rows_of[a as usize]);
        let (of_both, of_a): (Vec<u32>, Vec<u32>) = of_a
            .into_iter()
            .partition(|&row| has(&rows[row as usize], a) && has(&rows[row as usize], b));
        self.rows_of[a as usize] = of_a;
        let mut with_sum: Vec<Pair> = Vec::new();
        for &number in &of_both {
            let row = &mut rows[number as usize];
            row.retain(|&term| term != a && term != b);
            for &term in row.iter() {
                for gone in pair {
                    *self.counts.get_mut(&ordered(term, gone)).expect("it was counted") -= 1;
                }
                with_sum.push([term, sum]);
            }
            row.push(sum);
        }
        self.counts.insert(pair, 0);
        self.count(with_sum);
        self.rows_of.push(of_both);
    }

    /// Counts pairs that have never been seen before.
    fn count(&mut self, mut pairs: Vec<Pair>) {
        pairs.sort_unstable();
        for same in pairs.chunk_by(|a, b| a == b) {
            let count = u32::try_from(same.len()).expect("rows are numbered in 32 bits");
            self.counts.insert(same[0], count);
            if count >= WORTHWHILE {
                self.candidates.push((count, Reverse(same[0])));
            }
        }
    }
}

fn ordered(a: u32, b: u32) -> Pair {
    [a.min(b), a.max(b)]
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// The nodes that a term stands for.
    fn nodes(term: u32, n: usize, shared: &[Pair]) -> Vec<u32> {
        match (term as usize).checked_sub(n) {
            None => vec![term],
            Some(k) => shared[k].iter().flat_map(|&term| nodes(term, n, shared)).collect(),
        }
    }

    #[test]
    fn a_complete_community_is_summed_once() {
        let mut rows: Vec<Vec<u32>> = vec![(0..8).collect(); 8];
        let shared = share(&mut rows);
        assert_eq!(shared.len(), 7);
        assert!(rows.iter().all(|row| row == &[14]));
    }

    #[test]
    fn what_few_rows_have_in_common_stays_as_it_is() {
        let mut rows = vec![vec![], vec![0, 2, 3], vec![0, 2, 3], vec![0, 2, 3]];
        let before = rows.clone();
        assert_eq!(share(&mut rows), Vec::<Pair>::new());
        assert_eq!(rows, before);
    }

    proptest! {
        #[test]
        fn every_row_still_stands_for_its_nodes_each_once_and_in_fewer_terms(
            kept in prop::collection::vec(prop::bool::weighted(0.7), 23 * 23),
        ) {
            let row = |i: u32| (0..23).filter(|&j| kept[(i * 23 + j) as usize]).collect();
            let before: Vec<Vec<u32>> = (0..23).map(row).collect();
            let mut rows = before.clone();
            let shared = share(&mut rows);
            for (row, before) in rows.iter().zip(&before) {
                prop_assert!(row.is_sorted());
                let mut of_row: Vec<u32> =
                    row.iter().flat_map(|&term| nodes(term, 23, &shared)).collect();
                of_row.sort_unstable();
                prop_assert_eq!(&of_row, before);
            }
            let terms = |rows: &[Vec<u32>]| rows.iter().map(Vec::len).sum::<usize>();
            let saved = terms(&before) - terms(&rows);
            prop_assert!(saved >= WORTHWHILE as usize * shared.len());
        }
    }
}
