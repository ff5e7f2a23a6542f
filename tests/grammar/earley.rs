//! A recogniser for any context-free grammar (Earley 1970, with the treatment of empty rules by
//! Aycock and Horspool 2002), slow and independent of the parser.

use std::collections::{BTreeMap, BTreeSet};

use crate::ebnf::Ebnf;

/// A symbol of a rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Symbol {
    /// Index of a terminal.
    Terminal(usize),
    /// Index of a rule set.
    Rules(usize),
}

/// A grammar in plain rules, converted from EBNF.
pub(crate) struct Grammar {
    /// Literals, words and classes that match one unit of input.
    terminals: Vec<Ebnf>,
    /// Name (empty for groups) and alternatives of each rule set.
    rules: Vec<(String, Vec<Vec<Symbol>>)>,
    nullable: Vec<bool>,
    by_name: BTreeMap<String, usize>,
}

/// A rule set, and the range of input that it matches.
type Match = (usize, usize, usize);

impl Grammar {
    /// Productions without a definition are terminals.
    pub(crate) fn new(productions: &BTreeMap<String, Ebnf>) -> Grammar {
        let mut grammar = Grammar {
            terminals: Vec::new(),
            rules: Vec::new(),
            nullable: Vec::new(),
            by_name: BTreeMap::new(),
        };
        for name in productions.keys() {
            grammar.by_name.insert(name.clone(), grammar.rules.len());
            grammar.rules.push((name.clone(), Vec::new()));
        }
        for (name, body) in productions {
            let alternatives = grammar.alternatives(body);
            let index = grammar.by_name[name];
            grammar.rules[index].1 = alternatives;
        }
        grammar.nullable = vec![false; grammar.rules.len()];
        loop {
            let before = grammar.nullable.clone();
            for (index, (_, alternatives)) in grammar.rules.iter().enumerate() {
                grammar.nullable[index] |= alternatives.iter().any(|symbols| {
                    symbols.iter().all(|symbol| match *symbol {
                        Symbol::Terminal(_) => false,
                        Symbol::Rules(index) => before[index],
                    })
                });
            }
            if before == grammar.nullable {
                return grammar;
            }
        }
    }

    fn alternatives(&mut self, body: &Ebnf) -> Vec<Vec<Symbol>> {
        match body {
            Ebnf::Choice(parts) => parts.iter().flat_map(|part| self.alternatives(part)).collect(),
            Ebnf::Sequence(parts) => vec![parts.iter().map(|part| self.symbol(part)).collect()],
            Ebnf::Optional(part) => {
                let mut alternatives = self.alternatives(part);
                alternatives.push(Vec::new());
                alternatives
            }
            other => vec![vec![self.symbol(other)]],
        }
    }

    fn symbol(&mut self, part: &Ebnf) -> Symbol {
        match part {
            Ebnf::Name(name) if self.by_name.contains_key(name) => {
                Symbol::Rules(self.by_name[name])
            }
            Ebnf::Name(_) | Ebnf::Literal(_) | Ebnf::Words(_) => {
                let known = self.terminals.iter().position(|terminal| terminal == part);
                Symbol::Terminal(known.unwrap_or_else(|| {
                    self.terminals.push(part.clone());
                    self.terminals.len() - 1
                }))
            }
            Ebnf::Repeat(inner) => {
                let index = self.rules.len();
                self.rules.push((String::new(), Vec::new()));
                let once = self.alternatives(inner);
                let more = once.into_iter().map(|mut symbols| {
                    symbols.insert(0, Symbol::Rules(index));
                    symbols
                });
                self.rules[index].1 = more.chain([Vec::new()]).collect();
                Symbol::Rules(index)
            }
            Ebnf::Sequence(_) | Ebnf::Choice(_) | Ebnf::Optional(_) => {
                let alternatives = self.alternatives(part);
                self.rules.push((String::new(), alternatives));
                Symbol::Rules(self.rules.len() - 1)
            }
        }
    }

