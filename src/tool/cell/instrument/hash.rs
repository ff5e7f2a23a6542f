//! The hash by which a log names its program.

use sha2::{Digest, Sha256};

use super::remove::is_recorder;
use crate::tool::retrofit::Source;

/// Number of hexadecimal digits.
const DIGITS: usize = 16;

/// The hash of a program's files, in the order of their relative paths. The module of a recorder does
/// not count.
#[must_use]
pub fn program_hash(files: &[Source]) -> String {
    let own = files.iter().filter(|source| !is_recorder(&source.file.bytes));
    let mut own: Vec<&Source> = own.collect();
    own.sort_by(|a, b| a.relative.cmp(&b.relative));
    let mut hasher = Sha256::new();
    for source in own {
        hasher.update(Sha256::digest(&source.file.bytes));
    }
    format!("{:x}", hasher.finalize())[..DIGITS].to_owned()
}
