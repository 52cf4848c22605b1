//! Readers of network formats.
