//! Replacements of byte ranges; all other bytes stay unchanged.

use std::ops::Range;

use thiserror::Error;

use super::span::Span;

/// Replaces the bytes of `span` by `text`; an empty span inserts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edit {
    /// The bytes to replace.
    pub span: Span,
    /// The replacement, in the encoding of the file.
    pub text: Vec<u8>,
}

/// Edits that cannot be applied together.
#[derive(Debug, Error, PartialEq, Eq)]
pub enum EditError {
    /// Two edits replace the same bytes.
    #[error(
        "two edits overlap at bytes {first:?} and {second:?}; \
         apply one of them and read the file again before the other"
    )]
    Overlap {
        /// Bytes of the earlier edit.
        first: Range<u32>,
        /// Bytes of the later edit.
        second: Range<u32>,
    },
    /// An edit outside the file, or one that ends before it starts.
    #[error(
        "the edit of bytes {start}..{end} is outside the file, which has {length} bytes; \
         compute the edits from the same bytes to which they are applied"
    )]
    Outside {
        /// Start of the edit.
        start: u32,
        /// End of the edit.
        end: u32,
        /// Bytes in the file.
        length: usize,
    },
}

/// Applies `edits`, given in any order, to `bytes`. Insertions at one place keep their given order
/// and precede a replacement that starts there.
///
/// # Errors
/// If edits overlap, or one of them is outside the file.
pub fn apply(bytes: &[u8], edits: &[Edit]) -> Result<Vec<u8>, EditError> {
    let mut ordered: Vec<&Edit> = edits.iter().collect();
    ordered.sort_by_key(|edit| (edit.span.start, edit.span.end));
    let added: usize = edits.iter().map(|edit| edit.text.len()).sum();
    let mut out = Vec::with_capacity(bytes.len() + added);
    let mut done: u32 = 0;
    let mut previous: Option<&Edit> = None;
    for edit in ordered {
        let Span { start, end, .. } = edit.span;
        if start > end || end as usize > bytes.len() {
            return Err(EditError::Outside { start, end, length: bytes.len() });
        }
        if let Some(first) = previous
            && start < done
        {
            let first = first.span.start..first.span.end;
            return Err(EditError::Overlap { first, second: start..end });
        }
        out.extend_from_slice(&bytes[done as usize..start as usize]);
        out.extend_from_slice(&edit.text);
        done = end;
        previous = Some(edit);
    }
    out.extend_from_slice(&bytes[done as usize..]);
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rapid::text::span::FileId;

    fn edit(start: u32, end: u32, text: &str) -> Edit {
        Edit { span: Span { file: FileId(0), start, end }, text: text.as_bytes().to_vec() }
    }

    #[test]
    fn edits_apply_in_the_order_of_the_file() {
        let edits = [edit(7, 9, "XY"), edit(0, 1, ""), edit(3, 3, "--"), edit(3, 3, "++")];
        assert_eq!(apply(b"0123456789", &edits), Ok(b"12--++3456XY9".to_vec()));
    }

    #[test]
    fn overlapping_edits_are_refused() {
        let edits = [edit(2, 5, "a"), edit(4, 6, "b")];
        assert_eq!(
            apply(b"0123456789", &edits),
            Err(EditError::Overlap { first: 2..5, second: 4..6 })
        );
        assert_eq!(apply(b"0123456789", &[edit(2, 4, ""), edit(4, 6, "b")]), Ok(b"01b6789".into()));
    }

    #[test]
    fn edits_outside_the_file_are_refused() {
        for bad in [edit(2, 11, ""), edit(5, 4, "")] {
            assert!(matches!(apply(b"0123456789", &[bad]), Err(EditError::Outside { .. })));
        }
    }
}
