//! Sums over samples of |x_i − x_j| for many j at each i: a buffer of samples, and the sums.
//!
//! Samples wait in a buffer until there are [`SAMPLES`]; then each sum takes all of them at once, in
//! their order, so that it is read and written once for so many samples.

use crate::Lanes;
use crate::aligned::Aligned;
use crate::block_means::BlockMeans;
use crate::tile::TILE as WIDTH;

/// Samples that wait together: their differences at one run of numbers fit the first cache.
pub(crate) const SAMPLES: usize = 32;

/// Runs whose samples are gone through again for every i: a quarter of the second cache.
const TILE: usize = 64;

type Run = [f64; WIDTH];

/// Samples of one component in `L` lanes, `[run][sample][number in the run]`; a run holds `WIDTH / L`
/// nodes with their lanes.
pub(crate) struct Samples<const L: usize> {
    numbers: Aligned,
    n_samples: usize,
}

impl<const L: usize> Samples<L> {
    pub(crate) fn new(n_nodes: usize) -> Self {
        let n_runs = (n_nodes * L).div_ceil(WIDTH);
        Self { numbers: Aligned::zeros(n_runs * SAMPLES * WIDTH), n_samples: 0 }
    }

    /// Adds a sample, the lanes of one node after the other.
    #[inline(always)]
    pub(crate) fn push<'a>(&mut self, sample: impl Iterator<Item = &'a [f64; L]>) {
        let runs = self.numbers.as_chunks_mut::<WIDTH>().0[self.n_samples..].iter_mut();
        let places = runs.step_by(SAMPLES).flat_map(|run| run.as_chunks_mut().0);
        places.zip(sample).for_each(|(place, lanes)| *place = *lanes);
        self.n_samples += 1;
    }

    pub(crate) fn len(&self) -> usize {
        self.n_samples
    }

    pub(crate) fn clear(&mut self) {
        self.n_samples = 0;
    }

    /// The lanes of one node in one sample.
    #[inline(always)]
    pub(crate) fn node(&self, node: usize, sample: usize) -> Lanes<L> {
        let (run, place) = place::<L>(node);
        let run = &self.numbers.as_chunks::<WIDTH>().0[run * SAMPLES + sample];
        Lanes(std::array::from_fn(|lane| run[place + lane]))
    }

    /// Every sample of a node, its lanes repeated to fill a run.
    #[inline(always)]
    fn repeated(&self, node: usize) -> [Run; SAMPLES] {
        std::array::from_fn(|sample| {
            let Lanes(lanes) = self.node(node, sample);
            std::array::from_fn(|number| lanes[number % L])
        })
    }
}

/// For each of some nodes i, `T` of them together, sums of |x_i − x_j| over j from some node on.
pub(crate) struct Differences<const T: usize, const L: usize> {
    tiles: Vec<Tile<T>>,
    /// `[tile][run][i within the tile][number in the run]`.
    pub(crate) means: BlockMeans,
}

/// Nodes whose sums are made together.
struct Tile<const T: usize> {
    nodes: [usize; T],
    /// The first run of j.
    first_run: usize,
    /// Runs of the tiles before.
    before: usize,
}

impl<const T: usize, const L: usize> Differences<T, L> {
    /// Differences of each pair (i, first j): the given i, each against all nodes from a j on.
    pub(crate) fn new(rows: &[(usize, usize)], n_nodes: usize) -> Self {
        let n_runs = (n_nodes * L).div_ceil(WIDTH);
        let mut before = 0;
        let mut tile = |rows: &[(usize, usize)]| {
            let nodes = std::array::from_fn(|t| rows[t.min(rows.len() - 1)].0);
            let first = rows.iter().map(|row| row.1).min().unwrap_or(0).min(n_nodes - 1);
            let tile = Tile { nodes, first_run: place::<L>(first).0, before };
            before += n_runs - tile.first_run;
            tile
        };
        let tiles: Vec<_> = rows.chunks(T).map(&mut tile).collect();
        Self { tiles, means: BlockMeans::new(before * T * WIDTH) }
    }

    /// Adds all samples that wait.
    #[inline(always)]
    pub(crate) fn add(&mut self, samples: &Samples<L>) {
        let runs = samples.numbers.as_chunks::<WIDTH>().0.as_chunks::<SAMPLES>().0;
        let sums = self.means.sums.as_chunks_mut::<WIDTH>().0.as_chunks_mut::<T>().0;
        for from in (0..runs.len()).step_by(TILE) {
            let to = runs.len().min(from + TILE);
            for tile in self.tiles.iter().filter(|tile| tile.first_run < to) {
                let from = from.max(tile.first_run);
                let x: [_; T] = tile.nodes.map(|node| samples.repeated(node));
                let sums = &mut sums[tile.before + from - tile.first_run..][..to - from];
                for (sums, run) in sums.iter_mut().zip(&runs[from..to]) {
                    let mut total = sums.map(Lanes);
                    for (sample, other) in run[..samples.n_samples].iter().enumerate() {
                        for t in 0..T {
                            total[t] = total[t] + (Lanes(x[t][sample]) - Lanes(*other)).abs();
                        }
                    }
                    *sums = total.map(|total| total.0);
                }
            }
        }
    }

    #[inline(always)]
    pub(crate) fn close(&mut self, samples: f64) {
        self.means.close(samples);
    }

    /// Where the means of ⟨|x_i − x_j|⟩ stand for the i of a row.
    pub(crate) fn index(&self, row: usize, j: usize, lane: usize) -> usize {
        let (tile, (run, place)) = (&self.tiles[row / T], place::<L>(j));
        let vector = (tile.before + run - tile.first_run) * T + row % T;
        vector * WIDTH + place + lane
    }

    /// ⟨|x_i − x_j|⟩ for the i of a row.
    pub(crate) fn estimate(&self, row: usize, j: usize, lane: usize) -> crate::Estimate {
        self.means.estimate(self.index(row, j, lane))
    }
}

/// The run in which a node lies, and where in it its lanes begin.
#[inline(always)]
fn place<const L: usize>(node: usize) -> (usize, usize) {
    (node * L / WIDTH, node * L % WIDTH)
}
