//! Finished replicas in the journal of a run that was killed, read from its bytes and not by the
//! program under trial. `crates/journal/src/record.rs` says how a record is laid out; a kill
//! tears the last one and no other, so that a record is whole where it fits the file.

use std::collections::BTreeSet;
use std::fs;
use std::io::ErrorKind;
use std::path::Path;

const MARK: &[u8] = b"eigsync1";
/// Where the kind, the key and the length of the payload stand in a record, and where its payload.
const KIND: usize = MARK.len();
const KEY: usize = KIND + 1;
const LENGTH: usize = KEY + 32;
const PAYLOAD: usize = LENGTH + 8 + 8;
/// Bytes of the sum after the payload.
const SUM: usize = 16;
/// The kind of a finished replica.
const REPLICA: u8 = 5;

/// Keys of finished replicas.
pub type Replicas = BTreeSet<Vec<u8>>;

/// The finished replicas in the journal of a hidden folder, none without one. A replica that stands
/// there twice was computed twice, which is an error, as is what is no record.
pub fn replicas(hidden: &Path) -> Result<Replicas, String> {
    match fs::read(hidden.join("journal")) {
        Ok(bytes) => replicas_in(&bytes),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(Replicas::new()),
        Err(error) => Err(format!("the journal cannot be read: {error}")),
    }
}

fn replicas_in(bytes: &[u8]) -> Result<Replicas, String> {
    let mut found = Replicas::new();
    let mut at = 0;
    while let Some(record) = bytes.get(at..).filter(|rest| rest.len() >= PAYLOAD) {
        if !record.starts_with(MARK) {
            return Err(format!("byte {at} of the journal begins no record"));
        }
        let length = u64::from_le_bytes(record[LENGTH..][..8].try_into().expect("eight bytes"));
        let whole = usize::try_from(length).map_err(|_| "a record is too long".to_owned())?;
        let whole = PAYLOAD.saturating_add(whole).saturating_add(SUM);
        if record.len() < whole {
            break;
        }
        if record[KIND] == REPLICA && !found.insert(record[KEY..LENGTH].to_vec()) {
            return Err("a replica stands twice in the journal: it was computed again".into());
        }
        at += whole;
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(kind: u8, key: u8, n_bytes: usize) -> Vec<u8> {
        let length = (n_bytes as u64).to_le_bytes();
        [MARK, &[kind], &[key; 32], &length, &[0; 8], &vec![7; n_bytes], &[0; SUM]].concat()
    }

    #[test]
    fn whole_replicas_are_counted_and_a_torn_one_is_not() {
        let bytes = [record(1, 0, 9), record(REPLICA, 1, 300), record(REPLICA, 2, 0)].concat();
        assert_eq!(replicas_in(&bytes).unwrap().len(), 2);
        assert_eq!(replicas_in(&bytes[..bytes.len() - 1]).unwrap().len(), 1);
        assert_eq!(replicas_in(b"").unwrap().len(), 0);
    }

    #[test]
    fn a_replica_that_was_computed_twice_is_an_error() {
        assert!(replicas_in(&record(REPLICA, 1, 3).repeat(2)).is_err());
        assert!(replicas_in(&[0; 500]).is_err());
    }
}
