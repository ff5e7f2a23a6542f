//! Decoding of UTF-16, which spreadsheets call Unicode.

/// Whether a file begins with a byte order mark of UTF-16.
pub(super) fn is_utf16(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\xFF\xFE") || bytes.starts_with(b"\xFE\xFF")
}

/// The text after the byte order mark; invalid characters become U+FFFD.
pub(super) fn decoded(bytes: &[u8]) -> String {
    let unit = if bytes.starts_with(b"\xFF\xFE") { u16::from_le_bytes } else { u16::from_be_bytes };
    let units = bytes.chunks_exact(2).skip(1).map(|pair| unit([pair[0], pair[1]]));
    char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_orders_are_read() {
        let text = "t,q1 \u{1F916}\n";
        let bytes = |unit: fn(u16) -> [u8; 2]| -> Vec<u8> {
            let mut units = vec![0xFEFF];
            units.extend(text.encode_utf16());
            units.into_iter().flat_map(unit).collect()
        };
        for bytes in [bytes(u16::to_le_bytes), bytes(u16::to_be_bytes)] {
            assert!(is_utf16(&bytes));
            assert_eq!(decoded(&bytes), text);
        }
    }
}
