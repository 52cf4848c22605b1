//! Disjoint sets under union, by size and with path halving (Tarjan & van Leeuwen, J. ACM 31, 245
//! (1984)).

pub(crate) struct DisjointSets {
    parent: Vec<usize>,
    size: Vec<usize>,
}

impl DisjointSets {
    pub(crate) fn new(n: usize) -> Self {
        Self { parent: (0..n).collect(), size: vec![1; n] }
    }

    /// The representative of the set that holds `i`.
    pub(crate) fn root(&mut self, mut i: usize) -> usize {
        while self.parent[i] != i {
            self.parent[i] = self.parent[self.parent[i]];
            i = self.parent[i];
        }
        i
    }

    pub(crate) fn are_joined(&mut self, i: usize, j: usize) -> bool {
        self.root(i) == self.root(j)
    }

    pub(crate) fn join(&mut self, i: usize, j: usize) {
        let (i, j) = (self.root(i), self.root(j));
        if i != j {
            let (small, large) = if self.size[i] < self.size[j] { (i, j) } else { (j, i) };
            self.parent[small] = large;
            self.size[large] += self.size[small];
        }
    }

    /// The representative of every element.
    pub(crate) fn roots(mut self) -> Vec<usize> {
        (0..self.parent.len()).map(|i| self.root(i)).collect()
    }
}
