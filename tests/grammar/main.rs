//! The grammar in `grammar/` and the parser are equivalent: a general recogniser reads programs
//! with the written grammar. It and the parser have to accept the same programs, for the fixtures
//! and their mutations; the grammar must not contain what the parser merely tolerates.

#![expect(clippy::unwrap_used, reason = "a fixture that cannot be read fails the test")]

mod earley;
mod ebnf;
mod generate;
#[path = "../support/mod.rs"]
mod support;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use earley::Grammar;
use ebnf::Ebnf;
use generate::{Generator, spaced};
use joulepath::rapid::syntax::{self, KEYWORDS, NodeKind, Parse, TokenKind, Tolerance};
use proptest::prelude::*;
use support::{Random, check_tree, fixtures};

/// The parts of the program grammar; the lexical part is separate.
const PARTS: [&str; 6] = ["modules", "data", "routines", "statements", "arguments", "expressions"];
/// Node kinds of the operator precedence levels.
const BY_LEVELS: [NodeKind; 2] = [NodeKind::BinaryExpression, NodeKind::UnaryExpression];
/// Rules that the grammar states in words only.
const IN_WORDS: [Tolerance; 1] = [Tolerance::AttributeOrder];
/// Mutations of each fixture.
const MUTATIONS: usize = 500;
/// Pieces that mutations insert in addition to single tokens.
const PIECES: [&str; 18] = [
    "+ 1",
    "- ( a )",
    "NOT",
    "AND NOT a",
    "= b",
    ", a",
    ", \\ a",
    "\\ a := b",
    ", a := b",
    ". a",
    "{ 1 }",
    "[ 1 ]",
    "a ;",
    "a := b ;",
    "IF a b ;",
    "VAR num a ;",
    "a :",
    "( 1 , a )",
];
/// Length in tokens of the longest mutated fixture: the recogniser is slow.
const LONGEST: usize = 400;

fn part(name: &str) -> BTreeMap<String, Ebnf> {
    let path =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("grammar").join(name).with_extension("ebnf");
    ebnf::read(&std::fs::read_to_string(path).unwrap())
}

fn productions() -> BTreeMap<String, Ebnf> {
    PARTS.iter().flat_map(|name| part(name)).collect()
}

/// Kinds and texts of the tokens without trivia.
fn significant(bytes: &[u8]) -> Vec<(TokenKind, String)> {
    let parse = syntax::parse(bytes);
    let tokens = parse.tree.root().all_tokens().filter(|token| !token.kind().is_trivia());
    // One character for each byte, so that any encoding survives a round trip.
    let text = |bytes: &[u8]| bytes.iter().map(|&byte| char::from(byte)).collect();
    tokens.map(|token| (token.kind(), text(token.text(bytes)))).collect()
}

fn matches(terminal: &Ebnf, (kind, text): &(TokenKind, String)) -> bool {
    match terminal {
        Ebnf::Literal(literal) => literal.eq_ignore_ascii_case(text),
        Ebnf::Name(name) => match name.as_str() {
            "identifier" => *kind == TokenKind::Identifier,
            "number" => *kind == TokenKind::Number,
            "string" => *kind == TokenKind::String,
            "placeholder" => *kind == TokenKind::Placeholder,
            "encoded" => *kind == TokenKind::Encoded,
            other => panic!("{other} is no production"),
        },
        other => panic!("{other:?} stands for no token"),
    }
}

fn recognised(grammar: &Grammar, tokens: &[(TokenKind, String)]) -> Option<BTreeSet<String>> {
    grammar.recognise("file", tokens.len(), |terminal, at| matches(terminal, &tokens[at]))
}

fn strict(parse: &Parse) -> bool {
    let deviates = |used: &syntax::Tolerated| !IN_WORDS.contains(&used.tolerance);
    parse.errors.is_empty() && !parse.tolerances.iter().any(deviates)
}

