//! The command `eigensync`; all of it is in the library.

fn main() -> std::process::ExitCode {
    runner::main()
}
