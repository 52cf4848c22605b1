//! The records of which journals and snapshots are made:
//!
//! ```text
//! mark 8 | kind 1 | key 32 | length 8 | sum of the head 8 | payload | sum of head and payload 16
//! ```
//!
//! Numbers are little-endian; sums are the first bytes of a SHA-256. The head has a sum of its own so
//! that, after a record that was damaged, the next one is found again: a mark followed by a head whose
//! sum is right does not occur by chance.

use std::io::{self, BufWriter, ErrorKind, Read, Seek, SeekFrom, Write};

use sha2::{Digest, Sha256};

use crate::{Key, Kind};

const MARK: [u8; 8] = *b"eigsync1";
/// Bytes of a head without and with its sum, and of the sum at the end.
const SUMMED: usize = MARK.len() + 1 + 32 + 8;
pub const HEAD: usize = SUMMED + 8;
const SUM: usize = 16;

/// Bytes that are read at a time.
const CHUNK: usize = 1 << 16;

/// A record that was found whole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    pub kind: Kind,
    pub key: Key,
    /// Where its payload stands.
    pub at: u64,
    pub length: u64,
}

/// What a file of records holds.
#[derive(Debug, Default, PartialEq)]
pub struct Contents {
    /// In the order in which they stand.
    pub records: Vec<Found>,
    /// Stretches between whole records that are none.
    pub damaged: usize,
    /// Where the last whole record ends; what comes after it was never finished, or is damaged.
    pub end: u64,
}

/// Writes a record, through a buffer: a small one goes into a file at once, and a large payload is not
/// copied. Gives the bytes written.
pub fn write(file: impl Write, kind: Kind, key: &Key, payload: &[u8]) -> io::Result<u64> {
    let mut head = Vec::with_capacity(HEAD);
    head.extend(MARK);
    head.push(kind as u8);
    head.extend(key.0);
    head.extend((payload.len() as u64).to_le_bytes());
    head.extend(&Sha256::digest(&head)[..HEAD - SUMMED]);
    let sum = Sha256::new_with_prefix(&head).chain_update(payload).finalize();
    let mut file = BufWriter::new(file);
    file.write_all(&head)?;
    file.write_all(payload)?;
    file.write_all(&sum[..SUM])?;
    file.flush()?;
    Ok((HEAD + payload.len() + SUM) as u64)
}

/// Goes through a file of so many bytes and finds its whole records. Nothing in it is believed that
/// its sum does not confirm.
pub fn scan(file: &mut (impl Read + Seek), n_bytes: u64) -> io::Result<Contents> {
    let mut contents = Contents::default();
    let (mut at, mut in_damage) = (0, false);
    while at < n_bytes {
        let whole = match head(file, at, n_bytes)? {
            Some((found, bytes)) => payload_is_right(file, &found, &bytes)?.then_some(found),
            None => None,
        };
        if let Some(found) = whole {
            contents.damaged += usize::from(in_damage);
            in_damage = false;
            at = found.at + found.length + SUM as u64;
            contents.end = at;
            contents.records.push(found);
        } else {
            in_damage = true;
            at = next_mark(file, at + 1)?.unwrap_or(n_bytes);
        }
    }
    Ok(contents)
}

/// Reads a payload that was found.
pub fn payload(file: &mut (impl Read + Seek), found: &Found) -> io::Result<Vec<u8>> {
    file.seek(SeekFrom::Start(found.at))?;
    let length = usize::try_from(found.length).map_err(io::Error::other)?;
    let mut bytes = vec![0; length];
    file.read_exact(&mut bytes)?;
    Ok(bytes)
}

/// The head at a place, if there is one and its record fits the file.
fn head(
    file: &mut (impl Read + Seek),
    at: u64,
    n_bytes: u64,
) -> io::Result<Option<(Found, [u8; HEAD])>> {
    let mut bytes = [0; HEAD];
    file.seek(SeekFrom::Start(at))?;
    match file.read_exact(&mut bytes) {
        Err(error) if error.kind() == ErrorKind::UnexpectedEof => return Ok(None),
        read => read?,
    }
    let (summed, sum) = bytes.split_at(SUMMED);
    if !summed.starts_with(&MARK) || Sha256::digest(summed)[..HEAD - SUMMED] != *sum {
        return Ok(None);
    }
    let (kind, key) = (Kind::of(summed[MARK.len()]), &summed[MARK.len() + 1..][..32]);
    let (Some(kind), Ok(key)) = (kind, key.try_into().map(Key)) else { return Ok(None) };
    let length = summed[SUMMED - 8..].try_into().map_or(u64::MAX, u64::from_le_bytes);
    let found = Found { kind, key, at: at + HEAD as u64, length };
    let fits = length <= n_bytes && found.at + length + SUM as u64 <= n_bytes;
    Ok(fits.then_some((found, bytes)))
}

fn payload_is_right(
    file: &mut (impl Read + Seek),
    found: &Found,
    head: &[u8; HEAD],
) -> io::Result<bool> {
    let mut hash = Sha256::new_with_prefix(head);
    let mut chunk = vec![0; CHUNK];
    let mut left = found.length;
    file.seek(SeekFrom::Start(found.at))?;
    while left > 0 {
        let now = usize::try_from(left).map_or(CHUNK, |left| left.min(CHUNK));
        file.read_exact(&mut chunk[..now])?;
        hash.update(&chunk[..now]);
        left -= now as u64;
    }
    let mut sum = [0; SUM];
    file.read_exact(&mut sum)?;
    Ok(hash.finalize()[..SUM] == sum)
}

