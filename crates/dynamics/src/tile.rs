//! Tiles: numbers of one component, of some nodes and replicas, that are handed to equations together.

/// Components that a node can have at the most.
pub const MAX_COMPONENTS: usize = 16;

/// Numbers in a tile: sixteen nodes of a single replica, or one node of sixteen, or what lies between.
/// Numbers of lanes divide it.
pub(crate) const TILE: usize = 16;

/// Numbers of one component: equations need not know which nodes and lanes they are of.
pub(crate) type Tile = [f64; TILE];

/// The slices of every component, of which there may be fewer than the most.
pub(crate) fn slices<'a>(
    components: impl Iterator<Item = &'a [f64]>,
) -> [&'a [f64]; MAX_COMPONENTS] {
    let mut slices: [&[f64]; MAX_COMPONENTS] = [&[]; MAX_COMPONENTS];
    for (slice, component) in slices.iter_mut().zip(components) {
        *slice = component;
    }
    slices
}

/// The same to be written to.
pub(crate) fn slices_mut<'a>(
    components: impl Iterator<Item = &'a mut [f64]>,
) -> [&'a mut [f64]; MAX_COMPONENTS] {
    let mut slices: [&mut [f64]; MAX_COMPONENTS] = std::array::from_fn(|_| &mut [][..]);
    for (slice, component) in slices.iter_mut().zip(components) {
        *slice = component;
    }
    slices
}
