//! `membership.csv`: every node in every predicted state, one flat table, from strong coupling down.
//! Clusters go by their numbers in `cascade.csv`.

use clustering::CascadeTree;

use crate::cascade_files::numbered;
use eigensync::Findings;
use experiment::Plan;
use results_folder::Folder;
use user::Result;
use user::text::number;

/// With more rows the table is left out: `clusters.csv` says the same in one row a node.
const MOST_ROWS: usize = 2_000_000;

const COLUMNS: [&str; 5] = ["state", "epsilon_from", "epsilon_to", "node", "cluster"];

/// Writes the table, unless it has too many rows.
pub fn write(folder: &Folder, plan: &Plan, findings: &Findings) -> Result<()> {
    let labels = plan.study.network.labels();
    if labels.len().saturating_mul(findings.cascade.len()) > MOST_ROWS {
        return Ok(());
    }
    folder.write_through("membership.csv", |out| {
        let mut table = csv::Writer::from_writer(out);
        table.write_record(COLUMNS)?;
        for (_, first, tree) in numbered(findings) {
            for place in tree.states.clone() {
                let state = &findings.cascade[place];
                let numbers = numbers(tree, first, place, state.clusters.cluster_of());
                let (from, to) = state.epsilon;
                let [from, to] = [number(from), to.map_or_else(String::new, number)];
                let at = (place + 1).to_string();
                for (label, &cluster) in labels.iter().zip(state.clusters.cluster_of()) {
                    table.write_record([&at, &from, &to, label, &numbers[cluster]])?;
                }
            }
        }
        table.flush()
    })
}

/// The number in `cascade.csv` of each cluster of one state, empty for nodes alone.
fn numbers(tree: &CascadeTree, first: usize, state: usize, cluster_of: &[usize]) -> Vec<String> {
    let n_clusters = cluster_of.iter().max().map_or(0, |last| last + 1);
    let mut numbers = vec![String::new(); n_clusters];
    for (place, cluster) in tree.clusters.iter().enumerate() {
        if cluster.states.contains(&state) {
            numbers[cluster_of[cluster.first_node]] = (first + place).to_string();
        }
    }
    numbers
}
