//! Seals: a public hash of each label; the labels themselves are in a key file.

use std::fmt::Write as _;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use thiserror::Error;

use super::label::Label;

/// The open file and the key.
pub const SEALS: &str = "seals.csv";
/// The labels with their salts.
pub const KEY: &str = "labels.key";

/// Sealed labels.
#[derive(Clone, Debug, PartialEq)]
pub struct Sealed {
    /// `case,sha256`, a row for each case.
    pub seals: String,
    /// JSON with the labels.
    pub key: String,
}

/// A key that does not open the seals.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum SealError {
    /// The key is no JSON of the right shape.
    #[error("labels.key can't be read ({reason}): take the one that was written with the cases")]
    Key {
        /// Why.
        reason: String,
    },
    /// A row of the seals without a hash.
    #[error(
        "seals.csv, row {row}: expected CASE,SHA256; take the file that was written with the cases"
    )]
    Row {
        /// Row of the file, the header is 1.
        row: usize,
    },
    /// A case in only one of the two files.
    #[error(
        "{case} is in only one of seals.csv and labels.key: both have to be of one examination"
    )]
    Unpaired {
        /// The case.
        case: String,
    },
    /// The label is not the one that was sealed.
    #[error(
        "the seal of {case} is broken: its label is not the one that was sealed; grade with the labels.key that was written with the cases"
    )]
    Broken {
        /// The case.
        case: String,
    },
}

#[derive(Serialize, Deserialize)]
struct Key {
    labels: Vec<Entry>,
}

#[derive(Serialize, Deserialize)]
struct Entry {
    case: String,
    salt: String,
    /// JSON in a string: its bytes are what was hashed.
    label: String,
}

/// Seals labels, each with its salt.
///
/// # Errors
/// A label that is not JSON, such as one with a number that is not finite.
pub fn seal(labels: &[(Label, String)]) -> Result<Sealed, SealError> {
    let unreadable = |error: serde_json::Error| SealError::Key { reason: error.to_string() };
    let mut seals = String::from("case,sha256\n");
    let mut key = Key { labels: Vec::new() };
    for (label, salt) in labels {
        let text = serde_json::to_string(label).map_err(unreadable)?;
        let _ = writeln!(seals, "{},{}", label.case, hash(salt, &text));
        key.labels.push(Entry { case: label.case.clone(), salt: salt.clone(), label: text });
    }
    let key = serde_json::to_string_pretty(&key).map_err(unreadable)? + "\n";
    Ok(Sealed { seals, key })
}

/// Opens sealed labels, after all hashes have been checked.
///
/// # Errors
/// The key does not belong to the seals or was changed.
pub fn open(sealed: &Sealed) -> Result<Vec<Label>, SealError> {
    let key: Key = serde_json::from_str(&sealed.key)
        .map_err(|error| SealError::Key { reason: error.to_string() })?;
    let mut seals = Vec::new();
    for (i, row) in sealed.seals.lines().enumerate().skip(1) {
        if row.trim().is_empty() {
            continue;
        }
        let (case, hash) = row.split_once(',').ok_or(SealError::Row { row: i + 1 })?;
        seals.push((case.trim(), hash.trim()));
    }
    if let Some((case, _)) =
        seals.iter().find(|(case, _)| !key.labels.iter().any(|entry| entry.case == *case))
    {
        return Err(SealError::Unpaired { case: (*case).to_owned() });
    }
    for entry in &key.labels {
        let case = || entry.case.clone();
        let mut of_case = seals.iter().filter(|(name, _)| *name == entry.case);
        let (Some((_, sealed)), None) = (of_case.next(), of_case.next()) else {
            return Err(SealError::Unpaired { case: case() });
        };
        if *sealed != hash(&entry.salt, &entry.label) {
            return Err(SealError::Broken { case: case() });
        }
    }
    key.labels
        .iter()
        .map(|entry| {
            let label: Label = serde_json::from_str(&entry.label)
                .map_err(|error| SealError::Key { reason: error.to_string() })?;
            if label.case == entry.case {
                Ok(label)
            } else {
                Err(SealError::Broken { case: entry.case.clone() })
            }
        })
        .collect()
}

fn hash(salt: &str, label: &str) -> String {
    let digest = Sha256::digest(format!("{salt}\n{label}").as_bytes());
    digest.iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}
