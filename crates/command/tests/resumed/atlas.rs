//! An atlas that is stopped goes on with the curves it has.

use super::*;

/// Logistic maps, of which each has one curve that takes a tenth of a second.
fn atlas() -> String {
    let map = |k| format!("[atlas.map_{k}]\noscillator.logistic = {{ r = 3.9{k} }}\n");
    let maps: String = (0..8).map(map).collect();
    format!("title = \"Eight maps\"\n[msf]\npoints = 33\naverage = 2e4\n{maps}")
}

#[test]
fn an_atlas_that_was_killed_takes_over_its_curves_and_ends_with_the_same_numbers() {
    let made = |place: &Workplace| {
        place.answer(&["run", "tiny.toml"]).with_status(0);
        numbers(place)
    };
    let [undisturbed, killed] = [0, 1].map(|_| {
        let place = Workplace::new();
        place.write("tiny.toml", atlas());
        place
    });
    let expected = made(&undisturbed);
    send_when(start(&killed, &["run", "tiny.toml"]), "KILL", || in_journal(&killed).0);
    let obtained = made(&killed);
    assert!(taken_over(&killed)["curves"].as_u64().unwrap() > 0, "{}", taken_over(&killed));
    for ((name, found), (_, expected)) in obtained.iter().zip(&expected) {
        assert!(found == expected, "{name} is another");
    }
}
