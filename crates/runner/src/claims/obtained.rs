//! The numbers that claims are about: what was obtained of each, how far it is known, and why there is
//! none.

use clustering::RegionClusters;
use eigensync::numbers::{four_digits, plain};
use eigensync::{Agreement, End, Known, Predicted, Regions, Simulated};

use super::{Judge, Number};
use crate::spec::Quantity;

impl Judge<'_> {
    /// The numbers of the claim's quantity, one for each mode or ε.
    pub(super) fn obtained_numbers(&self) -> Vec<Number> {
        let msf = &self.findings.msf;
        match self.spec.of {
            Quantity::Eigenvalues => self.eigenvalues(),
            Quantity::CriticalCouplings => self.critical_couplings(),
            Quantity::LyapunovIsolated => {
                let (value, error) = (msf.isolated.mean, msf.isolated.standard_error);
                vec![Number::Known { value, error }]
            }
            Quantity::SigmaC => vec![match msf.stable.sigma_c() {
                Some(zero) => Number::Known { value: zero.sigma, error: zero.standard_error },
                None => self.no_edge(-1.0),
            }],
            Quantity::SimulatedOnset => vec![self.onset()],
            Quantity::SimulatedError => {
                let clusters = self.claimed_clusters();
                self.at_each_epsilon(|simulated, at| cluster_error(simulated, at, &clusters))
            }
            Quantity::Nodes => vec![Number::exactly(self.counted_nodes() as f64)],
            Quantity::Links => vec![Number::exactly(self.plan.study.network.n_links() as f64)],
            Quantity::Groups => {
                vec![Number::exactly(self.plan.study.network.groups().len() as f64)]
            }
            Quantity::Pearson => {
                self.agreements(|a| known(a.correlation.map(|c| c.pearson), a.errors.pearson))
            }
            Quantity::Spearman => {
                self.agreements(|a| known(a.correlation.map(|c| c.spearman), a.errors.spearman))
            }
            Quantity::RandIndex => self.agreements(|a| known(a.rand_index, a.errors.rand_index)),
            Quantity::RegionVerdicts => self.of_regions_found(|regions| {
                // Regions that are not there agree about nothing.
                let has_any = regions.agreement.n_regions > 0;
                has_any.then(|| regions.agreement.verdict_fraction())
            }),
            Quantity::PredictedGrey => self.of_regions_found(|r| Some(grey_nodes(&r.predicted))),
            Quantity::SimulatedGrey => self.of_regions_found(|r| Some(grey_nodes(&r.simulated))),
            Quantity::PredictedSize => {
                self.of_regions_found(|regions| mean_cluster_size(&regions.predicted))
            }
            Quantity::SimulatedSize => {
                self.of_regions_found(|regions| mean_cluster_size(&regions.simulated))
            }
            // Judged by their own functions.
            Quantity::Eigenvectors
            | Quantity::CascadeClusters
            | Quantity::SimulatedClusters
            | Quantity::PredictedRegions
            | Quantity::SimulatedRegions
            | Quantity::CascadeOrder
            | Quantity::SimulatedOrder => vec![],
        }
    }

    fn eigenvalues(&self) -> Vec<Number> {
        let eigenvalues = self.findings.spectrum.real_eigenvalues();
        let computed = eigenvalues.len();
        let number = |mode: usize| match eigenvalues.get(mode - 1) {
            Some(&value) => Number::Known { value, error: self.eigenvalue_error(mode) },
            None => self.not_computed(mode),
        };
        match &self.spec.at.modes {
            Some(modes) => modes.iter().map(|&mode| number(mode)).collect(),
            // All, of which a part says nothing of the rest.
            None if computed < self.plan.study.network.n_nodes() => {
                (1..=computed + 1).map(number).collect()
            }
            None => (1..=computed).map(number).collect(),
        }
    }

    /// How far an eigenvalue is known. Those of one eigenspace are equal as far as anyone can tell, so
    /// that they are in no order.
    fn eigenvalue_error(&self, mode: usize) -> f64 {
        let spectrum = self.findings.spectrum.real_modes();
        let error = spectrum.error(mode - 1);
        let is_multiple =
            |space: &std::ops::Range<usize>| space.len() > 1 && space.contains(&(mode - 1));
        if self.spec.trend.is_some() && spectrum.eigenspaces.iter().any(is_multiple) {
            error.max(spectrum.tolerance)
        } else {
            error
        }
    }

    pub(super) fn not_computed(&self, mode: usize) -> Number {
        let all = self.plan.study.network.n_nodes();
        let computed = self.findings.spectrum.n_modes();
        Number::Unknown(format!("{computed} of {all} modes were computed, and not mode {mode}"))
    }

    fn critical_couplings(&self) -> Vec<Number> {
        let findings = self.findings;
        let eigenvalues = findings.spectrum.real_eigenvalues();
        let number = |&mode: &usize| {
            if mode > eigenvalues.len() {
                return self.not_computed(mode);
            }
            match findings.transitions_of(mode - 1).find(|transition| transition.zero.falling) {
                // The zero of Λ is the same for all modes, and does not change their order.
                Some(t) if self.spec.trend.is_some() && t.epsilon.is_finite() => Number::Known {
                    value: t.epsilon,
                    error: t.epsilon * self.eigenvalue_error(mode) / -t.lambda,
                },
                Some(t) if t.epsilon.is_finite() => {
                    Number::Known { value: t.epsilon, error: t.standard_error }
                }
                Some(_) => Number::None,
                None => self.no_edge(eigenvalues[mode - 1]),
            }
        };
        self.spec.at.modes.iter().flatten().map(number).collect()
    }

    /// Where there is no σ from which on a mode of eigenvalue λ is stable: it may lie where nothing was
    /// looked at. σ_c is the coupling of λ = −1.
    fn no_edge(&self, lambda: f64) -> Number {
        let msf = &self.findings.msf;
        let [first, last] = [msf.sigma[0], msf.sigma[msf.sigma.len() - 1]];
        let [from, to] = [first, last].map(four_digits);
        if msf.stable.intervals.is_empty() {
            let words = format!("nothing is stable from sigma = {from} to {to}");
            return match first {
                0.0 => Number::NoneUpTo { limit: msf::coupling_at(last, lambda), words },
                _ => Number::Unknown(words),
            };
        }
        match msf.stable.unknown_below() {
            Some(_) => Number::Unknown(format!(
                "Λ < 0 at sigma = {from}, the smallest that was looked at: where that begins is not \
                 known"
            )),
            None => Number::None,
        }
    }

    fn onset(&self) -> Number {
        let Some(simulated) = &self.findings.simulated else { return Number::None };
        match self.findings.seen(&self.claimed_clusters()) {
            Some(seen) => of_onset(&seen.onset, simulated),
            None => Number::None,
        }
    }

    /// The clusters that the claim is about.
    pub(super) fn claimed_clusters(&self) -> Vec<Vec<usize>> {
        self.nodes(self.spec.at.clusters.as_deref().unwrap_or_default())
    }

    /// The nodes of the network, or of the groups that the claim is about.
    fn counted_nodes(&self) -> usize {
        let network = &self.plan.study.network;
        let Some(prefix) = &self.spec.at.group_prefix else { return network.n_nodes() };
        let groups = network.groups().iter().filter(|group| group.name.starts_with(prefix));
        groups.map(|group| group.nodes.len()).sum()
    }

    /// A number of the simulations at each ε of the claim, of which the plan has made sure that they are
    /// in the sweep.
    fn at_each_epsilon(&self, of: impl Fn(&Simulated, usize) -> Number) -> Vec<Number> {
        let number = |&epsilon: &f64| {
            let simulated = self.findings.simulated.as_ref();
            let found = simulated.and_then(|s| Some(of(s, s.position(epsilon)?)));
            found.unwrap_or(Number::None)
        };
        self.epsilon().iter().map(number).collect()
    }

    /// A number of the agreement at each ε of the claim.
    fn agreements(&self, of: impl Fn(&Agreement) -> Number) -> Vec<Number> {
        self.at_each_epsilon(|_, position| {
            let number = self.findings.agreement.get(position).map_or(Number::None, &of);
            match (number, self.not_compared(position)) {
                (Number::None, Some(why)) => Number::Unknown(why),
                (number, _) => number,
            }
        })
    }

    /// A number of both sides' regions at each ε of the claim; it has none of its own.
    fn of_regions_found(&self, of: impl Fn(&Regions) -> Option<f64>) -> Vec<Number> {
        let number = |regions: &Regions| of(regions).map_or(Number::None, Number::exactly);
        self.at_each_epsilon(|_, position| {
            match self.findings.agreement.get(position).and_then(|a| a.regions.as_ref()) {
                Some(regions) => number(regions),
                None => self.not_compared(position).map_or(Number::None, Number::Unknown),
            }
        })
    }

    /// Why prediction and simulation are not compared at a point of the sweep.
    pub(super) fn not_compared(&self, position: usize) -> Option<String> {
        let simulated = self.findings.simulated.as_ref()?;
        let epsilon = plain(simulated.epsilon[position]);
        if let Some(why) = nothing_left(simulated, position) {
            return Some(why);
        }
        match self.findings.agreement.get(position)?.predicted {
            Predicted::NotReached => Some(not_predicted(simulated.epsilon[position])),
            Predicted::AllTogether => Some(format!(
                "no mode is unstable at epsilon = {epsilon}: all nodes are predicted to be alike"
            )),
            Predicted::Uncoupled | Predicted::Unstable(_) => None,
        }
    }

    /// How well a single obtained number is known, where that is more than rounding.
    pub(super) fn uncertainty(&self) -> Option<f64> {
        if self.spec.of == Quantity::Eigenvalues || self.spec.trend.is_some() {
            return None;
        }
        match self.obtained_numbers()[..] {
            [Number::Known { error, .. }] if error > 0.0 => Some(error),
            _ => None,
        }
    }
}