#[test]
fn node_kinds_are_productions() {
    let productions = productions();
    let tolerated = part("tolerances");
    let lexical = part("lexical");
    for kind in NodeKind::ALL.iter().filter(|kind| !BY_LEVELS.contains(kind)) {
        let name = kind.production();
        assert!(
            *kind == NodeKind::Error
                || productions.contains_key(name)
                || tolerated.contains_key(name)
                || lexical.contains_key(name),
            "{name} is missing in grammar/"
        );
    }
    for tolerance in Tolerance::ALL {
        let name = tolerance.production();
        assert!(tolerated.contains_key(name), "{name} is missing in grammar/tolerances.ebnf");
    }
}

#[test]
fn every_production_can_be_reached() {
    let lexical = part("lexical");
    let productions = productions();
    let mut reached = BTreeSet::new();
    let mut open = vec!["file", "token", "keyword"];
    while let Some(name) = open.pop() {
        if reached.insert(name) {
            let body = productions.get(name).or_else(|| lexical.get(name));
            open.extend(body.unwrap_or_else(|| panic!("{name} is not defined")).names());
        }
    }
    for name in productions.keys().chain(lexical.keys()) {
        assert!(reached.contains(name.as_str()), "{name} is used nowhere");
    }
}

#[test]
fn grammar_and_lexer_have_the_same_keywords() {
    let lexical = part("lexical");
    let written: Vec<&str> = lexical["keyword"].literals();
    let known: Vec<&str> = KEYWORDS.iter().map(|(word, _)| *word).collect();
    assert_eq!(written, known);
}

#[test]
fn fixtures_exercise_every_production() {
    let productions = productions();
    let grammar = Grammar::new(&productions);
    let mut used: BTreeSet<String> = BTreeSet::new();
    let mut kinds = BTreeSet::new();
    let mut tolerances = BTreeSet::new();
    for (name, bytes) in fixtures("ok") {
        let parse = syntax::parse(&bytes);
        kinds.extend(parse.tree.nodes().map(syntax::Node::kind));
        tolerances.extend(parse.tolerances.iter().map(|used| used.tolerance));
        let derivation = recognised(&grammar, &significant(&bytes));
        assert_eq!(derivation.is_some(), strict(&parse), "{name}");
        used.extend(derivation.unwrap_or_default());
    }
    let unused: Vec<&String> = productions.keys().filter(|name| !used.contains(*name)).collect();
    assert!(unused.is_empty(), "no fixture derives {unused:?}");
    for kind in NodeKind::ALL.iter().filter(|kind| **kind != NodeKind::Error) {
        assert!(kinds.contains(kind), "no fixture has a {}", kind.production());
    }
    for tolerance in Tolerance::ALL {
        assert!(tolerances.contains(tolerance), "no fixture needs {tolerance:?}");
    }
}

#[test]
fn grammar_and_parser_agree_on_fixtures_with_mistakes() {
    let grammar = Grammar::new(&productions());
    for (name, bytes) in fixtures("err") {
        let tokens = significant(&bytes);
        // The parser detects some mistakes by line breaks only: on one line the text could be a
        // program.
        let joined = on_one_line(&tokens);
        let expected = strict(&syntax::parse(&joined));
        assert_eq!(recognised(&grammar, &tokens).is_some(), expected, "{name}");
    }
}

/// The tokens on one line, so that the parser cannot use line breaks.
fn on_one_line(tokens: &[(TokenKind, String)]) -> Vec<u8> {
    let mut line = Vec::new();
    for (_, text) in tokens {
        line.extend(text.chars().map(|c| c as u8));
        line.push(b' ');
    }
    line
}

