//! Programs as after loading and saving.

use std::ops::Range;

use joulepath::rapid::syntax::{self, Node, NodeKind, TokenKind};

use super::{Continued, Random, relaid};

/// Number tokens in another form, `PERS` values that are state, declarations in another order, another
/// header, other line ends: as after loading and saving.
pub(crate) fn resaved(bytes: &[u8], random: &mut Random) -> Vec<u8> {
    let parse = syntax::parse(bytes);
    let mut edits: Vec<(Range<usize>, Vec<u8>)> = Vec::new();
    let range = |node: Node<'_>| node.range().start as usize..node.range().end as usize;
    for node in parse.tree.nodes() {
        match node.kind() {
            NodeKind::Module => {
                let data: Vec<Node<'_>> =
                    node.children().filter(|n| n.kind() == NodeKind::DataDeclaration).collect();
                let mut order: Vec<usize> = (0..data.len()).collect();
                for i in (1..order.len()).rev() {
                    order.swap(i, random.below(i + 1));
                }
                for (slot, from) in data.iter().zip(order) {
                    edits.push((range(*slot), changed(bytes, data[from], random)));
                }
            }
            NodeKind::Header => {
                edits.push((range(node), b"%%%\n VERSION:2\n LANGUAGE:GERMAN\n%%%".to_vec()));
            }
            _ => {}
        }
    }
    let text = replaced(bytes, edits);
    let parse = syntax::parse(&text);
    let data: Vec<Range<u32>> = parse
        .tree
        .nodes()
        .filter(|node| node.kind() == NodeKind::NumberLiteral)
        .map(Node::range)
        .collect();
    let number = |place: &Range<u32>| {
        let place = place.start as usize..place.end as usize;
        let old = String::from_utf8_lossy(&text[place.clone()]).into_owned();
        (place, other_form(&old, random).into_bytes())
    };
    let mut random_layout = Random::new(data.len() as u64);
    let text = replaced(&text, data.iter().map(number).collect());
    relaid(&text, Continued::Further, &mut random_layout)
}

/// A declaration; a `PERS` of a plain type gets another value.
fn changed(bytes: &[u8], data: Node<'_>, random: &mut Random) -> Vec<u8> {
    let text = data.text(bytes).to_vec();
    let is_pers = data.own_token(TokenKind::Pers).is_some();
    let type_name =
        data.child(NodeKind::TypeName).map(|node| node.text(bytes).to_ascii_lowercase());
    let value = data.children().filter(|child| child.kind().is_value()).last();
    if let (true, Some(b"num"), Some(value)) = (is_pers, type_name.as_deref(), value)
        && value.kind() == NodeKind::NumberLiteral
    {
        let start = (value.range().start - data.range().start) as usize;
        let end = (value.range().end - data.range().start) as usize;
        return replaced(&text, vec![(start..end, random.below(1000).to_string().into_bytes())]);
    }
    text
}

fn other_form(number: &str, random: &mut Random) -> String {
    let Ok(value) = number.parse::<f64>() else { return number.to_owned() };
    match random.below(4) {
        0 if value.fract() == 0.0 && value.abs() < 1e6 => format!("{value:.1}"),
        0 => format!("{}", value as f32),
        1 if value.fract() == 0.0 => format!("{value:E}"),
        // Six significant digits of single precision, as controllers write.
        2 if value.fract() != 0.0 => {
            let stored = f64::from(value as f32);
            format!("{}", format!("{stored:.5e}").parse::<f64>().unwrap())
        }
        3 if number.contains('.') && !number.to_lowercase().contains('e') => format!("{number}00"),
        _ => number.to_owned(),
    }
}

/// The bytes with these ranges replaced; of overlapping ones the first.
pub(crate) fn replaced(bytes: &[u8], mut edits: Vec<(Range<usize>, Vec<u8>)>) -> Vec<u8> {
    edits.sort_by_key(|(range, _)| range.start);
    let mut out = Vec::new();
    let mut done = 0;
    for (range, text) in edits {
        if range.start >= done {
            out.extend(&bytes[done..range.start]);
            out.extend(text);
            done = range.end;
        }
    }
    out.extend(&bytes[done..]);
    out
}
