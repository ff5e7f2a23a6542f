//! The encoding of a file, decoding and encoding.

use std::borrow::Cow;

use encoding_rs::{Encoding, GB18030, GBK, SHIFT_JIS, UTF_8, WINDOWS_1252};

use super::detect;

/// The byte order mark of UTF-8.
const BOM: &[u8] = b"\xEF\xBB\xBF";

/// A file's encoding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Charset {
    encoding: &'static Encoding,
    /// Whether the file starts with the byte order mark of UTF-8.
    pub bom: bool,
}

/// The text of some bytes, without a byte order mark.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Decoded {
    /// The text.
    pub text: String,
    /// Name of the encoding as in the WHATWG list (`UTF-8`, `windows-1252`, `GBK` …).
    pub encoding: &'static str,
}

/// Whether the bytes are a module in ABB's binary encoding, which cannot be read.
#[must_use]
pub fn is_encoded_module(bytes: &[u8]) -> bool {
    matches!(bytes.first(), Some(0xFC..=0xFE))
}

/// Detects the encoding of a whole file.
#[must_use]
pub fn charset(bytes: &[u8]) -> Charset {
    let bom = bytes.starts_with(BOM);
    let encoding = if is_encoded_module(bytes) {
        WINDOWS_1252
    } else if bom || std::str::from_utf8(bytes).is_ok() {
        UTF_8
    } else {
        detect::legacy(bytes)
    };
    Charset { encoding, bom }
}

/// Decodes a whole file in its detected encoding.
#[must_use]
pub fn decode(bytes: &[u8]) -> Decoded {
    let charset = charset(bytes);
    let body = if charset.bom { &bytes[BOM.len()..] } else { bytes };
    Decoded { text: charset.decode(body).into_owned(), encoding: charset.name() }
}

impl Charset {
    /// Its name in the WHATWG list.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.encoding.name()
    }

    /// Decodes a part of a file; invalid bytes become U+FFFD.
    #[must_use]
    pub fn decode(self, bytes: &[u8]) -> Cow<'_, str> {
        self.encoding.decode_without_bom_handling(bytes).0
    }

    /// The characters of a part of a file that begins with a whole one, each with its number of bytes;
    /// an invalid byte is U+FFFD.
    pub fn characters(self, bytes: &[u8]) -> impl Iterator<Item = (usize, char)> + '_ {
        let mut rest = bytes;
        std::iter::from_fn(move || {
            let first = *rest.first()?;
            let (head, tail) = rest.split_at_checked(self.width(rest).max(1))?;
            rest = tail;
            let sign = if first.is_ascii() {
                char::from(first)
            } else {
                self.decode(head).chars().next().unwrap_or(char::REPLACEMENT_CHARACTER)
            };
            Some((head.len(), sign))
        })
    }

    /// Encodes text for this file; `None` if the encoding lacks one of its characters.
    #[must_use]
    pub fn encode(self, text: &str) -> Option<Vec<u8>> {
        // For GBK the WHATWG encoder is a restricted GB18030; the others encode to themselves.
        let (bytes, _, lossy) = self.encoding.encode(text);
        (!lossy).then(|| bytes.into_owned())
    }

    /// Number of bytes of the first character; an invalid byte counts as one character. At least 1
    /// for a non-empty slice.
    pub(super) fn width(self, bytes: &[u8]) -> usize {
        let [first, rest @ ..] = bytes else { return 0 };
        if *first < 0x80 || self.encoding.is_single_byte() {
            return 1;
        }
        let wanted = if self.encoding == UTF_8 {
            match first {
                0xC2..=0xDF => 2,
                0xE0..=0xEF => 3,
                0xF0..=0xF4 => 4,
                _ => 1,
            }
        } else if self.encoding == SHIFT_JIS && matches!(first, 0xA1..=0xDF) {
            1
        } else if [GBK, GB18030].contains(&self.encoding)
            && rest.first().is_some_and(u8::is_ascii_digit)
        {
            4
        } else {
            2
        };
        match bytes.get(..wanted) {
            Some(head)
                if self
                    .encoding
                    .decode_without_bom_handling_and_without_replacement(head)
                    .is_some() =>
            {
                wanted
            }
            _ => 1,
        }
    }
}

