//! Single changes of programs, each with what has to be found.

use std::ops::Range;

use joulepath::rapid::builtins::{self, Instruction, instruction};
use joulepath::rapid::syntax::{self, Node, NodeKind, TokenKind};

/// A change of a program, and what has to be found.
pub(crate) struct Edit {
    pub(crate) place: Range<usize>,
    pub(crate) text: Vec<u8>,
    pub(crate) action: &'static str,
    pub(crate) subject: Option<&'static str>,
    /// mm along x.
    pub(crate) moved: Option<f64>,
}

/// All single changes of a kind that a program admits.
pub(crate) fn edits(bytes: &[u8], kind: usize) -> Vec<Edit> {
    let parse = syntax::parse(bytes);
    let range = |node: Node<'_>| node.range().start as usize..node.range().end as usize;
    let mut found = Vec::new();
    let change = |place, text: &str, subject| Edit {
        place,
        text: text.as_bytes().to_vec(),
        action: "changed",
        subject: Some(subject),
        moved: None,
    };
    for node in parse.tree.nodes() {
        match (kind, node.kind()) {
            // Another place of a taught position.
            (0, NodeKind::DataDeclaration) => {
                let of = node.child(NodeKind::TypeName).unwrap().text(bytes).to_ascii_lowercase();
                let value =
                    node.children().filter(|child| child.kind() == NodeKind::Aggregate).last();
                let mut numbers = value.into_iter().flat_map(Node::subtree);
                let first = numbers.find(|n| n.kind() == NodeKind::NumberLiteral);
                let is_plain = node.child(NodeKind::Dimensions).is_none();
                if of == b"robtarget"
                    && is_plain
                    && let Some(first) = first
                {
                    let old: f64 = String::from_utf8_lossy(first.text(bytes)).parse().unwrap();
                    let is_negative = bytes[..range(first).start].ends_with(b"-");
                    let text = format!("{}", old + 1.5);
                    let by = if is_negative { -1.5 } else { 1.5 };
                    found.push(Edit { moved: Some(by), ..change(range(first), &text, "target") });
                }
            }
            // Speeds, zones, tools of movements; waits; outputs.
            (1..=3, NodeKind::CallStatement) => {
                let name = node
                    .callee()
                    .map(|name| String::from_utf8_lossy(name.text(bytes)).to_lowercase());
                let Some(signature) = name.as_deref().and_then(builtins::movement) else {
                    continue;
                };
                let values: Vec<Node<'_>> =
                    node.children().skip(1).filter(|child| child.kind().is_value()).collect();
                let circular = usize::from(signature.form == builtins::MoveForm::Circular);
                let speed = signature.before + circular + 1;
                let zone = speed + 1 + signature.between;
                let tool = zone + usize::from(signature.zone);
                let (at, text, subject) = match kind {
                    1 => (speed, "[123,456,789,12]", "speed"),
                    2 if signature.zone => (zone, "zOther", "zone"),
                    3 if signature.form != builtins::MoveForm::ExternalJoint => {
                        (tool, "tOther", "tool")
                    }
                    _ => continue,
                };
                if let Some(value) = values.get(at) {
                    found.push(change(range(*value), text, subject));
                }
            }
            (4, NodeKind::CallStatement) => {
                let name = node
                    .callee()
                    .map(|name| String::from_utf8_lossy(name.text(bytes)).to_lowercase());
                let waits =
                    name.as_deref().and_then(instruction).is_some_and(Instruction::waits_for_time);
                let value =
                    node.children().skip(1).find(|child| child.kind() == NodeKind::NumberLiteral);
                if waits && let Some(value) = value {
                    found.push(change(range(value), "47.25", "wait"));
                }
            }
            (5, NodeKind::CallStatement) => {
                let name = node.callee().unwrap_or(node);
                let text = String::from_utf8_lossy(name.text(bytes)).to_lowercase();
                if text == "set" || text == "reset" {
                    let other = if text == "set" { "Reset" } else { "Set" };
                    found.push(change(range(name), other, "output"));
                } else if text == "setdo" {
                    let values: Vec<Node<'_>> =
                        node.children().skip(1).filter(|child| child.kind().is_value()).collect();
                    if let Some(value) = values.get(1) {
                        found.push(change(range(*value), "nOther", "output"));
                    }
                }
            }
            // A statement less, or two in another order.
            (6 | 7, NodeKind::Block) => {
                let all: Vec<Node<'_>> = node.children().collect();
                for pair in all.windows(2) {
                    let [a, b] = pair else { continue };
                    if !a.kind().is_statement() || !b.kind().is_statement() {
                        continue;
                    }
                    let (first, second) = (range(*a), range(*b));
                    if kind == 6 {
                        found.push(Edit {
                            place: first,
                            text: Vec::new(),
                            action: "removed",
                            subject: None,
                            moved: None,
                        });
                    } else if words(a.text(bytes)) != words(b.text(bytes)) {
                        let text = [b.text(bytes), b"\n", a.text(bytes)].concat();
                        found.push(Edit {
                            place: first.start..second.end,
                            text,
                            action: "moved",
                            subject: None,
                            moved: None,
                        });
                    }
                }
            }
            _ => {}
        }
    }
    found
}

fn words(text: &[u8]) -> Vec<u8> {
    let words = super::words(text).into_iter();
    words
        .filter(|(kind, _)| *kind != TokenKind::Comment)
        .flat_map(|(_, text)| text.to_ascii_lowercase())
        .collect()
}