    /// Whether `start` derives the input, and the productions of one derivation; `matches` decides
    /// whether unit `i` matches a terminal.
    pub(crate) fn recognise(
        &self,
        start: &str,
        length: usize,
        matches: impl Fn(&Ebnf, usize) -> bool,
    ) -> Option<BTreeSet<String>> {
        let completed = self.chart(self.by_name[start], length, &matches)?;
        let mut ends: BTreeMap<(usize, usize), Vec<usize>> = BTreeMap::new();
        for &(rules, from, to) in &completed {
            ends.entry((rules, from)).or_default().push(to);
        }
        let mut used = BTreeSet::new();
        let mut seen = BTreeSet::new();
        let mut open = vec![(self.by_name[start], 0, length)];
        while let Some((rules, from, to)) = open.pop() {
            if !seen.insert((rules, from, to)) {
                continue;
            }
            let (name, alternatives) = &self.rules[rules];
            used.insert(name.clone());
            let derivation = alternatives
                .iter()
                .find_map(|symbols| {
                    split(symbols, from, to, &ends, &|terminal, at| {
                        at < length && matches(&self.terminals[terminal], at)
                    })
                })
                .expect("what is complete has a derivation");
            open.extend(derivation);
        }
        used.remove("");
        Some(used)
    }

    /// All matches; `None` if `start` does not match the whole input.
    fn chart(
        &self,
        start: usize,
        length: usize,
        matches: &impl Fn(&Ebnf, usize) -> bool,
    ) -> Option<BTreeSet<Match>> {
        // An item: rule set, alternative, number of completed symbols, start.
        type Item = (usize, usize, usize, usize);
        let mut completed = BTreeSet::new();
        let mut columns: Vec<Vec<Item>> = vec![Vec::new(); length + 1];
        let mut seen: Vec<BTreeSet<Item>> = vec![BTreeSet::new(); length + 1];
        let mut add = |columns: &mut Vec<Vec<Item>>, at: usize, item: Item| {
            if seen[at].insert(item) {
                columns[at].push(item);
            }
        };
        for alternative in 0..self.rules[start].1.len() {
            add(&mut columns, 0, (start, alternative, 0, 0));
        }
        for at in 0..=length {
            let mut next = 0;
            while next < columns[at].len() {
                let (rules, alternative, done, from) = columns[at][next];
                next += 1;
                match self.rules[rules].1[alternative].get(done).copied() {
                    None => {
                        completed.insert((rules, from, at));
                        let waiting: Vec<Item> = columns[from]
                            .iter()
                            .filter(|&&(rules_, alternative_, done_, _)| {
                                self.rules[rules_].1[alternative_].get(done_)
                                    == Some(&Symbol::Rules(rules))
                            })
                            .copied()
                            .collect();
                        for (rules, alternative, done, from) in waiting {
                            add(&mut columns, at, (rules, alternative, done + 1, from));
                        }
                    }
                    Some(Symbol::Terminal(terminal)) => {
                        if at < length && matches(&self.terminals[terminal], at) {
                            add(&mut columns, at + 1, (rules, alternative, done + 1, from));
                        }
                    }
                    Some(Symbol::Rules(wanted)) => {
                        for index in 0..self.rules[wanted].1.len() {
                            add(&mut columns, at, (wanted, index, 0, at));
                        }
                        if self.nullable[wanted] {
                            add(&mut columns, at, (rules, alternative, done + 1, from));
                        }
                    }
                }
            }
        }
        completed.contains(&(start, 0, length)).then_some(completed)
    }
}

/// A partition of the input between two places among `symbols`.
fn split(
    symbols: &[Symbol],
    from: usize,
    to: usize,
    ends: &BTreeMap<(usize, usize), Vec<usize>>,
    matches: &impl Fn(usize, usize) -> bool,
) -> Option<Vec<Match>> {
    match symbols {
        [] => (from == to).then(Vec::new),
        [Symbol::Terminal(terminal), rest @ ..] => (from < to && matches(*terminal, from))
            .then(|| split(rest, from + 1, to, ends, matches))
            .flatten(),
        [Symbol::Rules(rules), rest @ ..] => {
            ends.get(&(*rules, from))?.iter().filter(|&&end| end <= to).find_map(|&end| {
                let mut derivation = split(rest, end, to, ends, matches)?;
                derivation.push((*rules, from, end));
                Some(derivation)
            })
        }
    }
}
