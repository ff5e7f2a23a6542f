//! Reads the EBNF of `grammar/`.

use std::collections::BTreeMap;

/// The right side of a production.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Ebnf {
    /// `"…"`
    Literal(String),
    /// `? … ?`
    Words(String),
    /// Another production.
    Name(String),
    /// `a , b`
    Sequence(Vec<Ebnf>),
    /// `a | b`
    Choice(Vec<Ebnf>),
    /// `[ a ]`
    Optional(Box<Ebnf>),
    /// `{ a }`
    Repeat(Box<Ebnf>),
}

impl Ebnf {
    /// Names of the productions in it.
    pub(crate) fn names(&self) -> Vec<&str> {
        match self {
            Ebnf::Name(name) => vec![name],
            Ebnf::Literal(_) | Ebnf::Words(_) => Vec::new(),
            Ebnf::Sequence(parts) | Ebnf::Choice(parts) => {
                parts.iter().flat_map(Ebnf::names).collect()
            }
            Ebnf::Optional(part) | Ebnf::Repeat(part) => part.names(),
        }
    }

    /// Its literals.
    pub(crate) fn literals(&self) -> Vec<&str> {
        match self {
            Ebnf::Literal(text) => vec![text],
            Ebnf::Name(_) | Ebnf::Words(_) => Vec::new(),
            Ebnf::Sequence(parts) | Ebnf::Choice(parts) => {
                parts.iter().flat_map(Ebnf::literals).collect()
            }
            Ebnf::Optional(part) | Ebnf::Repeat(part) => part.literals(),
        }
    }
}

/// The productions of one file, by name.
pub(crate) fn read(text: &str) -> BTreeMap<String, Ebnf> {
    let mut reader = Reader { tokens: tokens(text), at: 0 };
    let mut productions = BTreeMap::new();
    while reader.at < reader.tokens.len() {
        let name = reader.next();
        assert_eq!(reader.next(), "=", "after {name}");
        let body = reader.choice();
        assert_eq!(reader.next(), ";", "after the production {name}");
        assert!(productions.insert(name.clone(), body).is_none(), "{name} twice");
    }
    productions
}

/// Words, marks, and literals and `? … ?` with their quotes.
fn tokens(text: &str) -> Vec<String> {
    let mut tokens = Vec::new();
    let mut rest = text.trim_start();
    while let Some(first) = rest.chars().next() {
        let length = match first {
            '(' if rest.starts_with("(*") => {
                let end = rest.find("*)").expect("a comment ends");
                rest = rest[end + 2..].trim_start();
                continue;
            }
            '"' | '\'' | '?' => rest[1..].find(first).expect("a literal ends") + 2,
            _ if first.is_alphanumeric() => {
                rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len())
            }
            _ => 1,
        };
        tokens.push(rest[..length].to_owned());
        rest = rest[length..].trim_start();
    }
    tokens
}

struct Reader {
    tokens: Vec<String>,
    at: usize,
}

impl Reader {
    fn next(&mut self) -> String {
        self.at += 1;
        self.tokens[self.at - 1].clone()
    }

    fn eat(&mut self, mark: &str) -> bool {
        let there = self.tokens.get(self.at).is_some_and(|token| token == mark);
        self.at += usize::from(there);
        there
    }

    fn choice(&mut self) -> Ebnf {
        let mut parts = vec![self.sequence()];
        while self.eat("|") {
            parts.push(self.sequence());
        }
        if parts.len() == 1 { parts.remove(0) } else { Ebnf::Choice(parts) }
    }

    fn sequence(&mut self) -> Ebnf {
        let mut parts = vec![self.part()];
        while self.eat(",") {
            parts.push(self.part());
        }
        if parts.len() == 1 { parts.remove(0) } else { Ebnf::Sequence(parts) }
    }

    fn part(&mut self) -> Ebnf {
        let token = self.next();
        let inner = |text: &str| text[1..text.len() - 1].to_owned();
        let (part, closer) = match token.chars().next() {
            Some('(') => (self.choice(), ")"),
            Some('[') => (Ebnf::Optional(Box::new(self.choice())), "]"),
            Some('{') => (Ebnf::Repeat(Box::new(self.choice())), "}"),
            Some('"' | '\'') => return Ebnf::Literal(inner(&token)),
            Some('?') => return Ebnf::Words(inner(&token).trim().to_owned()),
            _ => return Ebnf::Name(token),
        };
        assert!(self.eat(closer), "{closer} missing near {:?}", &self.tokens[self.at - 1]);
        part
    }
}
