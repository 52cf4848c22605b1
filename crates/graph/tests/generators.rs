//! Generators: exact at probabilities 0 and 1, right in the mean in between, and the same for ever.

use graph::generators::{LinkProbability, communities, hierarchical};
use graph::{GeneratorError, Network, numbered_labels};
use proptest::prelude::*;

fn uniform(within: f64, between: f64) -> LinkProbability {
    LinkProbability::Uniform { within, between }
}

fn matrix<const K: usize>(rows: [[f64; K]; K]) -> LinkProbability {
    LinkProbability::Matrix(rows.map(|row| row.to_vec()).to_vec())
}

/// The six nodes of Fig. 1(a), two of their nine links heavier.
fn six_node() -> Network {
    let unit = [(1, 2), (1, 4), (1, 6), (2, 3), (3, 4), (4, 5), (5, 6)];
    let links = unit.map(|(i, j)| (i - 1, j - 1, 1.0)).into_iter();
    let links: Vec<_> = links.chain([(1, 5, 1.5), (2, 4, 1.5)]).collect();
    Network::undirected(numbered_labels(6), &links).unwrap()
}

/// Number of links between the nodes of each two groups, and within each on the diagonal.
fn block_counts(network: &Network) -> Vec<Vec<f64>> {
    let mut group_of = vec![usize::MAX; network.n_nodes()];
    for (index, group) in network.groups().iter().enumerate() {
        group.nodes.iter().for_each(|&node| group_of[node] = index);
    }
    let n_groups = network.groups().len();
    let mut counts = vec![vec![0.0; n_groups]; n_groups];
    for (_, (i, j)) in network.adjacency() {
        let (a, b) = (group_of[i as usize], group_of[j as usize]);
        counts[a][b] += if a == b { 0.5 } else { 1.0 };
    }
    counts
}

/// Asserts that each block holds p · (number of pairs) links, within 5 binomial deviations, and
/// exactly at p = 0 and 1.
#[track_caller]
fn check_blocks(network: &Network, probability: impl Fn(usize, usize) -> f64) {
    let sizes: Vec<f64> = network.groups().iter().map(|group| group.nodes.len() as f64).collect();
    for (a, row) in block_counts(network).iter().enumerate() {
        for (b, &count) in row.iter().enumerate() {
            let n_pairs =
                if a == b { sizes[a] * (sizes[a] - 1.0) / 2.0 } else { sizes[a] * sizes[b] };
            let p = probability(a, b);
            let (mean, deviation) = (p * n_pairs, (n_pairs * p * (1.0 - p)).sqrt());
            assert!(
                (count - mean).abs() <= 5.0 * deviation,
                "block {a}, {b}: {count} links, expected {mean} ± {deviation}"
            );
        }
    }
}

#[track_caller]
fn check_refused(
    sizes: &[usize],
    probability: &LinkProbability,
    expected: &GeneratorError,
    message: &str,
) {
    let refused = communities(sizes, probability, 1).unwrap_err();
    assert_eq!(&refused, expected);
    assert_eq!(refused.to_string(), message);
}

fn first_links(network: &Network, n_links: usize) -> Vec<(u32, u32)> {
    let upper = network.adjacency().iter().map(|(_, place)| place).filter(|(i, j)| i < j);
    upper.take(n_links).collect()
}

#[test]
fn certain_links_within_communities_make_separate_cliques() {
    let cliques = communities(&[3, 1, 4], &uniform(1.0, 0.0), 5).unwrap();
    assert_eq!(cliques.n_links(), 3 + 6);
    assert_eq!(cliques.components(), [vec![0, 1, 2], vec![3], vec![4, 5, 6, 7]]);
    assert_eq!(cliques.strengths(), [2.0, 2.0, 2.0, 0.0, 3.0, 3.0, 3.0, 3.0]);
}

#[test]
fn certain_links_between_communities_make_a_complete_multipartite_network() {
    let network = communities(&[2, 1, 3], &uniform(0.0, 1.0), 5).unwrap();
    assert_eq!(network.strengths(), [4.0, 4.0, 5.0, 3.0, 3.0, 3.0]);
    let by_matrix = matrix([[0.0, 1.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 0.0]]);
    assert_eq!(network, communities(&[2, 1, 3], &by_matrix, 5).unwrap());
}

