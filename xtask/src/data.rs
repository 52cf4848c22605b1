//! `cargo xtask data`: brings the connectomes that we may not redistribute into `data/`.
//!
//! Each file comes from the first of these that has it with the right SHA-256: `$EIGENSYNC_DATA`,
//! `../shared/data`, the public address. Downloads go through curl, which shows progress and takes
//! up a broken download where it ended.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::Command;

use sha2::{Digest, Sha256};

use crate::root;

/// Options of `cargo xtask data`.
#[derive(clap::Args)]
pub struct Args {
    /// Say where each file stands, without fetching any
    #[arg(long)]
    check: bool,
}

/// A file of somebody else's data.
struct DataFile {
    name: &'static str,
    /// What it is and where it comes from.
    content: &'static str,
    address: &'static str,
    sha256: &'static str,
}

const FILES: [DataFile; 2] = [
    DataFile {
        name: "cat.mat",
        content: "cortex of the cat: Scannell et al. (1995), by way of the Brain Connectivity Toolbox",
        address: "https://raw.githubusercontent.com/rkdan/small_world_propensity/6ce813ed93b04bcf1261a836db0e9f017fe6fec5/data/cat.mat",
        sha256: "2b029957a5d9f23247335e5b82d3c5425b8aec6c0bcd06b9174711409446c3da",
    },
    DataFile {
        name: "connectivity_998.zip",
        content: "human cortex: Hagmann et al. (2008), by way of The Virtual Brain",
        address: "https://raw.githubusercontent.com/the-virtual-brain/tvb-data/f1a3e7dc5370158df721f206c9c9bfad55d98172/tvb_data/connectivity/connectivity_998.zip",
        sha256: "31c65d4b6bf1760d06e0c4ab95c71c8dd499e48814e47bf2284e62a2b9301afd",
    },
];

/// Where data are looked for and kept.
struct Places {
    kept: PathBuf,
    /// Folders that may have the files, in the order in which they are asked.
    folders: Vec<PathBuf>,
    /// Stands before a file's name in place of its public address, for a mirror.
    mirror: Option<String>,
}

/// Brings every file and gives 0 when all are there, 1 when some could not be had.
pub fn run(args: &Args) -> Result<u8, String> {
    let places = Places::of_this_project();
    let missing = FILES.iter().filter(|file| {
        let outcome = if args.check { places.check(file) } else { places.bring(file) };
        !said(file, &outcome)
    });
    let missing = missing.count();
    if missing > 0 {
        println!("\n{HINT}");
    }
    Ok(u8::from(missing > 0))
}

/// Brings the files that are not here yet, for a task that can go on without them.
pub fn bring_missing() {
    let places = Places::of_this_project();
    let absent = FILES.iter().filter(|file| places.check(file).is_err());
    let refused = absent.filter(|file| !said(file, &places.bring(file))).count();
    if refused > 0 {
        println!("{HINT}; the experiments that need it are left out\n");
    }
}

const HINT: &str = "hint: download what is missing from the address named above into a folder, \
    and name that folder in EIGENSYNC_DATA";

/// Says how it went with one file; gives whether it is here.
fn said(file: &DataFile, outcome: &Result<String, String>) -> bool {
    match outcome {
        Ok(how) => println!("{}: {how}", file.name),
        Err(why) => println!("{}: not here ({}): {why}", file.name, file.content),
    }
    outcome.is_ok()
}

impl Places {
    fn of_this_project() -> Self {
        let own = std::env::var_os("EIGENSYNC_DATA").map(PathBuf::from);
        Self {
            kept: root().join("data"),
            folders: own.into_iter().chain([root().join("../shared/data")]).collect(),
            mirror: std::env::var("EIGENSYNC_DATA_MIRROR").ok(),
        }
    }

    fn check(&self, file: &DataFile) -> Result<String, String> {
        verified(&self.kept.join(file.name), file)?;
        Ok("here, and its checksum is right".into())
    }

    /// Makes sure that a file is in `data/`, whole and with the right checksum.
    fn bring(&self, file: &DataFile) -> Result<String, String> {
        if let Ok(said) = self.check(file) {
            return Ok(said);
        }
        fs::create_dir_all(&self.kept).map_err(|e| format!("{} : {e}", self.kept.display()))?;
        let mut refusals = Vec::new();
        for folder in &self.folders {
            match verified(&folder.join(file.name), file).and_then(|whole| self.keep(&whole, file))
            {
                Ok(()) => return Ok(format!("copied from {}", folder.display())),
                Err(why) => refusals.push(why),
            }
        }
        match self.download(file) {
            Ok(()) => Ok("downloaded, and its checksum is right".into()),
            Err(why) => {
                refusals.push(why);
                Err(refusals.join("; "))
            }
        }
    }

    /// Copies beside the place and renames, so that a killed copy does not look like the file.
    fn keep(&self, whole: &Path, file: &DataFile) -> Result<(), String> {
        let part = self.part(file);
        fs::copy(whole, &part)
            .and_then(|_| fs::rename(&part, self.kept.join(file.name)))
            .map_err(|error| format!("{} cannot be copied: {error}", whole.display()))
    }

