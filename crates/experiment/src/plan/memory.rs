//! The memory that an experiment will take, estimated before any of it is taken.
//!
//! The numbers of bytes are rounded up from runs of 10³ to 10⁶ nodes; they are there to tell a
//! gigabyte from a hundred, not to be exact.

use eigensync::{Study, Sweep};
use std::path::Path;

use dynamics::Observables;

use super::checker::Checker;
use super::{Plan, drawn_kind};
use crate::machine::available_memory;
use crate::spec::{FigureKind, NetworkSpec};
use user::{Problem, Result};

/// Memory that a file of links takes for each of its bytes, at least: a link of some twenty characters
/// is [`LINK`] bytes.
const A_BYTE_OF_LINKS: f64 = 4.0;

/// Share of the available memory that an experiment may take.
const SHARE: f64 = 0.8;
/// The most nodes and links that are generated; larger networks come from files.
const MOST_NODES: f64 = 5e6;
const MOST_LINKS: f64 = 1e8;

/// A node with its label, its place in a group and its rows; a link in its matrices.
const NODE: f64 = 200.0;
const LINK: f64 = 120.0;
const NUMBER: f64 = 8.0;
/// Matrices of N × N numbers in the dense eigensolver.
const DENSE_MATRICES: f64 = 4.0;
/// Vectors of N numbers for each of some leading modes: the modes, and the space they are searched in.
const VECTORS_A_MODE: f64 = 6.0;
/// An averaged error is a mean and a standard error.
const ERROR: f64 = 16.0;
/// Numbers for the sums of an error while its run lasts, and lanes of a batch.
const SUMS: f64 = 3.0;
const LANES: f64 = 16.0;
/// Numbers of a node while a run lasts: components, increments, slopes.
const STATE: f64 = 20.0;
/// Matrices of N × N numbers for each column of a figure of matrices.
const DRAWN_MATRICES: f64 = 6.0;
const DRAWN_COLUMNS: f64 = 4.0;

/// Bytes by what takes them.
pub struct Memory(Vec<Part>);

struct Part {
    name: &'static str,
    /// Key of the experiment file that decides it.
    key: &'static str,
    bytes: f64,
    /// What would need less.
    hint: &'static str,
}

impl Memory {
    /// Bytes of all parts together.
    pub fn bytes(&self) -> u64 {
        self.total() as u64
    }

    /// Of all that a plan does.
    pub fn of(plan: &Plan) -> Self {
        Self::of_study(&plan.study, plan.figure.kind)
    }

    /// The same of a study and the figure that is asked for.
    pub(super) fn of_study(study: &Study, asked: FigureKind) -> Self {
        let (n, links) = (study.network.n_nodes() as f64, study.network.n_links() as f64);
        let mut parts = vec![Part {
            name: "network",
            key: "network",
            bytes: n * NODE + links * LINK,
            hint: "take a smaller network, or a part of it by `prepare`",
        }];
        let modes = study.modes.most_modes(study.network.n_nodes()) as f64;
        let is_dense = study.modes.is_dense(study.network.n_nodes());
        let dense = DENSE_MATRICES * n * n;
        let leading = (VECTORS_A_MODE * n * modes).min(dense);
        parts.push(Part {
            name: "spectrum",
            key: "spectrum.modes",
            bytes: NUMBER * if is_dense { dense } else { leading },
            hint: "set `spectrum.modes` to the number of leading modes you need",
        });
        parts.extend(study.sweep.iter().map(|sweep| of_sweep(sweep, n)));
        let figure = drawn_kind(study, asked);
        if study.sweep.is_some() && matches!(figure, FigureKind::Matrices | FigureKind::Regions) {
            parts.push(Part {
                name: "figure",
                key: "figure.kind",
                bytes: DRAWN_MATRICES * DRAWN_COLUMNS * NUMBER * n * n,
                hint: "set `figure.kind` to \"none\"",
            });
        }
        Self(parts)
    }

    fn total(&self) -> f64 {
        self.0.iter().map(|part| part.bytes).sum()
    }