#[test]
fn one_certain_community_is_complete_and_an_impossible_one_empty() {
    assert_eq!(communities(&[50], &uniform(1.0, 0.5), 2).unwrap().n_links(), 50 * 49 / 2);
    assert_eq!(communities(&[50], &uniform(0.0, 0.5), 2).unwrap().n_links(), 0);
}

#[test]
fn groups_and_labels_cover_the_nodes_in_order() {
    let network = communities(&[2, 3], &uniform(0.5, 0.5), 1).unwrap();
    assert_eq!(network.labels(), numbered_labels(5));
    let groups: Vec<_> = network.groups().iter().map(|g| (g.name.as_str(), &g.nodes[..])).collect();
    assert_eq!(groups, [("C1", &[0, 1][..]), ("C2", &[2, 3, 4])]);
    assert_eq!(network.positions(), None);
}

#[test]
fn links_have_unit_weight() {
    let network = communities(&[30, 30, 30], &uniform(0.9, 0.05), 1).unwrap();
    assert!(network.adjacency().data().iter().all(|&weight| weight == 1.0));
}

#[test]
fn every_block_has_the_expected_number_of_links() {
    for seed in 0..20 {
        let network = communities(&[40, 70, 100], &uniform(0.3, 0.02), seed).unwrap();
        check_blocks(&network, |a, b| if a == b { 0.3 } else { 0.02 });
        let p = [[0.9, 0.1, 0.0], [0.1, 0.5, 0.01], [0.0, 0.01, 1.0]];
        let network = communities(&[40, 70, 100], &matrix(p), seed).unwrap();
        check_blocks(&network, |a, b| p[a][b]);
    }
}

#[test]
fn counts_scatter_like_a_binomial_and_not_less() {
    // Links within one community of 40 at p = 0.1: mean 78, variance 70.2. Over 2,000 seeds the
    // mean is known to 0.19 and the variance to about 2.2.
    let counts = (0..2000)
        .map(|seed| communities(&[40], &uniform(0.1, 0.0), seed).unwrap().n_links() as f64);
    let counts: Vec<f64> = counts.collect();
    let mean = counts.iter().sum::<f64>() / 2000.0;
    let variance = counts.iter().map(|c| (c - mean).powi(2)).sum::<f64>() / 1999.0;
    assert!((mean - 78.0).abs() < 5.0 * 0.19, "mean {mean}");
    assert!((variance - 70.2).abs() < 5.0 * 2.2, "variance {variance}");
}

#[test]
fn every_pair_is_linked_equally_often() {
    // 2,000 seeds at p = 0.3: each of the 66 pairs of [5, 4, 3] is linked 600 ± 20.5 times.
    for probability in [uniform(0.3, 0.3), matrix([[0.3; 3]; 3])] {
        let mut counts = vec![[0.0f64; 12]; 12];
        for seed in 0..2000 {
            let network = communities(&[5, 4, 3], &probability, seed).unwrap();
            for (_, (i, j)) in network.adjacency() {
                counts[i as usize][j as usize] += 1.0;
            }
        }
        for i in 0..12 {
            for j in (0..12).filter(|&j| j != i) {
                assert!((counts[i][j] - 600.0).abs() < 5.0 * 20.5, "{i}–{j}: {}", counts[i][j]);
            }
        }
    }
}

#[test]
fn degrees_have_binomial_mean_and_variance() {
    // Degrees of 4,000 nodes at p = 0.01: mean 39.99, variance 39.59, each the sum of 3,999 trials.
    let network = communities(&[4000], &uniform(0.01, 0.0), 11).unwrap();
    let degrees = network.strengths();
    let mean = degrees.iter().sum::<f64>() / 4000.0;
    let variance = degrees.iter().map(|k| (k - mean).powi(2)).sum::<f64>() / 3999.0;
    // Deviation of the mean: √(2 p (1 − p) / N (N − 1)) (N − 1); of the variance: s² √(2 / N).
    assert!((mean - 39.99).abs() < 5.0 * 0.14, "mean {mean}");
    assert!((variance - 39.59).abs() < 5.0 * 0.89, "variance {variance}");
}

