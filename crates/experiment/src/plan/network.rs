//! The network of an experiment, and whatever names its nodes or modes.

use graph::prepare::Report;
use graph::{NameError, Network};

use eigensync::{ALL_PAIRS, WantedModes, misnamed_modes};

use super::checker::Checker;
use crate::spec::{FigureKind, Layout};
use user::{Problem, Result};

impl Checker<'_> {
    /// The network, with what its preparation did, if it can be coupled at all.
    pub(super) fn network(&self) -> Result<(Network, Vec<Report>)> {
        let (network, reports) = self.source()?;
        if network.n_nodes() == 1 {
            let message = "has one node; synchronisation needs two or more";
            return Err(self.of_network(message));
        }
        let strengths = network.strengths();
        if let Some(node) = strengths.iter().position(|strength| !strength.is_finite()) {
            let label = &network.labels()[node];
            let message = format!("has weights at node `{label}` that add up to more than 1.8e308");
            return Err(self.of_network(&message));
        }
        Ok((network, reports))
    }

    /// What a name of nodes is not, as a problem with its key.
    pub(super) fn misnamed(&self, key: &str, error: &NameError) -> Problem {
        let problem = self.problem(key, error);
        match error.hint() {
            Some(hint) => problem.hint(hint),
            None => problem,
        }
    }

    /// Modes, counted from 1: no more of them than there are, and none twice.
    fn modes(&self, key: &str, modes: &[usize], most: usize) -> Result<()> {
        misnamed_modes(modes, most).map_or(Ok(()), |message| Err(self.problem(key, message)))
    }

    /// The regions are groups, and their thresholds make sense.
    pub(super) fn regions(&self, network: &Network) -> Result<()> {
        let Some(regions) = &self.experiment.regions else { return Ok(()) };
        if network.groups().is_empty() {
            return Err(self.problem("regions", "needs groups, and the network has none"));
        }
        if network.n_nodes() > ALL_PAIRS {
            let message = format!(
                "needs the errors of all pairs, kept for networks of up to {ALL_PAIRS} nodes"
            );
            return Err(self.problem("regions", message));
        }
        let bounds = [
            ("distance_within", regions.distance_within),
            ("distance_between", regions.distance_between),
            ("error_within", regions.error_within),
            ("error_between", regions.error_between),
        ];
        bounds
            .iter()
            .try_for_each(|(key, bound)| self.bound(&format!("regions.{key}"), *bound, true))?;
        self.region_ranges(regions, network.n_nodes())
    }

    /// Matrices and regions need what they show. Matrices of too many nodes are no mistake: the figure
    /// is of another kind then, as `check` foresees.
    fn figure_kind(&self, network: &Network) -> Result<()> {
        let kind = self.experiment.figure.kind;
        let regions = self.experiment.regions.is_some();
        let missing = match kind {
            FigureKind::Sweep | FigureKind::None => None,
            FigureKind::Matrices | FigureKind::Regions if self.experiment.sweep.is_none() => {
                Some("a [sweep]")
            }
            FigureKind::Regions if !regions => Some("the thresholds of [regions]"),
            FigureKind::Regions if network.positions().is_none() => Some("positions of the nodes"),
            FigureKind::Matrices | FigureKind::Regions => None,
        };
        match missing {
            None => Ok(()),
            Some(what) => Err(self.problem("figure.kind", format!("needs {what}"))),
        }
    }

    /// What the figure is told of nodes, modes and couplings must exist.
    pub(super) fn figure(&self, network: &Network, spectrum: &WantedModes) -> Result<()> {
        let (figure, n_nodes) = (&self.experiment.figure, network.n_nodes());
        self.figure_kind(network)?;
        if let Layout::At(positions) = &figure.layout {
            if positions.len() != n_nodes {
                let message = format!("has {} positions for {n_nodes} nodes", positions.len());
                return Err(self.problem("figure.layout", message));
            }
            let labelled = network.labels().iter().zip(positions);
            labelled.into_iter().try_for_each(|(label, at)| self.position_range(label, *at))?;
        }
        let computed = spectrum.most_modes(n_nodes);
        if let Some(modes) = &figure.eigenvectors {
            if modes.is_empty() {
                let problem = self.problem("figure.eigenvectors", "is empty, but needs a mode");
                return Err(problem.hint("leave it out for modes 2, 3 and 4"));
            }
            self.modes("figure.eigenvectors", modes, computed)?;
        }
        self.modes(
            "figure.mark_modes",
            figure.mark_modes.as_deref().unwrap_or_default(),
            computed,
        )?;
        match figure.source_transitions.iter().find(|epsilon| !epsilon.is_finite()) {
            None => Ok(()),
            Some(epsilon) => {
                let message = format!("contains {epsilon}; its values must be finite");
                Err(self.problem("figure.source_transitions", message))
            }
        }
    }
}
