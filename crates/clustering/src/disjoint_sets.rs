//! Disjoint sets under union, by size and with path halving (Tarjan & van Leeuwen, J. ACM 31, 245
//! (1984)), and many such families side by side over the same elements.

/// Disjoint sets of fewer than 2³² elements.
pub(crate) struct DisjointSets {
    parent: Vec<u32>,
    size: Vec<u32>,
}

impl DisjointSets {
    /// # Panics
    /// If there are 2³² elements or more.
    pub(crate) fn new(n: usize) -> Self {
        let end = u32::try_from(n).expect("fewer than 2^32 elements");
        Self { parent: (0..end).collect(), size: vec![1; n] }
    }

    /// The representative of the set that holds `i`.
    pub(crate) fn root(&mut self, mut i: u32) -> u32 {
        loop {
            let parent = self.parent[i as usize];
            if parent == i {
                return i;
            }
            let grandparent = self.parent[parent as usize];
            self.parent[i as usize] = grandparent;
            i = grandparent;
        }
    }

    pub(crate) fn join(&mut self, i: u32, j: u32) {
        let (i, j) = (self.root(i), self.root(j));
        if i != j {
            let is_smaller = self.size[i as usize] < self.size[j as usize];
            let (small, large) = if is_smaller { (i, j) } else { (j, i) };
            self.parent[small as usize] = large;
            self.size[large as usize] += self.size[small as usize];
        }
    }

    /// The representative of every element, itself an element.
    pub(crate) fn roots(mut self) -> Vec<u32> {
        let end = self.parent.len() as u32;
        (0..end).map(|i| self.root(i)).collect()
    }
}

/// Several families of disjoint sets of the same elements, numbered from 0.
///
/// Element by element in memory: whoever asks about one pair in all families reads two runs. The
/// lower root stays a root, which needs no sizes and is O(log n) a call with path halving.
pub(crate) struct DisjointSetFamilies {
    n_families: usize,
    /// Shape (n, families), row by row.
    parent: Vec<u32>,
    /// How many sets each family still has.
    n_sets: Vec<usize>,
}

impl DisjointSetFamilies {
    /// # Panics
    /// If there are 2³² elements or more.
    pub(crate) fn new(n: usize, n_families: usize) -> Self {
        let last = u32::try_from(n).expect("fewer than 2^32 elements");
        let parent = (0..last).flat_map(|i| std::iter::repeat_n(i, n_families)).collect();
        Self { n_families, parent, n_sets: vec![n; n_families] }
    }

    /// Whether the family has become a single set.
    pub(crate) fn is_one_set(&self, family: usize) -> bool {
        self.n_sets[family] <= 1
    }

    pub(crate) fn are_joined(&mut self, family: usize, i: usize, j: usize) -> bool {
        self.root(family, i) == self.root(family, j)
    }

    pub(crate) fn join(&mut self, family: usize, i: usize, j: usize) {
        let (i, j) = (self.root(family, i), self.root(family, j));
        if i != j {
            let (low, high) = if i < j { (i, j) } else { (j, i) };
            self.parent[high as usize * self.n_families + family] = low;
            self.n_sets[family] -= 1;
        }
    }

    /// The representative of every element in one family.
    pub(crate) fn roots(&mut self, family: usize) -> Vec<u32> {
        let n = self.parent.len() / self.n_families;
        (0..n).map(|i| self.root(family, i)).collect()
    }

    fn root(&mut self, family: usize, i: usize) -> u32 {
        let place = |i: u32| i as usize * self.n_families + family;
        let mut i = i as u32;
        loop {
            let parent = self.parent[place(i)];
            if parent == i {
                return i;
            }
            let grandparent = self.parent[place(parent)];
            self.parent[place(i)] = grandparent;
            i = grandparent;
        }
    }
}