#[test]
fn a_seed_means_the_same_communities_for_ever() {
    let network = communities(&[30, 30, 30], &uniform(0.9, 0.05), 1).unwrap();
    assert_eq!(network, communities(&[30, 30, 30], &uniform(0.9, 0.05), 1).unwrap());
    assert_ne!(network, communities(&[30, 30, 30], &uniform(0.9, 0.05), 2).unwrap());
    // A second implementation, in Python, gives the same; a change would change every experiment
    // on communities.
    assert_eq!((network.n_links(), checksum(&network)), (1317, 15305869627895272411));
    let sparse = communities(&[1000; 3], &uniform(0.001, 0.0002), 1).unwrap();
    assert_eq!(first_links(&sparse, 4), [(0, 961), (1, 267), (2, 238), (2, 1213)]);
    assert_eq!((sparse.n_links(), checksum(&sparse)), (2083, 17195257077596501795));
    let p = [[0.001, 0.0002], [0.0002, 0.002]];
    let by_matrix = communities(&[1000; 2], &matrix(p), 1).unwrap();
    assert_eq!(first_links(&by_matrix, 4), [(0, 961), (0, 1731), (1, 267), (1, 1746)]);
    assert_eq!((by_matrix.n_links(), checksum(&by_matrix)), (1692, 1693792915146900527));
}

#[test]
fn a_seed_means_the_same_hierarchy_for_ever() {
    let network = hierarchical(&six_node(), 30, 0.9, 0.05, 1).unwrap();
    // A second implementation, in Python, gives the same; a change would change every experiment
    // on hierarchical networks.
    assert_eq!((network.n_links(), checksum(&network)), (2768, 4483445773249837825));
    assert_eq!(network, hierarchical(&six_node(), 30, 0.9, 0.05, 1).unwrap());
    assert_ne!(network, hierarchical(&six_node(), 30, 0.9, 0.05, 2).unwrap());
}

/// The places of all links in one number (FNV-1a, 64 bits).
fn checksum(network: &Network) -> u64 {
    let mix = |hash: u64, node: u32| (hash ^ u64::from(node)).wrapping_mul(0x0100_0000_01b3);
    let places = network.adjacency().iter().map(|(_, place)| place);
    places.fold(0xcbf2_9ce4_8422_2325, |hash, (i, j)| mix(mix(hash, i), j))
}

#[test]
fn a_hierarchical_network_follows_the_weights_of_its_backbone() {
    for seed in 0..20 {
        let network = hierarchical(&six_node(), 30, 0.9, 0.05, seed).unwrap();
        let weight = |a, b| six_node().adjacency().get(a, b).copied().unwrap_or(0.0);
        check_blocks(&network, |a, b| if a == b { 0.9 } else { 0.05 * weight(a, b) });
        assert_eq!(network.groups()[5].name, "C6");
    }
}

#[test]
fn a_hierarchical_network_is_one_of_communities_with_the_backbone_as_matrix() {
    let backbone = six_node();
    let entry =
        |a, b| if a == b { 0.9 } else { *backbone.adjacency().get(a, b).unwrap_or(&0.0) * 0.05 };
    let rows = (0..6).map(|a| (0..6).map(|b| entry(a, b)).collect()).collect();
    let by_matrix = communities(&[30; 6], &LinkProbability::Matrix(rows), 9).unwrap();
    assert_eq!(hierarchical(&backbone, 30, 0.9, 0.05, 9).unwrap(), by_matrix);
}

#[test]
fn the_factor_may_take_the_heaviest_link_to_certainty() {
    let pair = Network::undirected(numbered_labels(3), &[(0, 2, 2.0)]).unwrap();
    let network = hierarchical(&pair, 2, 0.0, 0.5, 1).unwrap();
    assert_eq!(network.components(), [vec![0, 1, 4, 5], vec![2], vec![3]]);
    assert_eq!(network.n_links(), 4);
}

#[test]
fn a_hundred_thousand_communities_need_no_matrix() {
    let network = communities(&vec![3; 100_000], &uniform(1.0, 1e-5), 4).unwrap();
    // 3 links in each community; between them 1e-5 of 4.49997e10 pairs, ± 671.
    assert!((network.n_links() as f64 - 300_000.0 - 449_997.0).abs() < 5.0 * 671.0);
}

