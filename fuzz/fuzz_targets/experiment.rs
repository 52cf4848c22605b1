//! Any text as an experiment file: read, or refused with a message that names the file and is short.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    if let Err(message) = experiment::check_syntax(text) {
        assert!(message.starts_with("experiment.toml"), "{message}");
        assert!(message.len() < 2000, "{} bytes: {message}", message.len());
    }
});