#[cfg(test)]
#[expect(clippy::unwrap_used, reason = "a missing value fails the test")]
mod tests {
    use super::*;

    /// The detected encoding of a RAPID file with these comments.
    fn detected(comments: &[&str], encoding: &'static Encoding) -> &'static str {
        let lines =
            comments.iter().map(|text| format!("  ! {text}\r\n  MoveL p10,v100,z10,tool0;"));
        let text = lines.collect::<Vec<_>>().join("\r\n");
        let (bytes, _, lossy) = encoding.encode(&text);
        assert!(!lossy, "{text}");
        let decoded = decode(&bytes);
        if decoded.encoding == encoding.name() {
            assert_eq!(decoded.text, text);
        }
        decoded.encoding
    }

    #[test]
    fn each_encoding_is_recognised_by_its_language() {
        use encoding_rs::{WINDOWS_1250, WINDOWS_1251};
        let table: [(&'static Encoding, &[&str]); 11] = [
            (UTF_8, &["plain"]),
            (UTF_8, &["Größe der Palette °"]),
            (WINDOWS_1252, &["Größe der Palette, Öffnung für Prüfung 5°"]),
            (WINDOWS_1252, &["posición de recogida del tercer año"]),
            (WINDOWS_1252, &["kør til hjemmeposition", "åbn griberen"]),
            (WINDOWS_1252, &["±5 mm", "Ø12", "20 µm", "90°"]),
            (WINDOWS_1250, &["výměna nástroje, počkej na signál", "otevři chapadlo a odjeď"]),
            (WINDOWS_1250, &["otwórz chwytak i odjedź nad część", "błąd: brak części w gnieździe"]),
            (WINDOWS_1251, &["Возврат в исходное положение"]),
            (WINDOWS_1251, &["СБРОС ОШИБКИ"]),
            (GBK, &["等待"]),
        ];
        for (encoding, comments) in table {
            assert_eq!(detected(comments, encoding), encoding.name(), "{comments:?}");
        }
        assert_eq!(detected(&["机器人回到原点位置，等待信号", "打开夹爪"], GBK), "GBK");
    }

    #[test]
    fn one_odd_byte_is_no_evidence() {
        for byte in 0x80..=0xFF {
            let bytes = [b"MODULE a\n! x ".as_slice(), &[byte], b" y\nENDMODULE\n"].concat();
            assert_eq!(charset(&bytes).name(), "windows-1252", "{byte:#x}");
        }
    }

    #[test]
    fn damage_does_not_change_the_encoding() {
        let comments =
            ["机器人回到原点位置", "等待信号", "打开夹爪", "抓取工件", "安全位置", "回原点"];
        let text = comments.map(|comment| format!("! {comment}\n")).concat();
        let mut bytes = GBK.encode(&text).0.into_owned();
        // A comment cut in the middle of a character.
        bytes.extend_from_slice(&[b'!', b' ', 0xB5, b'\n']);
        assert_eq!(charset(&bytes).name(), "GBK");
        let mut bytes = text.into_bytes();
        bytes[10] = b'x';
        assert_eq!(charset(&bytes).name(), "UTF-8");
    }

    #[test]
    fn the_byte_order_mark_is_not_text() {
        let bytes = b"\xEF\xBB\xBFMODULE a";
        assert_eq!(decode(bytes), Decoded { text: "MODULE a".into(), encoding: "UTF-8" });
        assert!(charset(bytes).bom);
    }

    #[test]
    fn every_byte_has_a_character_in_the_fallback() {
        let all: Vec<u8> = (0..=255).collect();
        let charset = charset(&all);
        let text = charset.decode(&all).into_owned();
        assert_eq!(charset.encode(&text).unwrap(), all);
    }

    #[test]
    fn binary_modules_are_recognised() {
        assert!(is_encoded_module(b"\xFC\x01\x02"));
        assert!(is_encoded_module(b"\xFE"));
        assert!(!is_encoded_module(b"\xFFMODULE"));
        assert!(!is_encoded_module(b""));
    }
}
