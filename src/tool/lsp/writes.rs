//! Where values are written.

use crate::rapid::syntax::{Node, NodeKind, Tree};

/// Whether the value that is named at a byte is declared or assigned there.
pub(super) fn is_written(tree: &Tree, start: u32) -> bool {
    let mut node = tree.root();
    loop {
        let inside = |child: &Node<'_>| child.range().contains(&start);
        let Some(child) = node.children().find(inside) else { return false };
        let target = node.children().next().map(Node::range);
        let declares = matches!(
            node.kind(),
            NodeKind::DataDeclaration | NodeKind::Parameter | NodeKind::ForStatement
        );
        if declares && child.kind() == NodeKind::Name {
            return true;
        }
        if node.kind() == NodeKind::Assignment && target == Some(child.range()) {
            // The target may be a component or an element: the base of the chain is what is written.
            return child.range().start == start;
        }
        node = child;
    }
}
