//! The kernel of S: one vector for each connected component.
//!
//! Rows of W sum to zero, so W 1_c = 0 for the indicator 1_c of a component c, and the multiplicity
//! of 0 is the number of components (for a connected network λ_1 = 0 is simple). In terms of S the
//! vectors are D^{1/2} 1_c. To know them beforehand spares the iterative solver an eigenvalue that
//! has as many copies as there are isolated nodes.

use graph::SymmetricForm;

use crate::vectors::column::normalise;

/// The connected component of every node.
#[derive(Debug, PartialEq)]
pub(crate) struct Components {
    /// Number of each node's component, from 0 in the order of their first nodes.
    of_node: Vec<usize>,
    /// Number of components.
    pub count: usize,
}

impl Components {
    /// Scalar products of a vector with those of [`kernel`], one for each component.
    pub(crate) fn overlaps(&self, w: &SymmetricForm<'_>, u: &[f64]) -> Vec<f64> {
        let (mut products, mut squares) = (vec![0.0; self.count], vec![0.0; self.count]);
        for ((&component, scale), u_i) in self.of_node.iter().zip(w.scale()).zip(u) {
            products[component] += u_i / scale;
            squares[component] += 1.0 / scale / scale;
        }
        products.iter().zip(squares).map(|(product, square)| product / square.sqrt()).collect()
    }

    /// Removes from a vector its part in the kernel.
    pub(crate) fn project_out(&self, w: &SymmetricForm<'_>, u: &mut [f64]) {
        let mut squares = vec![0.0; self.count];
        for (&component, scale) in self.of_node.iter().zip(w.scale()) {
            squares[component] += 1.0 / scale / scale;
        }
        let overlaps = self.overlaps(w, u);
        for ((&component, scale), u_i) in self.of_node.iter().zip(w.scale()).zip(u) {
            *u_i -= overlaps[component] / squares[component].sqrt() / scale;
        }
    }
}

/// Finds the connected components of the network behind W.
pub(crate) fn components(w: &SymmetricForm<'_>) -> Components {
    let mut of_node = vec![usize::MAX; w.n_nodes()];
    let mut count = 0;
    let mut unvisited = Vec::new();
    for first in 0..w.n_nodes() {
        if of_node[first] != usize::MAX {
            continue;
        }
        unvisited.push(first);
        while let Some(node) = unvisited.pop() {
            if std::mem::replace(&mut of_node[node], count) == usize::MAX {
                let row = w.symmetric().outer_view(node).expect("a node has a row");
                unvisited.extend(row.indices().iter().map(|&j| j as usize));
            }
        }
        count += 1;
    }
    Components { of_node, count }
}

/// Orthonormal vectors that span the kernel of S, one for each component.
pub(crate) fn kernel(w: &SymmetricForm<'_>, components: &Components) -> Vec<Vec<f64>> {
    let mut vectors = vec![vec![0.0; w.n_nodes()]; components.count];
    for (node, (&component, scale)) in components.of_node.iter().zip(w.scale()).enumerate() {
        vectors[component][node] = 1.0 / scale;
    }
    for vector in &mut vectors {
        normalise(vector);
    }
    vectors
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matrix::product::multiply;
    use graph::{CouplingMatrix, Network, Normalization};

    #[test]
    fn there_is_one_kernel_vector_for_each_component() {
        let labels = (0..7).map(|i| i.to_string()).collect();
        let links = [(0, 4, 0.3), (4, 6, 1.7), (6, 0, 2.1), (1, 3, 0.9)];
        let network = Network::undirected(labels, &links).unwrap();
        for normalization in [Normalization::Laplacian, Normalization::Normalized] {
            let w = CouplingMatrix::new(&network, normalization);
            let w = w.symmetric_form().unwrap();
            let components = components(&w);
            assert_eq!(components, Components { of_node: vec![0, 1, 2, 1, 0, 3, 0], count: 4 });
            for u in &kernel(&w, &components) {
                let mut image = vec![f64::NAN; 7];
                multiply(w.symmetric(), u, &mut image);
                assert!(image.iter().all(|y| y.abs() < 1e-15), "{image:?}");
            }
        }
    }
}
