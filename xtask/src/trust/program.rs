//! The command under trial: started with limits on memory and time, and its answer.

use std::fs::{self, File};
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// Most address space that a command may take, in kB.
const MEMORY_KB: u64 = 2 << 20;
/// A run that is asked to stop does so within this time.
pub const STOPS: Duration = Duration::from_secs(1);
/// How often a running command is looked at.
const LOOK: Duration = Duration::from_millis(2);
/// Exit status of a Rust program that panicked.
const PANICKED: i32 = 101;

/// The program, and how it is started.
#[derive(Clone)]
pub struct Program {
    path: PathBuf,
}

/// A command that runs.
pub struct Running {
    child: Child,
    started: Instant,
    said: PathBuf,
}

/// How a command ended.
pub struct Answer {
    pub status: ExitStatus,
    pub stderr: String,
    pub took: Duration,
    /// Whether it had to be ended because it took too long.
    pub too_long: bool,
}

impl Program {
    pub fn new(path: &Path) -> Self {
        Self { path: path.to_owned() }
    }

    /// The command in a folder, on two threads, started by `before` if that is not empty.
    pub fn command(&self, folder: &Path, before: &[&str], arguments: &[&str]) -> Command {
        let script = format!("ulimit -v {MEMORY_KB}; exec \"$@\"");
        let mut command = Command::new("sh");
        command.args(["-c", &script, "sh"]).args(before).arg(&self.path).args(arguments);
        command.current_dir(folder).env("RAYON_NUM_THREADS", "2");
        command.env("OPENBLAS_NUM_THREADS", "1").env_remove("RUST_BACKTRACE");
        command.stdin(Stdio::null()).stdout(Stdio::null());
        command
    }

    /// Starts it; what it says on standard error is kept in a file beside the folder.
    pub fn start(
        &self,
        folder: &Path,
        before: &[&str],
        arguments: &[&str],
    ) -> Result<Running, String> {
        let said = folder.with_extension("stderr");
        Running::start(self.command(folder, before, arguments), said)
    }

    /// Runs it to its end, which must come within a time.
    pub fn run(
        &self,
        folder: &Path,
        arguments: &[&str],
        limit: Duration,
    ) -> Result<Answer, String> {
        self.start(folder, &[], arguments)?.end(limit)
    }
}

impl Running {
    /// Starts a command that says its errors into a file.
    pub fn start(mut command: Command, said: PathBuf) -> Result<Self, String> {
        let file = File::create(&said).map_err(|error| format!("{}: {error}", said.display()))?;
        let child = command.stderr(file).spawn();
        let child = child.map_err(|error| format!("the program cannot be started: {error}"))?;
        Ok(Self { child, started: Instant::now(), said })
    }

    /// Waits a while; false if the command ended before.
    pub fn lasts(&mut self, time: Duration) -> Result<bool, String> {
        let until = Instant::now() + time;
        while Instant::now() < until {
            if self.child.try_wait().map_err(|error| error.to_string())?.is_some() {
                return Ok(false);
            }
            std::thread::sleep(LOOK.min(time));
        }
        Ok(true)
    }

    /// Sends a signal, by its name.
    pub fn signal(&mut self, name: &str) -> Result<(), String> {
        let sent = Command::new("kill")
            .args([&format!("-{name}"), &self.child.id().to_string()])
            .stderr(Stdio::null())
            .status();
        // A command that has just ended cannot be sent any.
        sent.map(drop).map_err(|error| format!("kill cannot be started: {error}"))
    }

    /// Waits for the end, and brings it about after a time.
    pub fn end(mut self, limit: Duration) -> Result<Answer, String> {
        let too_long = self.lasts(limit)?;
        if too_long {
            let _ = self.child.kill();
        }
        let status = self.child.wait().map_err(|error| error.to_string())?;
        let took = self.started.elapsed();
        // A device that is always full can be read without end.
        let said = if self.said.is_file() { fs::read(&self.said) } else { Ok(Vec::new()) };
        let said = said.map_err(|error| error.to_string())?;
        let stderr = String::from_utf8_lossy(&said).into_owned();
        Ok(Answer { status, stderr, took, too_long })
    }
}

impl Answer {
    /// Neither a signal that nobody sent, nor a panic, nor too long.
    pub fn is_civil(&self) -> Result<(), String> {
        let why = match (self.status.code(), self.status.signal()) {
            _ if self.too_long => format!("still running after {:.1} s", self.took.as_secs_f64()),
            (Some(PANICKED), _) => "panicked".to_owned(),
            (_, Some(signal)) => format!("ended by signal {signal}"),
            // What a shell says of a command that a signal ended.
            (Some(code), _) if code > 128 + 2 && code != 128 + 15 => format!("exit status {code}"),
            _ => return Ok(()),
        };
        Err(format!("{why}\n{}", self.stderr))
    }

    /// The exit status is one of these.
    pub fn is_one_of(&self, expected: &[i32]) -> Result<(), String> {
        self.is_civil()?;
        match self.status.code() {
            Some(code) if expected.contains(&code) => Ok(()),
            code => {
                Err(format!("exit status {code:?}, expected one of {expected:?}\n{}", self.stderr))
            }
        }
    }
}
