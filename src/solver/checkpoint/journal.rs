//! A file of records, read from its beginning and written at its end.
//!
//! Each record is its length, a checksum and its bytes. One that was cut off when a program was killed is
//! not read, and the next is written over it.

use std::fs::{File, OpenOptions};
use std::io::{self, BufReader, Read, Seek, SeekFrom, Write};
use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::error::{Error, Result};
use crate::file;

/// The first bytes of the file; the last of them is the version of its form.
const MAGIC: &[u8; 16] = b"radiosity work 3";

/// Bytes before those of a record: its length and its checksum.
const HEAD: usize = 12;

#[derive(Debug)]
pub(super) struct Journal {
    file: BufReader<File>,
    /// Where the last good record ends, until the end of the file is reached.
    reading: Option<u64>,
}

impl Journal {
    /// A new file that begins with a record; there must not be one yet.
    pub(super) fn create(path: &Path, first: &impl Serialize) -> Result<Self> {
        if path.exists() {
            return Err(Error::io(path)(io::ErrorKind::AlreadyExists.into()));
        }
        file::replace(path, |out| {
            out.write_all(MAGIC)?;
            out.write_all(&framed(first)?)
        })?;
        let mut file =
            OpenOptions::new().read(true).write(true).open(path).map_err(Error::io(path))?;
        file.seek(SeekFrom::End(0)).map_err(Error::io(path))?;
        Ok(Self { file: BufReader::new(file), reading: None })
    }

    /// An existing file, at its first record; one that is no journal has none.
    pub(super) fn open(path: &Path) -> io::Result<Self> {
        let mut file = BufReader::new(OpenOptions::new().read(true).write(true).open(path)?);
        let mut magic = [0; MAGIC.len()];
        let is_tape = file.read_exact(&mut magic).is_ok() && magic == *MAGIC;
        Ok(Self { file, reading: is_tape.then_some(MAGIC.len() as u64) })
    }

    /// The next record, unless the end is reached, or one that is broken or of another type.
    pub(super) fn next<R: DeserializeOwned>(&mut self) -> Option<R> {
        let end = self.reading?;
        let record = self.read();
        self.reading = record.as_ref().map(|(_, length)| end + length);
        if self.reading.is_none() {
            // What cannot be cut off is overwritten, and found broken when it is read again.
            let _ = self.file.get_ref().set_len(end);
            let _ = self.file.seek(SeekFrom::Start(end));
        }
        record.map(|(record, _)| record)
    }

    /// A record, and its length in the file.
    fn read<R: DeserializeOwned>(&mut self) -> Option<(R, u64)> {
        let mut head = [0; HEAD];
        self.file.read_exact(&mut head).ok()?;
        let (length, checksum) = head.split_at(8);
        let length = u64::from_le_bytes(length.try_into().ok()?);
        let mut bytes = Vec::new();
        // Not as long as it says before as much is there.
        self.file.by_ref().take(length).read_to_end(&mut bytes).ok()?;
        let is_whole =
            bytes.len() as u64 == length && crc32fast::hash(&bytes).to_le_bytes() == *checksum;
        let record = is_whole.then(|| postcard::from_bytes(&bytes).ok()).flatten()?;
        Some((record, length + HEAD as u64))
    }

    /// Writes a record after the last one; those not read yet are given up.
    pub(super) fn append(&mut self, record: &impl Serialize) -> io::Result<()> {
        self.file.get_mut().write_all(&framed(record)?)
    }
}

/// A record as it is in the file.
fn framed(record: &impl Serialize) -> io::Result<Vec<u8>> {
    let bytes = postcard::to_stdvec(record).map_err(io::Error::other)?;
    let mut framed = Vec::with_capacity(HEAD + bytes.len());
    framed.extend((bytes.len() as u64).to_le_bytes());
    framed.extend(crc32fast::hash(&bytes).to_le_bytes());
    framed.extend(bytes);
    Ok(framed)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_all(path: &Path) -> Vec<Vec<u64>> {
        let mut journal = Journal::open(path).unwrap();
        std::iter::from_fn(|| journal.next()).collect()
    }

    #[test]
    fn a_tape_cut_anywhere_keeps_its_whole_records_and_can_be_written_on() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("journal");
        let records: Vec<Vec<u64>> = (0..5).map(|n| vec![n * 1_000_003; n as usize]).collect();
        let mut journal = Journal::create(&path, &records[0]).unwrap();
        records[1..].iter().for_each(|record| journal.append(record).unwrap());
        drop(journal);
        let whole = std::fs::read(&path).unwrap();
        assert_eq!(read_all(&path), records);
        for length in 0..whole.len() {
            std::fs::write(&path, &whole[..length]).unwrap();
            let mut journal = Journal::open(&path).unwrap();
            let found: Vec<Vec<u64>> = std::iter::from_fn(|| journal.next()).collect();
            assert_eq!(found, records[..found.len()]);
            if length >= MAGIC.len() {
                journal.append(&vec![7_u64]).unwrap();
                drop(journal);
                assert_eq!(read_all(&path), [&found[..], &[vec![7]]].concat());
            }
        }
        assert!(Journal::create(&path, &records[0]).is_err(), "nothing is overwritten");
    }

    #[test]
    fn a_changed_bit_ends_the_tape() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("journal");
        let mut journal = Journal::create(&path, &vec![1_u64]).unwrap();
        journal.append(&vec![2_u64; 9]).unwrap();
        drop(journal);
        let mut bytes = std::fs::read(&path).unwrap();
        *bytes.last_mut().unwrap() ^= 16;
        std::fs::write(&path, &bytes).unwrap();
        assert_eq!(read_all(&path), [vec![1]]);
    }
}