#[test]
fn communities_need_nodes() {
    let half = uniform(0.5, 0.5);
    check_refused(&[], &half, &GeneratorError::NoCommunities, "there are no communities");
    check_refused(
        &[3, 0],
        &half,
        &GeneratorError::EmptyCommunity { community: 2 },
        "community 2 has 0 nodes; expected at least one",
    );
    let n_nodes = usize::MAX;
    check_refused(
        &[n_nodes, 2],
        &half,
        &GeneratorError::TooManyNodes { n_nodes },
        "18446744073709551615 nodes are more than the 4294967295 that can be numbered",
    );
    let empty = hierarchical(&six_node(), 0, 0.5, 0.1, 1).unwrap_err();
    assert_eq!(empty, GeneratorError::EmptyCommunity { community: 1 });
}

#[test]
fn more_links_than_memory_holds_are_refused_before_they_are_made() {
    check_refused(
        &[1_000_000],
        &uniform(0.9, 0.0),
        &GeneratorError::TooManyLinks { expected: 449_999_550_000.0, limit: 4_294_967_295.0 },
        "these probabilities give 449999550000 links or more; expected at most 4294967295",
    );
}

#[test]
fn probabilities_lie_between_zero_and_one() {
    check_refused(
        &[2, 2],
        &uniform(1.5, 0.1),
        &GeneratorError::BadWithin { value: 1.5 },
        "the probability of a link within a community is 1.5; expected 0 to 1",
    );
    check_refused(
        &[2, 2],
        &uniform(0.5, -0.1),
        &GeneratorError::BadBetween { value: -0.1 },
        "the probability of a link between communities is -0.1; expected 0 to 1",
    );
    check_refused(
        &[2, 2],
        &matrix([[0.5, 0.1], [2.0, 0.5]]),
        &GeneratorError::BadEntry { row: 2, column: 1, value: 2.0 },
        "row 2, column 1 of the probability matrix is 2; expected 0 to 1",
    );
    for nan in [uniform(f64::NAN, 0.5), uniform(0.5, f64::NAN), matrix([[f64::NAN]])] {
        assert!(communities(&[2], &nan, 1).is_err());
    }
    let within = hierarchical(&six_node(), 2, -1.0, 0.1, 1).unwrap_err();
    assert_eq!(within, GeneratorError::BadWithin { value: -1.0 });
}

#[test]
fn a_probability_matrix_is_square_and_symmetric() {
    check_refused(
        &[2, 2],
        &matrix([[0.5]]),
        &GeneratorError::WrongRowCount { n_rows: 1, n_communities: 2 },
        "the probability matrix has 1 rows; expected one for each of the 2 communities",
    );
    check_refused(
        &[2, 2],
        &LinkProbability::Matrix(vec![vec![0.5, 0.1], vec![0.1]]),
        &GeneratorError::WrongRowLength { row: 2, length: 1, n_communities: 2 },
        "row 2 of the probability matrix has 1 entries; expected one for each of the 2 communities",
    );
    check_refused(
        &[2, 2],
        &matrix([[0.5, 0.1], [0.2, 0.5]]),
        &GeneratorError::NotSymmetric { row: 2, column: 1, value: 0.2, transposed: 0.1 },
        "the probability matrix is not symmetric: row 2, column 1 is 0.2, but row 1, column 2 is \
         0.1",
    );
}

#[test]
fn a_factor_that_makes_a_probability_above_one_is_refused() {
    let refused = hierarchical(&six_node(), 2, 0.9, 0.75, 1).unwrap_err();
    assert_eq!(
        refused.to_string(),
        "the link 2–6 of weight 1.5 times the factor 0.75 gives the probability 1.125; expected at \
         most 1"
    );
    for factor in [-0.1, f64::INFINITY] {
        let refused = hierarchical(&six_node(), 2, 0.9, factor, 1).unwrap_err();
        assert_eq!(refused, GeneratorError::BadFactor { factor });
    }
}

proptest! {
    #[test]
    fn groups_are_consecutive_and_cover_every_node(
        sizes in prop::collection::vec(1usize..20, 1..8),
        within in 0.0..=1.0,
        between in 0.0..=1.0,
        seed: u64,
    ) {
        let network = communities(&sizes, &uniform(within, between), seed).unwrap();
        let listed: Vec<usize> = network.groups().iter().flat_map(|g| g.nodes.clone()).collect();
        prop_assert!(listed.into_iter().eq(0..network.n_nodes()));
        let found: Vec<usize> = network.groups().iter().map(|g| g.nodes.len()).collect();
        prop_assert_eq!(found, sizes);
    }
}
