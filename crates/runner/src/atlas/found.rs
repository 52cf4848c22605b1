//! What was found of an atlas.

use claims::Judged;
use experiment::AtlasPlan;
use msf::MasterStability;

/// What was found.
pub struct Found<'a> {
    pub plan: &'a AtlasPlan,
    /// Of all pairs, in order.
    pub curves: &'a [MasterStability],
    pub claims: &'a [Judged],
}
