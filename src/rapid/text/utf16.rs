//! UTF-16, the only supported encoding in which an ASCII character takes more than one byte.
//!
//! Such a file is converted to UTF-8 at reading and back to UTF-16 at writing. Without a byte
//! order mark it is recognised by the zeros between its first characters, which are ASCII in
//! every module. A damaged file is read byte by byte like any other.

use std::borrow::Cow;

/// Number of characters at the start of a file without a byte order mark that must be ASCII.
const ASCII_AT_START: usize = 8;

/// A form of UTF-16.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Utf16 {
    order: Order,
    /// Whether the file starts with a byte order mark.
    pub bom: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Order {
    /// Low byte first.
    Le,
    /// High byte first.
    Be,
}

impl Utf16 {
    /// The text of a file, if it is UTF-16 and can be written back without loss.
    pub(super) fn read(bytes: &[u8]) -> Option<(Utf16, String)> {
        let (form, body) = match bytes {
            [0xFF, 0xFE, body @ ..] => (Utf16 { order: Order::Le, bom: true }, body),
            // A module in ABB's binary encoding may start with `FE`, too.
            [0xFE, 0xFF, body @ ..] if body.first() == Some(&0) => {
                (Utf16 { order: Order::Be, bom: true }, body)
            }
            _ => (Utf16 { order: Order::without_mark(bytes)?, bom: false }, bytes),
        };
        let (pairs, []) = body.as_chunks::<2>() else { return None };
        let units = pairs.iter().map(|pair| match form.order {
            Order::Le => u16::from_le_bytes(*pair),
            Order::Be => u16::from_be_bytes(*pair),
        });
        let text = char::decode_utf16(units).collect::<Result<String, _>>().ok()?;
        Some((form, text))
    }

    /// The bytes of a file with this text; invalid UTF-8 becomes U+FFFD.
    pub(super) fn write(self, text: &[u8]) -> Vec<u8> {
        let text: Cow<'_, str> = String::from_utf8_lossy(text);
        self.bom
            .then_some(0xFEFF)
            .into_iter()
            .chain(text.encode_utf16())
            .flat_map(|unit| match self.order {
                Order::Le => unit.to_le_bytes(),
                Order::Be => unit.to_be_bytes(),
            })
            .collect()
    }

    /// Its name in the WHATWG list.
    pub(super) fn name(self) -> &'static str {
        match self.order {
            Order::Le => "UTF-16LE",
            Order::Be => "UTF-16BE",
        }
    }
}

impl Order {
    /// The byte order of a file without a mark, if its start is ASCII in UTF-16.
    fn without_mark(bytes: &[u8]) -> Option<Order> {
        let (pairs, _) = bytes.as_chunks::<2>();
        let start = pairs.get(..ASCII_AT_START)?;
        let is_ascii = |byte: u8| byte != 0 && byte.is_ascii();
        if start.iter().all(|[low, high]| is_ascii(*low) && *high == 0) {
            Some(Order::Le)
        } else if start.iter().all(|[high, low]| is_ascii(*low) && *high == 0) {
            Some(Order::Be)
        } else {
            None
        }
    }
}