/// That nothing is predicted at an ε.
pub(super) fn not_predicted(epsilon: f64) -> String {
    format!(
        "nothing is predicted at epsilon = {}: modes that may be unstable there were not computed, or \
         their sigma were not looked at",
        plain(epsilon)
    )
}

/// Where no run came to its end, that.
pub(super) fn nothing_left(simulated: &Simulated, position: usize) -> Option<String> {
    (simulated.bounded(position) == 0).then(|| lost(simulated, position))
}

fn lost(simulated: &Simulated, position: usize) -> String {
    let (lost, all) = (simulated.broken_off(position), simulated.seeds.len());
    let runs = if all == 1 { "run" } else { "runs" };
    let epsilon = plain(simulated.epsilon[position]);
    format!("at epsilon = {epsilon} {lost} of {all} {runs} {}", simulated.broke_off())
}

/// A number with the scatter of the seeds, which a single one does not tell.
fn known(value: Option<f64>, error: Option<f64>) -> Number {
    match value {
        Some(value) => Number::Known { value, error: error.unwrap_or(0.0) },
        None => Number::None,
    }
}

/// The largest error of some clusters. An average over runs that did not escape is none of the network,
/// and none is known better than rounding.
fn cluster_error(simulated: &Simulated, position: usize, clusters: &[Vec<usize>]) -> Number {
    match simulated.largest_cluster_error(position, clusters) {
        Some(error) => Number::Known {
            value: error.mean,
            error: error.standard_error.max(simulated.rounding()),
        },
        None => Number::Unknown(lost(simulated, position)),
    }
}

