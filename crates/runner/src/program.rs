//! Which program computes: its version, and the commit that it was built from.

use std::sync::LazyLock;

/// Version of eigensync.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
/// Commit of eigensync; `+` when files were changed since.
pub const COMMIT: &str = env!("EIGENSYNC_COMMIT");

/// What this program is known by, so that no other takes over what it has computed.
pub fn name() -> &'static str {
    &NAME
}

/// A build from changed files has no name of its own, and goes by its file.
static NAME: LazyLock<String> = LazyLock::new(|| {
    let of_commit = format!("{VERSION} {COMMIT}");
    if !COMMIT.ends_with('+') && COMMIT != "unknown" {
        return of_commit;
    }
    let file = std::env::current_exe().and_then(std::fs::metadata);
    let build = file.and_then(|file| Ok((file.len(), file.modified()?)));
    format!("{of_commit} {build:?}")
});
