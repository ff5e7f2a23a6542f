//! Seals: public hashes of the labels; a key file contains the labels.

use std::fmt::Write as _;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use thiserror::Error;

use super::label::Label;

/// Name of the public file with the hashes.
pub const SEALS: &str = "seals.csv";
/// Name of the file with labels and salts.
pub const KEY: &str = "labels.key";

/// Sealed labels.
#[derive(Clone, Debug, PartialEq)]
pub struct Sealed {
    /// CSV `case,sha256` with a row for each case.
    pub seals: String,
    /// JSON with labels and salts.
    pub key: String,
}

/// A key that does not match the seals.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum SealError {
    /// The key is not valid JSON.
    #[error("labels.key can't be read ({0}): take the one that was written with the cases")]
    Key(String),
    /// A row of the seals without a hash; the header is row 1.
    #[error(
        "seals.csv, row {0}: expected CASE,SHA256; take the file that was written with the cases"
    )]
    Row(usize),
    /// A case in only one of the two files.
    #[error("{0} is in only one of seals.csv and labels.key: both have to be of one examination")]
    Unpaired(String),
    /// The label differs from the sealed one.
    #[error(
        "the seal of {0} is broken: its label is not the one that was sealed; grade with the labels.key that was written with the cases"
    )]
    Broken(String),
}

#[derive(Serialize, Deserialize)]
struct Key {
    labels: Vec<Entry>,
}

#[derive(Serialize, Deserialize)]
struct Entry {
    case: String,
    salt: String,
    /// Label as JSON text: the hash is of these bytes.
    label: String,
}

/// Seals labels, each with a salt.
///
/// # Errors
/// A label cannot be written as JSON, for example because of a number that is not finite.
pub fn seal(labels: &[(Label, String)]) -> Result<Sealed, SealError> {
    let mut seals = String::from("case,sha256\n");
    let mut key = Key { labels: Vec::new() };
    for (label, salt) in labels {
        let text = serde_json::to_string(label).map_err(|error| unreadable(&error))?;
        let _ = writeln!(seals, "{},{}", label.case, hash(salt, &text));
        key.labels.push(Entry { case: label.case.clone(), salt: salt.clone(), label: text });
    }
    let key = serde_json::to_string_pretty(&key).map_err(|error| unreadable(&error))? + "\n";
    Ok(Sealed { seals, key })
}

/// Opens sealed labels after checking all hashes.
///
/// # Errors
/// The key does not match the seals.
pub fn open(sealed: &Sealed) -> Result<Vec<Label>, SealError> {
    let key: Key = serde_json::from_str(&sealed.key).map_err(|error| unreadable(&error))?;
    let mut seals = Vec::new();
    for (i, row) in sealed.seals.lines().enumerate().skip(1) {
        if row.trim().is_empty() {
            continue;
        }
        let (case, hash) = row.split_once(',').ok_or(SealError::Row(i + 1))?;
        seals.push((case.trim(), hash.trim()));
    }
    if let Some((case, _)) =
        seals.iter().find(|(case, _)| !key.labels.iter().any(|entry| entry.case == *case))
    {
        return Err(SealError::Unpaired((*case).to_owned()));
    }
    for entry in &key.labels {
        let case = || entry.case.clone();
        let mut of_case = seals.iter().filter(|(name, _)| *name == entry.case);
        let (Some((_, sealed)), None) = (of_case.next(), of_case.next()) else {
            return Err(SealError::Unpaired(case()));
        };
        if *sealed != hash(&entry.salt, &entry.label) {
            return Err(SealError::Broken(case()));
        }
    }
    key.labels
        .iter()
        .map(|entry| {
            let label: Label =
                serde_json::from_str(&entry.label).map_err(|error| unreadable(&error))?;
            if label.case == entry.case {
                Ok(label)
            } else {
                Err(SealError::Broken(entry.case.clone()))
            }
        })
        .collect()
}

fn unreadable(error: &serde_json::Error) -> SealError {
    SealError::Key(error.to_string())
}

fn hash(salt: &str, label: &str) -> String {
    let digest = Sha256::digest(format!("{salt}\n{label}").as_bytes());
    digest.iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}
