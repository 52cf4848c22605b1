//! The quantities that claims speak of, an entry each, and how each is obtained, a file for each side
//! from which they come.

mod agreement;
mod cascade;
mod curve;
mod network;
mod regions;
mod simulated;
mod spectrum;

use serde::de::Error;
use serde::{Deserialize, Deserializer};

use crate::found::Found;
use crate::quantity::{From, Obtained, Quantity, Use, Uses};

/// All of them, in the order of the documentation.
pub static QUANTITIES: &[Quantity] = &[
    Quantity {
        name: "eigenvalues",
        meaning: "λ_k, descending: all, or those of `modes`",
        uses: Uses { modes: Use::Allowed, ..Uses::NONE },
        from: From::Modes,
        of_regions: false,
        obtained: Obtained::Numbers(spectrum::eigenvalues),
        bounded_runs: none,
        is_unrefined: never,
    },
    Quantity {
        name: "eigenvectors",
        meaning: "a vector for each of `modes`, in node order. Judged by eigenspace: the largest \
                  distance of a unit vector of the printed span from the computed one, or the \
                  reverse, at most `abs_tol`",
        uses: Uses::MODES,
        from: From::Modes,
        of_regions: false,
        obtained: Obtained::Vectors(spectrum::eigenvectors),
        bounded_runs: none,
        is_unrefined: never,
    },
    Quantity {
        name: "msf.lyapunov_isolated",
        meaning: "Λ(0)",
        uses: Uses::NONE,
        from: From::Curve,
        of_regions: false,
        obtained: Obtained::Numbers(curve::isolated),
        bounded_runs: none,
        is_unrefined: never,
    },
    Quantity {
        name: "msf.sigma_c",
        meaning: "σ_c; none unless the stable set is σ > σ_c",
        uses: Uses::NONE,
        from: From::Curve,
        of_regions: false,
        obtained: Obtained::Numbers(curve::sigma_c),
        bounded_runs: none,
        is_unrefined: curve::sigma_c_is_unrefined,
    },
    Quantity {
        name: "msf.zeros",
        meaning: "every zero of Λ that bounds the stable set, ascending; `[]` for none",
        uses: Uses::NONE,
        from: From::Curve,
        of_regions: false,
        obtained: Obtained::List(curve::zeros),
        bounded_runs: none,
        is_unrefined: curve::zeros_are_unrefined,
    },
    Quantity {
        name: "critical_couplings",
        meaning: "ε_k above which each of `modes` is stable",
        uses: Uses::MODES,
        from: From::Curve,
        of_regions: false,
        obtained: Obtained::Numbers(curve::critical_couplings),
        bounded_runs: none,
        is_unrefined: curve::couplings_are_unrefined,
    },
    Quantity {
        name: "cascade.clusters",
        meaning: "predicted clusters of two nodes or more; must be the same sets",
        uses: Uses::EPSILON,
        from: From::Curve,
        of_regions: false,
        obtained: Obtained::Clusters(cascade::clusters),
        bounded_runs: none,
        is_unrefined: cascade::is_unrefined,
    },
    Quantity {
        name: "cascade.order_of_loss",
        meaning: "positions of `clusters`, from 1, in the order in which they are predicted to be \
                  lost as ε falls",
        uses: Uses::CLUSTERS,
        from: From::Curve,
        of_regions: false,
        obtained: Obtained::Losses { between: cascade::loss, exactly: true },
        bounded_runs: none,
        is_unrefined: cascade::is_unrefined,
    },
    Quantity {
        name: "simulated.clusters",
        meaning: "simulated clusters of two nodes or more; must be the same sets",
        uses: Uses::EPSILON,
        from: From::Simulations,
        of_regions: false,
        obtained: Obtained::Clusters(simulated::clusters),
        bounded_runs: simulated::bounded_at_epsilon,
        is_unrefined: never,
    },
    Quantity {
        name: "simulated.onset",
        meaning: "ε from which on all of `clusters` are seen synchronised, mean over seeds; \"at \
                  most\" the smallest ε where that is all the sweep tells; none unless every seed \
                  has one",
        uses: Uses::CLUSTERS,
        from: From::Simulations,
        of_regions: false,
        obtained: Obtained::Numbers(simulated::onset),
        bounded_runs: simulated::bounded_at_onset,
        is_unrefined: never,
    },
    Quantity {
        name: "simulated.order_of_loss",
        meaning: "positions of two `clusters` or more in the order of falling onset",
        uses: Uses::CLUSTERS,
        from: From::Simulations,
        of_regions: false,
        obtained: Obtained::Losses { between: simulated::loss, exactly: false },
        bounded_runs: simulated::bounded_at_onsets,
        is_unrefined: never,
    },
    Quantity {
        name: "simulated.error",
        meaning: "largest δx^c_m of `clusters`, mean over seeds; none where a run escaped",
        uses: Uses { epsilon: Use::Needed, ..Uses::CLUSTERS },
        from: From::Simulations,
        of_regions: false,
        obtained: Obtained::Numbers(simulated::errors),
        bounded_runs: simulated::bounded_at_epsilon,
        is_unrefined: never,
    },
    Quantity {
        name: "network.nodes",
        meaning: "nodes of the prepared network; with `group_prefix`, those of the groups whose \
                  names begin so",
        uses: Uses { group_prefix: Use::Allowed, ..Uses::NONE },
        from: From::Links,
        of_regions: false,
        obtained: Obtained::Numbers(network::nodes),
        bounded_runs: none,
        is_unrefined: never,
    },
    Quantity {
        name: "network.links",
        meaning: "its links",
        uses: Uses::NONE,
        from: From::Links,
        of_regions: false,
        obtained: Obtained::Numbers(network::links),
        bounded_runs: none,
        is_unrefined: never,
    },
    Quantity {
        name: "network.groups",
        meaning: "its groups",
        uses: Uses::NONE,
        from: From::Links,
        of_regions: false,
        obtained: Obtained::Numbers(network::groups),
        bounded_runs: none,
        is_unrefined: never,
    },
    Quantity {
        name: "agreement.pearson",
        meaning: "Pearson's correlation of δx_ij with δe_ij over all pairs",
        uses: Uses::EPSILON,
        from: From::Simulations,
        of_regions: false,
        obtained: Obtained::Numbers(agreement::pearson),
        bounded_runs: simulated::bounded_at_epsilon,
        is_unrefined: never,
    },
    Quantity {
        name: "agreement.spearman",
        meaning: "Spearman's rank correlation of the same",
        uses: Uses::EPSILON,
        from: From::Simulations,
        of_regions: false,
        obtained: Obtained::Numbers(agreement::spearman),
        bounded_runs: simulated::bounded_at_epsilon,
        is_unrefined: never,
    },
    Quantity {
        name: "agreement.rand_index",
        meaning: "adjusted Rand index of predicted and simulated clusters",
        uses: Uses::EPSILON,
        from: From::Simulations,
        of_regions: false,
        obtained: Obtained::Numbers(agreement::rand_index),
        bounded_runs: simulated::bounded_at_epsilon,
        is_unrefined: never,
    },
    Quantity {
        name: "agreement.regions",
        meaning: "fraction of regions of the same verdict in prediction and simulation",
        uses: Uses::EPSILON,
        from: From::Simulations,
        of_regions: true,
        obtained: Obtained::Numbers(regions::same_verdict),
        bounded_runs: simulated::bounded_at_epsilon,
        is_unrefined: never,
    },
    Quantity {
        name: "regions.predicted",
        meaning: "clusters of regions under the thresholds of `[regions]` on δe_ij, as lists of \
                  names of groups",
        uses: Uses::EPSILON,
        from: From::Curve,
        of_regions: true,
        obtained: Obtained::Clusters(regions::predicted),
        bounded_runs: none,
        is_unrefined: never,
    },
    Quantity {
        name: "regions.simulated",
        meaning: "the same under those on δx_ij",
        uses: Uses::EPSILON,
        from: From::Simulations,
        of_regions: true,
        obtained: Obtained::Clusters(regions::simulated),
        bounded_runs: simulated::bounded_at_epsilon,
        is_unrefined: never,
    },
    Quantity {
        name: "regions.predicted.grey_nodes",
        meaning: "nodes in regions that are not predicted to synchronise within themselves, or in \
                  none",
        uses: Uses::EPSILON,
        from: From::Curve,
        of_regions: true,
        obtained: Obtained::Numbers(regions::predicted_grey),
        bounded_runs: none,
        is_unrefined: never,
    },
    Quantity {
        name: "regions.simulated.grey_nodes",
        meaning: "the same in simulation",
        uses: Uses::EPSILON,
        from: From::Simulations,
        of_regions: true,
        obtained: Obtained::Numbers(regions::simulated_grey),
        bounded_runs: simulated::bounded_at_epsilon,
        is_unrefined: never,
    },
    Quantity {
        name: "regions.predicted.cluster_size",
        meaning: "mean number of nodes of a predicted cluster of regions",
        uses: Uses::EPSILON,
        from: From::Curve,
        of_regions: true,
        obtained: Obtained::Numbers(regions::predicted_size),
        bounded_runs: none,
        is_unrefined: never,
    },
    Quantity {
        name: "regions.simulated.cluster_size",
        meaning: "the same in simulation",
        uses: Uses::EPSILON,
        from: From::Simulations,
        of_regions: true,
        obtained: Obtained::Numbers(regions::simulated_size),
        bounded_runs: simulated::bounded_at_epsilon,
        is_unrefined: never,
    },
];

