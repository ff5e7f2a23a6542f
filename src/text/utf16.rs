//! UTF-16, the one encoding in which RAPID's own characters are more than a byte.
//!
//! Such a file is read as UTF-8 and written back as it was, so that nothing else has to know.
//! Without its byte order mark, or damaged, it is taken byte for byte like any other.

use std::borrow::Cow;

/// UTF-16 with a byte order mark.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Utf16 {
    /// The low byte first.
    Le,
    /// The high byte first.
    Be,
}

impl Utf16 {
    /// The text of a file, if it is UTF-16 and can be written back without a loss.
    pub(super) fn read(bytes: &[u8]) -> Option<(Utf16, String)> {
        let (kind, body) = match bytes {
            [0xFF, 0xFE, body @ ..] => (Utf16::Le, body),
            // `FE` alone begins a module in ABB's binary encoding.
            [0xFE, 0xFF, body @ ..] if body.first() == Some(&0) => (Utf16::Be, body),
            _ => return None,
        };
        let (pairs, []) = body.as_chunks::<2>() else { return None };
        let units = pairs.iter().map(|pair| match kind {
            Utf16::Le => u16::from_le_bytes(*pair),
            Utf16::Be => u16::from_be_bytes(*pair),
        });
        let text = char::decode_utf16(units).collect::<Result<String, _>>().ok()?;
        Some((kind, text))
    }

    /// The bytes of a file with this text; what is not UTF-8 becomes U+FFFD.
    pub(super) fn write(self, text: &[u8]) -> Vec<u8> {
        let text: Cow<'_, str> = String::from_utf8_lossy(text);
        std::iter::once(0xFEFF)
            .chain(text.encode_utf16())
            .flat_map(|unit| match self {
                Utf16::Le => unit.to_le_bytes(),
                Utf16::Be => unit.to_be_bytes(),
            })
            .collect()
    }

    /// Its name in the WHATWG list.
    pub(super) fn name(self) -> &'static str {
        match self {
            Utf16::Le => "UTF-16LE",
            Utf16::Be => "UTF-16BE",
        }
    }
}
