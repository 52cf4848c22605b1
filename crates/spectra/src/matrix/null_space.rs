//! The null space of S: one vector for each connected component.
//!
//! Rows of W sum to zero, so W 1_c = 0 for the indicator 1_c of a component c, and the multiplicity
//! of 0 is the number of components (for a connected network λ_1 = 0 is simple). In terms of S the
//! vectors are D^{1/2} 1_c. To know them beforehand spares the iterative solver an eigenvalue that
//! has as many copies as there are isolated nodes.

use graph::{Components, SymmetricForm};

use crate::vectors::column::normalise;

/// The null space of S.
pub(crate) struct NullSpace<'a> {
    w: &'a SymmetricForm<'a>,
    components: Components,
}

impl<'a> NullSpace<'a> {
    /// That of the network behind W.
    pub fn of(w: &'a SymmetricForm<'a>) -> Self {
        Self { w, components: Components::of(w.symmetric()) }
    }

    /// Its dimension: the number of components.
    pub fn dimension(&self) -> usize {
        self.components.count()
    }

    /// Orthonormal vectors that span it, one for each component.
    pub fn vectors(&self) -> Vec<Vec<f64>> {
        let mut vectors = vec![vec![0.0; self.w.n_nodes()]; self.dimension()];
        for (node, (component, scale)) in self.nodes().enumerate() {
            vectors[component][node] = 1.0 / scale;
        }
        for vector in &mut vectors {
            normalise(vector);
        }
        vectors
    }

    /// Scalar products of a vector with those of [`Self::vectors`].
    pub fn overlaps(&self, u: &[f64]) -> Vec<f64> {
        let (mut products, mut squares) =
            (vec![0.0; self.dimension()], vec![0.0; self.dimension()]);
        for ((component, scale), u_i) in self.nodes().zip(u) {
            products[component] += u_i / scale;
            squares[component] += 1.0 / scale / scale;
        }
        products.iter().zip(squares).map(|(product, square)| product / square.sqrt()).collect()
    }

    /// Removes from a vector its part in the null space.
    pub fn project_out(&self, u: &mut [f64]) {
        let mut squares = vec![0.0; self.dimension()];
        for (component, scale) in self.nodes() {
            squares[component] += 1.0 / scale / scale;
        }
        let overlaps = self.overlaps(u);
        for ((component, scale), u_i) in self.nodes().zip(u) {
            *u_i -= overlaps[component] / squares[component].sqrt() / scale;
        }
    }

    /// Component and D^{-1/2} of every node.
    fn nodes(&self) -> impl Iterator<Item = (usize, f64)> {
        let component = |node| self.components.of_node(node).expect("no node is left out");
        self.w.scale().iter().enumerate().map(move |(node, &scale)| (component(node), scale))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matrix::product::multiply;
    use graph::{CouplingMatrix, Network, Normalization};

    #[test]
    fn there_is_one_null_vector_for_each_component() {
        let labels = (0..7).map(|i| i.to_string()).collect();
        let links = [(0, 4, 0.3), (4, 6, 1.7), (6, 0, 2.1), (1, 3, 0.9)];
        let network = Network::undirected(labels, &links).unwrap();
        for normalization in [Normalization::Laplacian, Normalization::Normalized] {
            let w = CouplingMatrix::new(&network, normalization);
            let w = w.symmetric_form().unwrap();
            let null_space = NullSpace::of(&w);
            assert_eq!(null_space.dimension(), 4);
            for u in &null_space.vectors() {
                let mut image = vec![f64::NAN; 7];
                multiply(w.symmetric(), u, &mut image);
                assert!(image.iter().all(|y| y.abs() < 1e-15), "{image:?}");
            }
        }
    }
}
