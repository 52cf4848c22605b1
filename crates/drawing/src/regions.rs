//! Figure of nodes in space, coloured by predicted clusters of regions above simulated ones, one column
//! for each ε (the paper's Fig. 5). A cluster keeps its colour from column to column, and a simulated
//! one has that of the predicted one with which it shares most nodes.

use std::cmp::Reverse;
use std::collections::BTreeMap;

use eigensync::{Agreement, Findings, Predicted, Regions, Simulated};

use crate::identity::followed;
use crate::pairs::{epsilon, shown};
use experiment::Plan;
use figures::{Content, Figure, Label, PositionsPanel, pairs_figure};
use graph::Group;

/// A mark for each node: its cluster, or its colour.
type Marks = Vec<Option<usize>>;

/// Nodes at their places, coloured by predicted clusters above simulated ones.
pub fn regions(plan: &Plan, findings: &Findings, simulated: &Simulated) -> Figure {
    let positions = plan.study.network.positions().unwrap_or_default();
    let groups = plan.study.network.groups();
    let mut colours = Colours::new(positions.len());
    let columns = shown(simulated).map(|position| {
        let of_side = |side: &str, (clusters, grey): (Marks, &str)| {
            let title = epsilon(simulated.epsilon[position]).with_text(format!(", {side}"));
            let grey_label = Label::text(grey);
            let (positions, names) = (positions.to_vec(), names(&clusters, groups));
            Content::Positions(PositionsPanel { title, positions, clusters, names, grey_label })
        };
        let escaped = simulated.bounded(position) == 0;
        let [above, below] = colours.column(findings.agreement.get(position), escaped);
        [of_side("predicted", above), of_side("simulated", below)]
    });
    pairs_figure(plan.title.clone(), columns.collect())
}

/// The names of clusters that are groups: theirs.
fn names(clusters: &[Option<usize>], groups: &[Group]) -> BTreeMap<usize, Label> {
    let mut nodes: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (node, cluster) in clusters.iter().enumerate() {
        cluster.iter().for_each(|&cluster| nodes.entry(cluster).or_default().push(node));
    }
    let group_of = |nodes: &[usize]| groups.iter().find(|group| group.nodes == nodes);
    let name = |(cluster, nodes): (usize, Vec<usize>)| {
        Some((cluster, Label::text(group_of(&nodes)?.name.as_str())))
    };
    nodes.into_iter().filter_map(name).collect()
}

/// The colours that nodes had in the columns before.
struct Colours {
    predicted: Marks,
    simulated: Marks,
    /// The next that no cluster has had.
    next: usize,
}

impl Colours {
    fn new(n_nodes: usize) -> Self {
        Self { predicted: vec![None; n_nodes], simulated: vec![None; n_nodes], next: 0 }
    }

    /// Colours of both sides, and what the grey nodes are.
    fn column(
        &mut self,
        agreement: Option<&Agreement>,
        escaped: bool,
    ) -> [(Marks, &'static str); 2] {
        if let Some(regions) = agreement.and_then(|agreement| agreement.regions.as_ref()) {
            return self.of_regions(regions).map(|colours| (colours, "not synchronisable"));
        }
        // Nothing to tell nodes apart by, or nothing to compare: the word says which.
        let none = || vec![None; self.predicted.len()];
        let of = agreement.map_or(&Predicted::NotReached, |agreement| &agreement.predicted);
        let predicted = match of {
            Predicted::Uncoupled => (none(), "uncoupled"),
            Predicted::NotReached => (none(), "not predicted"),
            Predicted::Unstable(_) => (none(), "not compared"),
            Predicted::AllTogether => (self.all_together(), ""),
        };
        [predicted, (none(), if escaped { "all runs escaped" } else { "not compared" })]
    }

    fn all_together(&self) -> Marks {
        vec![Some(0); self.predicted.len()]
    }

    fn of_regions(&mut self, regions: &Regions) -> [Marks; 2] {
        self.of(&regions.predicted.cluster_of_node(), &regions.simulated.cluster_of_node())
    }

    fn of(&mut self, predicted: &[Option<usize>], simulated: &[Option<usize>]) -> [Marks; 2] {
        let above = coloured(predicted, &self.predicted, &mut self.next);
        remember(&mut self.predicted, &above);
        // What is predicted here comes before what was simulated elsewhere.
        let known = above.iter().zip(&self.simulated);
        let known: Marks = known.map(|(predicted, before)| predicted.or(*before)).collect();
        let below = coloured(simulated, &known, &mut self.next);
        remember(&mut self.simulated, &below);
        [above, below]
    }
}

/// The colours of clusters, each that of most of its nodes before; new ones by falling size.
fn coloured(cluster_of: &[Option<usize>], before: &[Option<usize>], next: &mut usize) -> Marks {
    let n_clusters = cluster_of.iter().flatten().max().map_or(0, |last| last + 1);
    let mut clusters: Vec<Vec<usize>> = vec![Vec::new(); n_clusters];
    for (node, cluster) in cluster_of.iter().enumerate() {
        cluster.iter().for_each(|&cluster| clusters[cluster].push(node));
    }
    clusters.sort_by_key(|nodes| Reverse(nodes.len()));
    let colours = followed(before, &clusters, next);
    let mut coloured = vec![None; cluster_of.len()];
    for (nodes, colour) in clusters.iter().zip(colours) {
        nodes.iter().for_each(|&node| coloured[node] = Some(colour));
    }
    coloured
}

fn remember(before: &mut Marks, now: &Marks) {
    before.iter_mut().zip(now).for_each(|(before, now)| *before = now.or(*before));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cluster_that_is_a_group_has_its_name() {
        let group = |name: &str, nodes: &[usize]| Group { name: name.into(), nodes: nodes.into() };
        let groups = [group("left", &[0, 2]), group("right", &[1, 3])];
        let names = names(&[Some(7), Some(5), Some(7), None], &groups);
        assert_eq!(names, BTreeMap::from([(7, Label::text("left"))]));
    }

    #[test]
    fn a_cluster_has_one_colour_in_both_rows_and_all_columns() {
        let marks = |marks: &str| -> Marks {
            marks.chars().map(|c| c.to_digit(10).map(|digit| digit as usize)).collect()
        };
        let mut colours = Colours::new(8);
        let [above, below] = colours.of(&marks("00111-22"), &marks("11100022"));
        assert_eq!(above, marks("11000-22"));
        assert_eq!(below, marks("11100022"), "the larger share decides: {below:?}");
        // Clusters numbered otherwise keep their colours, a new one has a new colour.
        let [above, _] = colours.of(&marks("22--0033"), &marks("--------"));
        assert_eq!(above, marks("11--0022"));
        let [above, below] = colours.of(&marks("--------"), &marks("00----11"));
        assert_eq!((above, below), (marks("--------"), marks("11----22")));
    }
}
