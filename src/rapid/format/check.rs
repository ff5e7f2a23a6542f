//! Whether formatted text is still the same program.

use crate::rapid::syntax::{Parse, TokenKind, Tokens};

/// Whether two texts have the same words, comments, tree and errors.
pub(super) fn is_same(old: &[u8], before: &Parse, new: &[u8], after: &Parse) -> bool {
    let (a, b) = (before.tree.tokens(), after.tree.tokens());
    let (words, others) = (words(a), words(b));
    words.len() == others.len()
        && words.iter().zip(&others).all(|(i, j)| {
            let (from, to) = (a.range(*i), b.range(*j));
            let one = &old[from.start as usize..from.end as usize];
            let other = &new[to.start as usize..to.end as usize];
            let kind = a.kind(*i);
            kind == b.kind(*j)
                && (one == other || kind.is_keyword() && one.eq_ignore_ascii_case(other))
        })
        && nodes(before, &words).eq(nodes(after, &others))
        && before.errors.len() == after.errors.len()
        && before.errors.iter().zip(&after.errors).all(|(a, b)| a.message == b.message)
}

fn words(tokens: &Tokens) -> Vec<usize> {
    (0..tokens.count()).filter(|index| tokens.kind(*index) != TokenKind::Whitespace).collect()
}

/// Kind and first word of each node. Nodes come in the order of their first words.
fn nodes<'p>(
    parse: &'p Parse,
    words: &'p [usize],
) -> impl Iterator<Item = (crate::rapid::syntax::NodeKind, usize)> + use<'p> {
    let tokens = parse.tree.tokens();
    let mut word = 0;
    parse.tree.nodes().map(move |node| {
        let start = node.range().start;
        while words.get(word).is_some_and(|index| tokens.range(*index).start < start) {
            word += 1;
        }
        (node.kind(), word)
    })
}