    fn download(&self, file: &DataFile) -> Result<(), String> {
        let part = self.part(file);
        let address = match &self.mirror {
            Some(mirror) => format!("{}/{}", mirror.trim_end_matches('/'), file.name),
            None => file.address.to_owned(),
        };
        eprintln!("{}: from {address}", file.name);
        let status = Command::new("curl")
            .args([
                "--fail",
                "--location",
                "--progress-bar",
                "--retry",
                "3",
                "--connect-timeout",
                "20",
            ])
            .args(["--continue-at", "-", "--output"])
            .arg(&part)
            .arg(&address)
            .status()
            .map_err(|error| format!("curl cannot be started: {error}"))?;
        if !status.success() {
            return Err(format!("{address} could not be downloaded"));
        }
        if let Err(why) = verified(&part, file) {
            // A wrong file would be taken up again for ever.
            let _ = fs::remove_file(&part);
            return Err(why);
        }
        fs::rename(&part, self.kept.join(file.name))
            .map_err(|error| format!("{} cannot be put in place: {error}", part.display()))
    }

    fn part(&self, file: &DataFile) -> PathBuf {
        self.kept.join(format!(".{}.part", file.name))
    }
}

/// The path, if it is a file with the checksum that we know.
fn verified(path: &Path, file: &DataFile) -> Result<PathBuf, String> {
    let mut source =
        fs::File::open(path).map_err(|error| format!("{}: {error}", path.display()))?;
    let mut hash = Sha256::new();
    let mut buffer = vec![0; 1 << 16];
    loop {
        let read =
            source.read(&mut buffer).map_err(|error| format!("{}: {error}", path.display()))?;
        if read == 0 {
            break;
        }
        hash.update(&buffer[..read]);
    }
    let found: String = hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect();
    if found == file.sha256 {
        return Ok(path.to_owned());
    }
    Err(format!("{} has the SHA-256 {found}, not {}", path.display(), file.sha256))
}

#[cfg(test)]
mod tests {
    use std::io::{BufRead, BufReader, Write};
    use std::net::TcpListener;

    use super::*;

    /// "hello" and its SHA-256.
    const HELLO: DataFile = DataFile {
        name: "hello",
        content: "a greeting",
        address: "http://127.0.0.1:9/never/asked",
        sha256: "2cf24dba5fb0a30e26e83b2ac5b9e29e1b161e5c1fa7425e73043362938b9824",
    };

    fn places(name: &str, folders: Vec<PathBuf>, mirror: Option<String>) -> Places {
        let kept =
            std::env::temp_dir().join(format!("eigensync-data-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&kept);
        fs::create_dir_all(&kept).unwrap();
        Places { kept: kept.join("data"), folders, mirror }
    }

    fn folder_with(places: &Places, content: &str) -> PathBuf {
        let folder = places.kept.with_file_name("folder");
        fs::create_dir_all(&folder).unwrap();
        fs::write(folder.join("hello"), content).unwrap();
        folder
    }

    /// Serves "hello" to so many requests, honouring a range; gives the address and, when done, the
    /// ranges asked for.
    fn serve(requests: usize) -> (String, std::thread::JoinHandle<Vec<Option<usize>>>) {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = format!("http://{}", listener.local_addr().unwrap());
        let server = std::thread::spawn(move || {
            let mut ranges = Vec::new();
            for stream in listener.incoming().take(requests) {
                let mut stream = stream.unwrap();
                let lines = BufReader::new(stream.try_clone().unwrap()).lines();
                let head: Vec<String> =
                    lines.map(Result::unwrap).take_while(|l| !l.is_empty()).collect();
                let range = head.iter().find_map(|line| {
                    let line = line.to_ascii_lowercase();
                    line.strip_prefix("range: bytes=")?.trim_end_matches('-').parse().ok()
                });
                let body = &"hello"[range.unwrap_or(0)..];
                let status = match range {
                    Some(from) => format!("206 Partial Content\r\nContent-Range: bytes {from}-4/5"),
                    None => "200 OK".into(),
                };
                let length = body.len();
                write!(stream, "HTTP/1.1 {status}\r\nContent-Length: {length}\r\nConnection: close\r\n\r\n{body}")
                    .unwrap();
                ranges.push(range);
            }
            ranges
        });
        (address, server)
    }

    #[test]
    fn a_folder_with_the_right_file_is_copied_from() {
        let mut places = places("folder", vec![], None);
        places.folders = vec![folder_with(&places, "hello")];
        assert!(places.bring(&HELLO).unwrap().contains("copied"));
        assert!(places.bring(&HELLO).unwrap().contains("here"));
    }

    #[test]
    fn a_file_with_another_checksum_is_refused_with_both_checksums() {
        let mut places = places("wrong", vec![], Some("http://127.0.0.1:9".into()));
        places.folders = vec![folder_with(&places, "hullo")];
        let refused = places.bring(&HELLO).unwrap_err();
        assert!(
            refused.contains(HELLO.sha256) && refused.contains("could not be downloaded"),
            "{refused}"
        );
        assert!(!places.kept.join("hello").exists());
    }

    #[test]
    fn a_broken_download_is_taken_up_where_it_ended() {
        let (address, server) = serve(1);
        let places = places("resume", vec![], Some(address));
        fs::create_dir_all(&places.kept).unwrap();
        fs::write(places.part(&HELLO), "hel").unwrap();
        assert!(places.bring(&HELLO).unwrap().contains("downloaded"));
        assert_eq!(server.join().unwrap(), [Some(3)]);
        assert_eq!(fs::read(places.kept.join("hello")).unwrap(), b"hello");
    }
}
