//! Values of keys that are left out.

pub(super) fn one() -> u64 {
    1
}

pub(super) fn four() -> u64 {
    4
}

pub(super) fn escape_radius() -> f64 {
    dynamics::ESCAPE_RADIUS
}

pub(super) fn per_mille() -> f64 {
    1e-3
}

pub(crate) fn millionth() -> f64 {
    1e-6
}

pub(super) fn rounding_kick() -> f64 {
    dynamics::ROUNDING_KICK
}

pub(super) fn thousand() -> f64 {
    1e3
}

pub(super) fn ten_thousand() -> f64 {
    1e4
}

pub(super) fn hundred_thousand() -> f64 {
    1e5
}