#[test]
fn parser_and_grammar_agree_on_mutations() {
    let grammar = Grammar::new(&productions());
    let sources: Vec<Vec<(TokenKind, String)>> = fixtures("ok")
        .iter()
        .map(|(_, bytes)| significant(bytes))
        .filter(|tokens| tokens.len() <= LONGEST && tokens.len() > 2)
        .collect();
    let pool: Vec<(TokenKind, String)> = sources.iter().flatten().cloned().collect();
    let mut random = Random(1);
    let mut accepted = 0;
    let mut disagreements = Vec::new();
    let all = sources.len() * MUTATIONS;
    for source in sources.iter().flat_map(|source| std::iter::repeat_n(source, MUTATIONS)) {
        let line = on_one_line(&mutated(source, &pool, &mut random));
        // Adjacent tokens may have merged.
        let tokens = significant(&line);
        let parse = syntax::parse(&line);
        let program = recognised(&grammar, &tokens).is_some();
        accepted += usize::from(program);
        if strict(&parse) != program {
            let line = String::from_utf8_lossy(&line).into_owned();
            disagreements
                .push(format!("{program}: {line}\n{:?} {:?}", parse.errors, parse.tolerances));
        }
    }
    assert!(disagreements.is_empty(), "{}", disagreements.join("\n"));
    // Both results occur often.
    assert!(accepted > all / 10 && accepted < all * 9 / 10, "{accepted} of {all} are programs");
}

/// A copy with one change; about a quarter of the results are programs.
fn mutated(
    source: &[(TokenKind, String)],
    pool: &[(TokenKind, String)],
    random: &mut Random,
) -> Vec<(TokenKind, String)> {
    let mut tokens = source.to_vec();
    let at = random.below(tokens.len());
    let end = (at + 1 + random.below(6)).min(tokens.len());
    let other = pool[random.below(pool.len())].clone();
    match random.below(9) {
        0 => {
            tokens.remove(at);
        }
        1 => tokens.insert(at, tokens[at].clone()),
        2 => tokens.insert(at, other),
        3 => tokens[at] = other,
        4 => {
            let like: Vec<_> = pool.iter().filter(|token| token.0 == tokens[at].0).collect();
            tokens[at] = like[random.below(like.len())].clone();
        }
        5 => tokens.swap(at, end - 1),
        6 => {
            tokens.drain(at..end);
        }
        7 => {
            let copy: Vec<_> = tokens[at..end].to_vec();
            tokens.splice(at..at, copy);
        }
        _ => {
            let piece = PIECES[random.below(PIECES.len())];
            tokens.splice(at..at, significant(piece.as_bytes()));
        }
    }
    tokens
}

#[test]
fn tokens_agree_with_the_lexical_grammar() {
    let lexical = part("lexical");
    let grammar = Grammar::new(&lexical);
    let mut used: BTreeSet<String> = BTreeSet::new();
    let mut seen = BTreeSet::new();
    for (_, bytes) in fixtures("ok") {
        for token in syntax::parse(&bytes).tree.root().all_tokens() {
            let text = token.text(&bytes);
            if !seen.insert(text.to_vec()) || token.kind() == TokenKind::Encoded {
                continue;
            }
            let production = match token.kind() {
                TokenKind::Whitespace => "whitespace",
                TokenKind::Comment => "comment",
                TokenKind::HeaderMark => "header_mark",
                TokenKind::Placeholder => "placeholder",
                TokenKind::Identifier => "identifier",
                TokenKind::Number => "number",
                TokenKind::String => "string",
                kind if kind.is_keyword() => "keyword",
                _ => continue,
            };
            let units = units(text);
            let derivation = grammar.recognise(production, units.len(), |terminal, at| {
                lexical_match(terminal, &units[at])
            });
            let shown = String::from_utf8_lossy(text);
            used.extend(derivation.unwrap_or_else(|| panic!("{shown:?} is no {production}")));
        }
    }
    let unused: Vec<&String> = lexical
        .keys()
        .filter(|name| !used.contains(*name) && !["token", "encoded"].contains(&name.as_str()))
        .collect();
    assert!(unused.is_empty(), "no fixture derives {unused:?}");
}

