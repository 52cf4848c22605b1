//! How keys are written whose value is a list, or one of several things.

/// Each with its key, in which `*` stands for any name.
const SHAPES: [(&str, &str); 27] = [
    ("prepare", "prepare = [\"drop_self_loops\", { symmetrise = \"max\" }]"),
    ("network.file.block", "block = [1, 90], its first and its last row, counted from 1"),
    ("network.file.attributes.position", "position = [\"x\", \"y\"]"),
    ("network.communities.sizes", "sizes = [30, 30, 40]"),
    ("network.communities.probability", "probability = [[0.9, 0.1], [0.1, 0.9]]"),
    ("groups.ranges.*", "left = [1, 30], the first and the last node, counted from 1"),
    ("oscillator.custom.flow.*", "flow = { x = \"y\", y = \"-x\" }, a formula for each component"),
    ("oscillator.custom.map.*", "map = { x = \"4*x*(1 - x)\" }, a formula for each component"),
    ("oscillator.custom.where.*", "where = { f = \"x^2 + y^2\" }"),
    (
        "oscillator.custom.start.*",
        "start = { x = [-1, 1], y = [-1, 1] }, between which states begin",
    ),
    ("coupling.function", "function = { y = \"x\" } or [[0, 0], [1, 0]]"),
    ("coupling.function.*", "function = { y = \"tanh(x)\" }, a formula for each component driven"),
    ("spectrum.modes", "modes = \"auto\", \"all\", 20 or { unstable_at = 0.5 }"),
    ("msf.sigma", "sigma = { from = 0.0, to = 12.0, points = 49 } or [0.0, 0.5, 1.0]"),
    ("prediction.threshold", "threshold = \"exact\" or 0.05"),
    ("sweep.epsilon", "epsilon = { from = 0.5, to = 5.0, points = 10 } or [0.5, 1.0, 2.5]"),
    ("sweep.clusters", "clusters = [[1, 2, 6], [3, 4, 5]], a list of nodes for each cluster"),
    ("sweep.synchronised_below", "synchronised_below = 1e-3 or { of_largest = 0.1 }"),
    ("regions.*", "a number such as 0.05, or { of_largest = 0.1 }"),
    ("figure.eigenvectors", "eigenvectors = [2, 3, 4]"),
    ("figure.layout", "layout = \"circle\", \"force\", \"grouped\" or [[0.0, 0.0], [1.0, 0.5]]"),
    ("figure.mark_modes", "mark_modes = [2, 3]"),
    ("figure.source_transitions", "source_transitions = [0.5, 1.2]"),
    ("atlas.*.published.*.windows", "windows = [[0.2, 4.6], [8.0, inf]]"),
    ("claims.*.where.epsilon", "epsilon = 0.5 or [0.5, 1.0]"),
    ("claims.*.where.modes", "modes = [2, 3]"),
    ("claims.*.where.clusters", "clusters = [[1, 2], [3, 4]]"),
];

/// How the value of a key is written.
pub fn shape(key: &str) -> Option<&'static str> {
    let is_it = |known: &str| {
        let (known, key) = (known.split('.'), key.split('.'));
        known.clone().count() == key.clone().count()
            && known.zip(key).all(|(known, key)| known == "*" || known == key)
    };
    SHAPES.into_iter().find(|(known, _)| is_it(known)).map(|(_, shape)| shape)
}
