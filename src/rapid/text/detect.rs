//! Which encoding a file without a byte order mark seems to have.
//!
//! Controllers write ISO 8859-1 or UTF-8, people whatever their editor was set to. UTF-8 shows
//! in its own structure. The others are told apart by the statistics of `chardetng`, made for
//! whole web pages: on a single comment it guesses odd things. So only windows-1252 is believed
//! without evidence: it is the most frequent one, gives every byte a character and loses none.

use chardetng::{EncodingDetector, Iso2022JpDetection, Utf8Detection};
use encoding_rs::{
    BIG5, EUC_KR, Encoding, GBK, ISO_8859_2, SHIFT_JIS, UTF_8, WINDOWS_1250, WINDOWS_1251,
    WINDOWS_1252, WINDOWS_1253, WINDOWS_1254,
};

/// Encodings with characters of two bytes that are seen in RAPID.
const DOUBLE_BYTE: [&Encoding; 4] = [GBK, BIG5, SHIFT_JIS, EUC_KR];
/// Encodings of other Latin letters than those of windows-1252.
const LATIN: [&Encoding; 2] = [WINDOWS_1250, WINDOWS_1254];
/// Encodings of other alphabets.
const OTHER_ALPHABET: [&Encoding; 2] = [WINDOWS_1251, WINDOWS_1253];
/// Words with letters beyond ASCII that are evidence for one of [`LATIN`].
const MIN_WORDS: usize = 3;
/// Length of a word; shorter ones may be units and signs such as `µm`.
const MIN_WORD: usize = 3;
/// Length of a word without an ASCII letter that is evidence for one of [`OTHER_ALPHABET`].
const MIN_OTHER_WORD: usize = 4;
/// Characters that are evidence for Chinese, the most frequent of [`DOUBLE_BYTE`].
const MIN_CHARACTERS: usize = 2;
/// Characters that are evidence for the others.
const FEW_CHARACTERS: usize = 4;
/// Bytes of lines beyond ASCII that the statistics get to see: more make it slower, not better.
const MAX_SAMPLE: usize = 1 << 16;
/// Valid sequences of UTF-8 that outweigh one byte that is in none.
const VALID_TO_INVALID: usize = 4;

/// The encoding of bytes that are not plain UTF-8.
pub(super) fn legacy(bytes: &[u8]) -> &'static Encoding {
    if is_damaged_utf8(bytes) {
        return UTF_8;
    }
    let sample = Sample::of(bytes);
    // A comment that was cut in the middle of a character must not speak against the others.
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
            // They differ in letters that the file would have to use; Windows is likelier.
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

/// The lines with bytes beyond ASCII.
struct Sample<'a> {
    lines: Vec<&'a [u8]>,
    /// Words with letters beyond ASCII.
    words: usize,
    /// Bytes of the longest word without an ASCII letter.
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
            // Of an endless line its first part is enough.
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

/// Characters beyond ASCII in the lines.
fn characters(encoding: &'static Encoding, lines: &[&[u8]]) -> usize {
    let count = |line: &&[u8]| {
        let (text, _) = encoding.decode_without_bom_handling(line);
        text.chars().filter(|c| !c.is_ascii() && *c != char::REPLACEMENT_CHARACTER).count()
    };
    lines.iter().map(count).sum()
}

/// Whether most of what lies beyond ASCII is UTF-8.
fn is_damaged_utf8(bytes: &[u8]) -> bool {
    let (mut valid, mut invalid) = (0, 0);
    for chunk in bytes.utf8_chunks() {
        valid += chunk.valid().bytes().filter(|byte| *byte >= 0xC0).count();
        invalid += usize::from(!chunk.invalid().is_empty());
    }
    valid > invalid * VALID_TO_INVALID
}