    /// What is said where the machine does not have so much, and the part that needs the most.
    fn lacking(&self) -> Option<(String, &Part)> {
        let available = available_memory()? as f64;
        if self.total() <= SHARE * available {
            return None;
        }
        let message = format!(
            "needs about {self} of memory, but no more than {} of the {} that are free here may be \
             taken",
            gigabytes(SHARE * available),
            gigabytes(available)
        );
        Some((message, self.0.iter().max_by(|a, b| a.bytes.total_cmp(&b.bytes))?))
    }

    /// Refuses what the machine does not have, by the key of what needs the most.
    pub fn affordable(&self, file: &Path) -> Result<()> {
        match self.lacking() {
            None => Ok(()),
            Some((message, part)) => {
                let message = format!("asks for too much: the run {message}");
                Err(Problem::with_key(file, part.key, message).hint(part.hint))
            }
        }
    }
}

impl std::fmt::Display for Memory {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let parts = self.0.iter().map(|part| format!("{} {}", part.name, gigabytes(part.bytes)));
        let parts = parts.collect::<Vec<_>>().join(", ");
        write!(f, "{} ({parts})", gigabytes(self.total()))
    }
}

fn of_sweep(sweep: &Sweep, n: f64) -> Part {
    let Observables { pairs, reference, .. } = sweep.observables;
    let of_pairs = if pairs { 0.5 * n * (n - 1.0) } else { 0.0 };
    let errors = of_pairs + reference.map_or(0.0, |_| n);
    let runs = sweep.epsilon.len() as f64 * sweep.seeds.len() as f64;
    let batches = (rayon::current_num_threads() as f64 * LANES).min(runs);
    Part {
        name: "sweep",
        key: "sweep",
        bytes: ERROR * errors * runs + NUMBER * batches * (SUMS * errors + STATE * n),
        hint: "take fewer `seeds` or fewer values of `epsilon` in [sweep]",
    }
}

impl Checker<'_> {
    /// Refuses a file of links that would not fit into memory, by its length.
    pub(super) fn readable(&self, key: &str, n_bytes: u64) -> Result<()> {
        let bytes = A_BYTE_OF_LINKS * n_bytes as f64;
        match network_of(bytes).lacking() {
            None => Ok(()),
            Some((message, _)) => {
                let length = gigabytes(n_bytes as f64);
                let message = format!("names a file of {length}, which {message}");
                let hint = "take a part of the network, or a machine with more memory";
                Err(self.problem(key, message).hint(hint))
            }
        }
    }

    /// Refuses a network that is too large to be generated: the reason is known before it is tried.
    pub(super) fn generable(&self, n_nodes: f64, n_links: f64) -> Result<()> {
        let key = match &self.experiment.network {
            NetworkSpec::Hierarchical(_) => "network.hierarchical",
            _ => "network.communities",
        };
        for (what, found, most) in [("nodes", n_nodes, MOST_NODES), ("links", n_links, MOST_LINKS)]
        {
            if found > most {
                let message = format!(
                    "asks for {found:.2e} {what}, which would take about {} of memory; at most \
                     {most:.0e} are generated",
                    gigabytes(n_nodes * NODE + n_links * LINK)
                );
                return Err(self.problem(key, message).hint(match what {
                    "nodes" => "take smaller communities, or read the network from a file",
                    _ => "take smaller probabilities, or smaller communities",
                }));
            }
        }
        let bytes = n_nodes * NODE + n_links.max(0.0) * LINK;
        match network_of(bytes).lacking() {
            None => Ok(()),
            Some((message, _)) => {
                let hint = "take smaller communities, or smaller probabilities";
                Err(self.problem(key, message).hint(hint))
            }
        }
    }
}

fn network_of(bytes: f64) -> Memory {
    Memory(vec![Part { name: "network", key: "network", bytes, hint: "" }])
}

/// A number of bytes as people say it.
pub fn gigabytes(bytes: f64) -> String {
    match bytes {
        _ if bytes < 1e9 => format!("{:.0} MB", (bytes / 1e6).ceil()),
        _ if bytes < 1e11 => format!("{:.1} GB", bytes / 1e9),
        _ => format!("{:.0e} GB", bytes / 1e9),
    }
}