/// Cuts a text into the literals of the lexical grammar; the longest literal has priority.
fn units(text: &[u8]) -> Vec<Vec<u8>> {
    let long: [&[u8]; 5] = [b"%%%", b"\"\"", b"\\\\", b"0x", b"0X"];
    let based: [&[u8]; 4] = [b"0b", b"0B", b"0o", b"0O"];
    let mut units = Vec::new();
    let mut rest = text;
    let word = !text.is_empty() && text.iter().all(u8::is_ascii_alphabetic);
    if word && TokenKind::keyword(text).is_some() {
        return vec![text.to_ascii_uppercase()];
    }
    if let [b'<', name @ .., b'>'] = text {
        return vec![b"<".to_vec(), name.to_vec(), b">".to_vec()];
    }
    while let Some(first) = rest.first() {
        let inside = rest.len() < text.len() && *first == b'"' && rest.len() > 1;
        let known = long
            .iter()
            .filter(|unit| **unit != b"\"\"" || inside)
            .chain(based.iter().filter(|_| rest.len() == text.len()))
            .find(|unit| rest.starts_with(unit));
        let length = known.map_or(1, |unit| unit.len());
        units.push(rest[..length].to_vec());
        if length == 2 && *first == b'0' {
            units.push(rest[length..].to_vec());
            break;
        }
        rest = &rest[length..];
    }
    units
}

fn lexical_match(terminal: &Ebnf, unit: &[u8]) -> bool {
    let one = if let [byte] = unit { Some(*byte) } else { None };
    match terminal {
        Ebnf::Literal(literal) => literal.as_bytes() == unit,
        Ebnf::Words(words) if words.starts_with("one of the bytes 0 to 32") => {
            one.is_some_and(|byte| byte <= b' ' || byte == 127 || byte >= 128)
        }
        Ebnf::Words(words) if words.starts_with("a to z") => {
            one.is_some_and(|byte| byte.is_ascii_alphabetic() || byte == b'_' || byte >= 128)
        }
        Ebnf::Words(words) if words.starts_with("0 to 9") => {
            one.is_some_and(|byte| byte.is_ascii_hexdigit())
        }
        Ebnf::Words(words) if words.starts_with("any byte but the line ends") => {
            !unit.contains(&b'\n') && !unit.contains(&b'\r')
        }
        Ebnf::Words(words) if words.starts_with("any byte but a quotation mark") => {
            one.is_some_and(|byte| !matches!(byte, b'"' | b'\n' | b'\r'))
        }
        Ebnf::Words(words) if words.starts_with("digits of that base") => {
            unit.iter().all(u8::is_ascii_hexdigit)
        }
        Ebnf::Words(words) if words.starts_with("a whole file") => false,
        other => panic!("{other:?} stands for no text"),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..Default::default() })]

    #[test]
    fn generated_programs_are_parsed_into_their_tokens(
        tape in proptest::collection::vec(any::<u8>(), 0..2_000),
        gaps in proptest::collection::vec(any::<u8>(), 1..50),
    ) {
        let productions = productions();
        let tokens = Generator::new(&productions).tokens("module", &tape);
        let source = spaced(&tokens, &gaps);
        let parse = syntax::parse(&source);
        let shown = String::from_utf8_lossy(&source);
        prop_assert!(strict(&parse), "{:?} {:?}\n{shown}", parse.errors, parse.tolerances);
        check_tree(&parse, &source);
        let read: Vec<String> = parse
            .tree
            .root()
            .all_tokens()
            .filter(|token| !token.kind().is_trivia())
            .map(|token| String::from_utf8_lossy(token.text(&source)).into_owned())
            .collect();
        prop_assert_eq!(&read, &tokens);
        // Different white space gives the same tree.
        let printed = read.join(" ").into_bytes();
        prop_assert_eq!(shape(&syntax::parse(&printed)), shape(&parse));
    }
}

/// The tree without white space: each node with its numbers of tokens and nodes.
fn shape(parse: &Parse) -> Vec<(NodeKind, usize, usize)> {
    let significant = |node: syntax::Node<'_>| {
        node.all_tokens().filter(|token| !token.kind().is_trivia()).count()
    };
    parse
        .tree
        .nodes()
        .map(|node| (node.kind(), significant(node), node.subtree().count()))
        .collect()
}
