//! Detection of the encoding of a file without a byte order mark.
//!
//! Controllers write ISO 8859-1 or UTF-8, editors any encoding. UTF-8 is recognised by its
//! structure. The others are distinguished by the statistics of `chardetng`, which is made for web
//! pages and unreliable for a single comment. Without enough evidence the result is windows-1252:
//! it is the most frequent encoding and maps every byte to a character without loss.

use chardetng::{EncodingDetector, Iso2022JpDetection, Utf8Detection};
use encoding_rs::{
    BIG5, EUC_KR, Encoding, GBK, ISO_8859_2, SHIFT_JIS, UTF_8, WINDOWS_1250, WINDOWS_1251,
    WINDOWS_1252, WINDOWS_1253, WINDOWS_1254,
};

/// Two-byte encodings that occur in RAPID files.
const DOUBLE_BYTE: [&Encoding; 4] = [GBK, BIG5, SHIFT_JIS, EUC_KR];
/// Encodings with Latin letters that windows-1252 does not have.
const LATIN: [&Encoding; 2] = [WINDOWS_1250, WINDOWS_1254];
/// Encodings of other alphabets.
const OTHER_ALPHABET: [&Encoding; 2] = [WINDOWS_1251, WINDOWS_1253];
/// Number of words with non-ASCII letters that are evidence for one of [`LATIN`].
const MIN_WORDS: usize = 3;
/// Minimum length of a word, bytes; shorter ones may be units and signs such as `µm`.
const MIN_WORD: usize = 3;
/// Length of a word without ASCII letters that is evidence for one of [`OTHER_ALPHABET`], bytes.
const MIN_OTHER_WORD: usize = 4;
/// Number of characters that are evidence for GBK, the most frequent of [`DOUBLE_BYTE`].
const MIN_CHARACTERS: usize = 2;
/// Number of characters that are evidence for the others.
const FEW_CHARACTERS: usize = 4;
/// Bytes of non-ASCII lines used for the statistics: more make it slower, not better.
const MAX_SAMPLE: usize = 1 << 16;
/// Number of valid UTF-8 sequences that outweigh one invalid byte.
const VALID_TO_INVALID: usize = 4;

/// The encoding of bytes that are not plain UTF-8.
pub(super) fn legacy(bytes: &[u8]) -> &'static Encoding {
    if is_damaged_utf8(bytes) {
        return UTF_8;
    }
    let sample = Sample::of(bytes);
    // A few comments cut in the middle of a character do not count against the encoding.
    let whole = |encoding: &'static Encoding| {
        let valid = |line: &&[u8]| decodes(encoding, line);
        let lines: Vec<&[u8]> = sample.lines.iter().copied().filter(valid).collect();
        let cut = sample.lines.len() - lines.len();
        (cut * VALID_TO_INVALID <= lines.len()).then_some(lines)
    };
    let mut asked: Vec<Vec<&[u8]>> = vec![sample.lines.clone()];
    asked.extend(whole(GBK));
    for lines in asked {
        let guess = match guess(&lines) {
            // Both encode the same languages; windows-1250 is more likely.
            guess if guess == ISO_8859_2 => WINDOWS_1250,
            guess => guess,
        };
        if DOUBLE_BYTE.contains(&guess) && whole(guess).is_some() {
            let count = characters(guess, &lines);
            if count >= FEW_CHARACTERS {
                return guess;
            }
            if count >= MIN_CHARACTERS && whole(GBK).is_some() {
                return GBK;
            }
        }
        if LATIN.contains(&guess) && sample.words >= MIN_WORDS
            || OTHER_ALPHABET.contains(&guess) && sample.longest_other >= MIN_OTHER_WORD
        {
            return guess;
        }
    }
    WINDOWS_1252
}

/// The lines with non-ASCII bytes.
struct Sample<'a> {
    lines: Vec<&'a [u8]>,
    /// Number of words with non-ASCII letters.
    words: usize,
    /// Length of the longest word without ASCII letters, bytes.
    longest_other: usize,
}

impl<'a> Sample<'a> {
    fn of(bytes: &'a [u8]) -> Sample<'a> {
        let mut sample = Sample { lines: Vec::new(), words: 0, longest_other: 0 };
        let mut size = 0;
        let mut start = 0;
        while size < MAX_SAMPLE
            && let Some(at) = bytes[start..].iter().position(|byte| !byte.is_ascii())
        {
            let is_end = |byte: &u8| matches!(byte, b'\n' | b'\r');
            let at = start + at;
            let from = bytes[start..at].iter().rposition(is_end).map_or(start, |i| start + i + 1);
            let to = bytes[at..].iter().position(is_end).map_or(bytes.len(), |i| at + i);
            // A part of a very long line is enough.
            let line = &bytes[from.max(at.saturating_sub(MAX_SAMPLE))..to.min(at + MAX_SAMPLE)];
            for word in line.split(|byte| byte.is_ascii() && !byte.is_ascii_alphabetic()) {
                sample.words += usize::from(word.len() >= MIN_WORD && !word.is_ascii());
                if word.iter().all(|byte| !byte.is_ascii()) {
                    sample.longest_other = sample.longest_other.max(word.len());
                }
            }
            sample.lines.push(line);
            size += line.len();
            start = to;
        }
        sample
    }
}

fn guess(lines: &[&[u8]]) -> &'static Encoding {
    let mut detector = EncodingDetector::new(Iso2022JpDetection::Deny);
    for line in lines {
        detector.feed(line, false);
        detector.feed(b"\n", false);
    }
    detector.feed(b"", true);
    detector.guess(None, Utf8Detection::Deny)
}

fn decodes(encoding: &'static Encoding, bytes: &[u8]) -> bool {
    encoding.decode_without_bom_handling_and_without_replacement(bytes).is_some()
}

/// Number of non-ASCII characters in the lines.
fn characters(encoding: &'static Encoding, lines: &[&[u8]]) -> usize {
    let count = |line: &&[u8]| {
        let (text, _) = encoding.decode_without_bom_handling(line);
        text.chars().filter(|c| !c.is_ascii() && *c != char::REPLACEMENT_CHARACTER).count()
    };
    lines.iter().map(count).sum()
}

/// Whether most of the non-ASCII bytes are valid UTF-8.
fn is_damaged_utf8(bytes: &[u8]) -> bool {
    let (mut valid, mut invalid) = (0, 0);
    for chunk in bytes.utf8_chunks() {
        valid += chunk.valid().bytes().filter(|byte| *byte >= 0xC0).count();
        invalid += usize::from(!chunk.invalid().is_empty());
    }
    valid > invalid * VALID_TO_INVALID
}