/// Their names, for whoever has mistaken one.
static NAMES: [&str; QUANTITIES.len()] = {
    let mut names = [""; QUANTITIES.len()];
    let mut at = 0;
    while at < names.len() {
        names[at] = QUANTITIES[at].name;
        at += 1;
    }
    names
};

/// The quantity of a claim, by its name.
#[derive(Clone, Copy, Debug)]
pub struct Of(pub &'static Quantity);

impl<'de> Deserialize<'de> for Of {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        let quantity = QUANTITIES.iter().find(|quantity| quantity.name == name);
        quantity.map(Self).ok_or_else(|| D::Error::unknown_variant(&name, &NAMES))
    }
}

/// It stands on no runs.
fn none(_: &Found<'_>) -> Option<usize> {
    None
}

/// It follows from no zero of Λ.
fn never(_: &Found<'_>) -> bool {
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The row of the documentation that says the same as an entry.
    fn row(quantity: &Quantity) -> String {
        let Uses { epsilon, modes, clusters, .. } = quantity.uses;
        let keys = [("`epsilon`", epsilon), ("`modes`", modes), ("`clusters`", clusters)];
        let needed = keys.iter().filter(|(_, used)| *used == Use::Needed).map(|(key, _)| *key);
        let needed = needed.collect::<Vec<_>>().join(", ");
        let needed = if needed.is_empty() { needed } else { format!("{needed} ") };
        format!("| `{}` | {} | {needed}|", quantity.name, quantity.meaning)
    }

    #[test]
    fn the_documentation_says_of_each_quantity_what_its_entry_says() {
        let documentation = include_str!("../../../docs/experiments.md");
        let table = documentation.split_once("| `of` | value | needs `where` |").unwrap().1;
        let rows: Vec<&str> =
            table.lines().skip(2).take_while(|line| line.starts_with('|')).collect();
        assert_eq!(rows, QUANTITIES.iter().map(row).collect::<Vec<_>>());
    }

    #[test]
    fn no_two_quantities_have_one_name() {
        for (at, quantity) in QUANTITIES.iter().enumerate() {
            assert!(QUANTITIES[..at].iter().all(|other| other.name != quantity.name));
        }
    }
}
