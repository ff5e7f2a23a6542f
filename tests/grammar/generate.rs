//! Generates programs from the written grammar. Each choice consumes a byte of a tape, so that a
//! failing program shrinks with its tape; after the end of the tape, the shortest alternative is
//! used.

use std::collections::BTreeMap;

use crate::ebnf::Ebnf;

/// Nesting depth of productions beyond which the shortest alternative is used.
const DEEPEST: usize = 40;
/// Names in the programs; none is a keyword.
const NAMES: [&str; 6] = ["a", "reg1", "MoveL", "p_10", "tool0", "Año"];
const NUMBERS: [&str; 9] = ["0", "12", "1.5", ".5", "5.", "1E+3", "9e9", "0xFf", "0b101"];
const STRINGS: [&str; 5] =
    ["\"\"", "\"text\"", "\"a\"\"b\"", "\"C:\\\\x\\0A\"", "\"! no comment\""];
const PLACEHOLDERS: [&str; 5] = ["<SMT>", "<EXP>", "<ID>", "<VAR>", "<TDN>"];

/// Generates programs.
pub(crate) struct Generator<'g> {
    productions: &'g BTreeMap<String, Ebnf>,
    /// Least depth of each production.
    heights: BTreeMap<&'g str, usize>,
}

impl<'g> Generator<'g> {
    pub(crate) fn new(productions: &'g BTreeMap<String, Ebnf>) -> Generator<'g> {
        let mut generator = Generator { productions, heights: BTreeMap::new() };
        loop {
            let mut changed = false;
            for (name, body) in productions {
                let height = generator.height(body).map(|below| below + 1);
                if let Some(height) = height
                    && generator.heights.get(name.as_str()).is_none_or(|known| height < *known)
                {
                    generator.heights.insert(name, height);
                    changed = true;
                }
            }
            if !changed {
                return generator;
            }
        }
    }

    fn height(&self, body: &Ebnf) -> Option<usize> {
        match body {
            Ebnf::Name(name) if self.productions.contains_key(name) => {
                self.heights.get(name.as_str()).copied()
            }
            Ebnf::Sequence(parts) => {
                parts.iter().try_fold(0, |most, part| Some(most.max(self.height(part)?)))
            }
            Ebnf::Choice(parts) => parts.iter().filter_map(|part| self.height(part)).min(),
            _ => Some(0),
        }
    }

    /// The tokens of a derivation of a production.
    pub(crate) fn tokens(&self, production: &str, tape: &[u8]) -> Vec<String> {
        let mut out = Vec::new();
        let mut tape = tape.iter().copied();
        self.derive(&self.productions[production], &mut tape, 0, &mut out);
        out
    }

    fn derive(
        &self,
        body: &Ebnf,
        tape: &mut impl Iterator<Item = u8>,
        depth: usize,
        out: &mut Vec<String>,
    ) {
        let mut pick = |tape: &mut dyn Iterator<Item = u8>, words: &[&str]| {
            let index = usize::from(tape.next().unwrap_or(0)) % words.len();
            out.push(words[index].to_owned());
        };
        match body {
            Ebnf::Literal(text) => out.push(text.clone()),
            Ebnf::Words(_) => {}
            Ebnf::Name(name) => match name.as_str() {
                "identifier" => pick(tape, &NAMES),
                "number" => pick(tape, &NUMBERS),
                "string" => pick(tape, &STRINGS),
                "placeholder" => pick(tape, &PLACEHOLDERS),
                "encoded_module" | "header" => {}
                _ => self.derive(&self.productions[name], tape, depth + 1, out),
            },
            Ebnf::Sequence(parts) => {
                for part in parts {
                    self.derive(part, tape, depth, out);
                }
            }
            Ebnf::Choice(parts) => {
                let shortest = parts.iter().min_by_key(|part| self.height(part));
                let chosen = match tape.next() {
                    Some(byte) if depth < DEEPEST => parts.get(usize::from(byte) % parts.len()),
                    _ => shortest,
                };
                self.derive(chosen.unwrap_or(&parts[0]), tape, depth, out);
            }
            Ebnf::Optional(part) => {
                if depth < DEEPEST && tape.next().is_some_and(|byte| byte % 2 == 1) {
                    self.derive(part, tape, depth, out);
                }
            }
            Ebnf::Repeat(part) => {
                let count = match tape.next() {
                    Some(byte) if depth < DEEPEST => byte % 4,
                    _ => 0,
                };
                for _ in 0..count {
                    self.derive(part, tape, depth, out);
                }
            }
        }
    }
}

/// Tokens separated by white space and comments that a tape selects. Continuation lines of a
/// statement have a larger indentation.
pub(crate) fn spaced(tokens: &[String], tape: &[u8]) -> Vec<u8> {
    let mut text = Vec::new();
    let mut indentation = 0;
    for (index, token) in tokens.iter().enumerate() {
        match tape.get(index % tape.len().max(1)).map_or(0, |byte| byte % 8) {
            0..=3 => text.push(b' '),
            4 => text.extend(b"\t\t"),
            5 => text.extend(b"\0 "),
            choice => {
                indentation += 1;
                text.extend(if choice == 6 { &b" ! IF \"\r\n"[..] } else { b"\n" });
                text.extend(std::iter::repeat_n(b' ', indentation));
            }
        }
        text.extend(token.as_bytes());
    }
    text
}