/// Where the next mark stands, from a place on. A whole chunk of zeros ends the search: it is a hole
/// in a file, of any size, or was never written, and what comes after it was not either.
fn next_mark(file: &mut (impl Read + Seek), from: u64) -> io::Result<Option<u64>> {
    let (mut at, mut bytes) = (from, Vec::with_capacity(CHUNK));
    loop {
        bytes.clear();
        file.seek(SeekFrom::Start(at))?;
        file.by_ref().take(CHUNK as u64).read_to_end(&mut bytes)?;
        if let Some(position) = bytes.windows(MARK.len()).position(|window| window == MARK) {
            return Ok(Some(at + position as u64));
        }
        if bytes.len() < MARK.len() || bytes == [0; CHUNK] {
            return Ok(None);
        }
        // A mark may begin in this chunk and end in the next.
        at += (bytes.len() - MARK.len() + 1) as u64;
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    fn encode(kind: Kind, key: &Key, payload: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::new();
        let length = write(&mut bytes, kind, key, payload).unwrap();
        assert_eq!(length, bytes.len() as u64);
        bytes
    }

    fn three() -> Vec<Vec<u8>> {
        let key = |byte| Key([byte; 32]);
        vec![
            encode(Kind::Curve, &key(1), b"the curve"),
            encode(Kind::Replica, &key(2), &[7; 300]),
            encode(Kind::Replica, &key(3), b""),
        ]
    }

    fn contents(bytes: &[u8]) -> Contents {
        scan(&mut Cursor::new(bytes), bytes.len() as u64).unwrap()
    }

    fn keys(contents: &Contents) -> Vec<u8> {
        contents.records.iter().map(|found| found.key.0[0]).collect()
    }

    #[test]
    fn records_come_back_as_they_were_written() {
        let bytes = three().concat();
        let contents = contents(&bytes);
        assert_eq!((keys(&contents), contents.damaged), (vec![1, 2, 3], 0));
        assert_eq!(contents.end, bytes.len() as u64);
        let mut file = Cursor::new(&bytes);
        let payloads: Vec<_> =
            contents.records.iter().map(|found| payload(&mut file, found).unwrap()).collect();
        assert_eq!(payloads, [b"the curve".to_vec(), vec![7; 300], vec![]]);
    }

    #[test]
    fn a_journal_cut_off_at_any_byte_keeps_the_records_before() {
        let records = three();
        let bytes = records.concat();
        let ends = [records[0].len(), records[0].len() + records[1].len(), bytes.len()];
        for length in 0..bytes.len() {
            let contents = contents(&bytes[..length]);
            let whole = ends.iter().filter(|&&end| end <= length).count();
            assert_eq!(contents.records.len(), whole, "{length} bytes");
            assert_eq!(contents.end, [0, ends[0], ends[1]][whole] as u64, "{length} bytes");
            assert_eq!(contents.damaged, 0, "{length} bytes");
        }
    }

    #[test]
    fn a_record_with_any_bit_flipped_is_skipped_and_the_others_are_found() {
        let records = three();
        let bytes = records.concat();
        let second = records[0].len()..records[0].len() + records[1].len();
        for position in second {
            for bit in 0..8 {
                let mut damaged = bytes.clone();
                damaged[position] ^= 1 << bit;
                let contents = contents(&damaged);
                assert_eq!(keys(&contents), [1, 3], "bit {bit} of byte {position}");
                assert_eq!(contents.damaged, 1, "bit {bit} of byte {position}");
            }
        }
    }

    #[test]
    fn a_mark_within_a_payload_is_no_record() {
        let inner = [&MARK[..], &[0; 200]].concat();
        let mut bytes = encode(Kind::Replica, &Key([1; 32]), &inner);
        assert_eq!(keys(&contents(&bytes)), [1]);
        // Nor is it where the record around it is damaged.
        bytes[0] ^= 1;
        bytes.extend(encode(Kind::Replica, &Key([2; 32]), b""));
        let contents = contents(&bytes);
        assert_eq!((keys(&contents), contents.damaged), (vec![2], 1));
    }

    #[test]
    fn a_hole_of_any_size_is_not_read_through() {
        let bytes = three().concat();
        let mut file = tempfile::tempfile().unwrap();
        file.write_all(&bytes).unwrap();
        let huge = 200 << 30;
        file.set_len(huge).unwrap();
        let started = std::time::Instant::now();
        let contents = scan(&mut file, huge).unwrap();
        assert_eq!((keys(&contents), contents.end), (vec![1, 2, 3], bytes.len() as u64));
        assert!(started.elapsed().as_secs_f64() < 1.0, "{:?}", started.elapsed());
    }

    #[test]
    fn anything_else_is_no_record() {
        for other in [&b"{ \"id\": \"tiny\" }"[..], &[0; 5000], &[0xff; 70_000]] {
            assert_eq!(contents(other), Contents::default());
        }
    }
}