/// An onset that begins where runs escape may lie anywhere below.
fn of_onset(onset: &End, simulated: &Simulated) -> Number {
    let largest = simulated.epsilon[simulated.epsilon.len() - 1];
    let known = match (onset.bound, onset.interval) {
        (Known::Measured, Some([_, kept])) if onset.n_escaped > 0 => Some(Number::at_most(kept)),
        (Known::Measured, _) => {
            let error = onset.uncertainty();
            onset.mean.zip(error).map(|(value, error)| Number::Known { value, error })
        }
        (Known::AtMost, _) => onset.limit.map(Number::at_most),
        (Known::AtLeast, _) => onset.limit.map(Number::at_least),
        (Known::Groups, Some([least, most])) => {
            let words = onset.groups.iter().map(ToString::to_string).collect::<Vec<_>>();
            Some(Number::Between { least, most, words: words.join(", ") })
        }
        (Known::Unseen, _) => Some(Number::NoneUpTo {
            limit: largest,
            words: format!("not seen in every seed, up to epsilon = {}", plain(largest)),
        }),
        (Known::Escaped, _) => Some(Number::Unknown(format!(
            "in {} of {} seeds every orbit that was looked at escaped",
            onset.n_escaped,
            simulated.seeds.len()
        ))),
        (Known::NotSwept, _) => Some(Number::Unknown(
            "the sweep has no point that was integrated where these clusters are predicted".into(),
        )),
        (Known::Groups, None) => None,
    };
    known.unwrap_or(Number::None)
}

/// Nodes whose regions do not synchronise, or that belong to none.
fn grey_nodes(regions: &RegionClusters) -> f64 {
    regions.cluster_of_node().iter().filter(|cluster| cluster.is_none()).count() as f64
}

/// Nodes of a cluster of regions in the mean; none where there is no cluster.
fn mean_cluster_size(regions: &RegionClusters) -> Option<f64> {
    let nodes = regions.cluster_of_node();
    let coloured = nodes.iter().flatten().count() as f64;
    (regions.n_clusters() > 0).then(|| coloured / regions.n_clusters() as f64)
}
