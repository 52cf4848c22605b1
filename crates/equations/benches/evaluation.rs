//! Speed of programs.

fn main() {}
