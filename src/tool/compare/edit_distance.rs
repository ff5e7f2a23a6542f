//! The cheapest way to edit one ordered forest into another (Zhang and Shasha, 1989).
//!
//! Nodes are deleted, inserted or changed; a deleted node leaves its children where they are. So an
//! `IF` around ten movements is one insertion. A tree that stands once on both sides is one node: it is
//! kept or moved as a whole.

use std::collections::BTreeSet;

use super::cost::{DELETE, INSERT, NEVER, change};
use super::node::Node;

/// A forest in postorder, with a root that stands for the whole.
struct Postorder<'n, 'a> {
    nodes: Vec<&'n Node<'a>>,
    /// Position of the leftmost leaf below each node; the last is that of the root.
    leftmost: Vec<usize>,
    /// Roots of the subproblems, ascending.
    keyroots: Vec<usize>,
}

impl<'n, 'a> Postorder<'n, 'a> {
    fn new(forest: &[&'n Node<'a>], wholes: &BTreeSet<u32>) -> Postorder<'n, 'a> {
        let mut order = Postorder { nodes: Vec::new(), leftmost: Vec::new(), keyroots: Vec::new() };
        for tree in forest {
            order.visit(tree, wholes);
        }
        order.leftmost.push(0);
        let mut taken = vec![false; order.leftmost.len()];
        for index in (0..order.leftmost.len()).rev() {
            if !std::mem::replace(&mut taken[order.leftmost[index]], true) {
                order.keyroots.push(index);
            }
        }
        order.keyroots.reverse();
        order
    }

    // The depth of statements is limited by the parser.
    fn visit(&mut self, node: &'n Node<'a>, wholes: &BTreeSet<u32>) {
        let first = self.nodes.len();
        if !wholes.contains(&node.whole) {
            for child in &node.children {
                self.visit(child, wholes);
            }
        }
        let leftmost = if self.nodes.len() == first { first } else { self.leftmost[first] };
        self.nodes.push(node);
        self.leftmost.push(leftmost);
    }

    /// Sum of the sizes of all subproblems.
    fn work(&self) -> u64 {
        self.keyroots.iter().map(|root| (root + 1 - self.leftmost[*root]) as u64).sum()
    }
}

/// Costs of the edits of all pairs of subtrees, row by row.
struct Distances<'w> {
    columns: usize,
    trees: Vec<u32>,
    wholes: &'w BTreeSet<u32>,
}

/// The pairs of nodes that correspond in the cheapest edit; `None` if it takes more than `most` steps.
/// The trees with the numbers `wholes` are nodes without anything below.
pub(super) fn pairs<'n, 'a>(
    old: &[&'n Node<'a>],
    new: &[&'n Node<'a>],
    wholes: &BTreeSet<u32>,
    most: u64,
) -> Option<Vec<(&'n Node<'a>, &'n Node<'a>)>> {
    let (old, new) = (Postorder::new(old, wholes), Postorder::new(new, wholes));
    if old.work().saturating_mul(new.work()) > most {
        return None;
    }
    let columns = new.leftmost.len();
    let trees = vec![0; old.leftmost.len() * columns];
    let mut distances = Distances { columns, trees, wholes };
    for i in &old.keyroots {
        for j in &new.keyroots {
            distances.forest(&old, &new, *i, *j);
        }
    }
    let mut found = Vec::new();
    let mut open = vec![(old.nodes.len(), new.nodes.len())];
    while let Some((i, j)) = open.pop() {
        distances.trace(&old, &new, i, j, &mut found, &mut open);
    }
    Some(found)
}

impl Distances<'_> {
    fn tree(&self, i: usize, j: usize) -> u32 {
        self.trees[i * self.columns + j]
    }

    /// The costs between the beginnings of the subtrees at `i` and `j`: `(rows, columns)` count the
    /// nodes of each. Fills in the costs of the subtrees on the way.
    fn forest(
        &mut self,
        old: &Postorder<'_, '_>,
        new: &Postorder<'_, '_>,
        i: usize,
        j: usize,
    ) -> Vec<u32> {
        let (first_i, first_j) = (old.leftmost[i], new.leftmost[j]);
        let (rows, columns) = (i + 2 - first_i, j + 2 - first_j);
        let mut cost = vec![0; rows * columns];
        for row in 1..rows {
            cost[row * columns] = cost[(row - 1) * columns] + DELETE;
        }
        for column in 1..columns {
            cost[column] = cost[column - 1] + INSERT;
        }
        for row in 1..rows {
            let a = first_i + row - 1;
            for column in 1..columns {
                let b = first_j + column - 1;
                let delete = cost[(row - 1) * columns + column] + DELETE;
                let insert = cost[row * columns + column - 1] + INSERT;
                let whole = old.leftmost[a] == first_i && new.leftmost[b] == first_j;
                let both = if whole {
                    cost[(row - 1) * columns + column - 1] + self.replaced(old, new, a, b)
                } else {
                    let (before_a, before_b) =
                        (old.leftmost[a] - first_i, new.leftmost[b] - first_j);
                    cost[before_a * columns + before_b] + self.tree(a, b)
                };
                let least = delete.min(insert).min(both);
                cost[row * columns + column] = least;
                if whole {
                    self.trees[a * self.columns + b] = least;
                }
            }
        }
        cost
    }

    /// Adds the pairs of the cheapest edit of two subtrees, and the smaller subtrees that remain.
    fn trace<'n, 'a>(
        &mut self,
        old: &Postorder<'n, 'a>,
        new: &Postorder<'n, 'a>,
        i: usize,
        j: usize,
        found: &mut Vec<(&'n Node<'a>, &'n Node<'a>)>,
        open: &mut Vec<(usize, usize)>,
    ) {
        let cost = self.forest(old, new, i, j);
        let (first_i, first_j) = (old.leftmost[i], new.leftmost[j]);
        let columns = j + 2 - first_j;
        let (mut row, mut column) = (i + 1 - first_i, j + 1 - first_j);
        while row > 0 && column > 0 {
            let (a, b) = (first_i + row - 1, first_j + column - 1);
            let here = cost[row * columns + column];
            let whole = old.leftmost[a] == first_i && new.leftmost[b] == first_j;
            if whole
                && here == cost[(row - 1) * columns + column - 1] + self.replaced(old, new, a, b)
            {
                if let (Some(a), Some(b)) = (old.nodes.get(a), new.nodes.get(b)) {
                    found.push((*a, *b));
                }
                (row, column) = (row - 1, column - 1);
                continue;
            }
            let (before_a, before_b) = (old.leftmost[a] - first_i, new.leftmost[b] - first_j);
            if !whole && here == cost[before_a * columns + before_b] + self.tree(a, b) {
                open.push((a, b));
                (row, column) = (before_a, before_b);
            } else if here == cost[(row - 1) * columns + column] + DELETE {
                row -= 1;
            } else {
                column -= 1;
            }
        }
    }

    /// The cost of making the node at `b` of the node at `a`; the roots correspond to each other.
    fn replaced(
        &self,
        old: &Postorder<'_, '_>,
        new: &Postorder<'_, '_>,
        a: usize,
        b: usize,
    ) -> u32 {
        match (old.nodes.get(a), new.nodes.get(b)) {
            (Some(old), Some(new)) if old.whole == new.whole => 0,
            (Some(old), Some(new))
                if self.wholes.contains(&old.whole) || self.wholes.contains(&new.whole) =>
            {
                NEVER
            }
            (Some(old), Some(new)) => change(old, new),
            (None, None) => 0,
            _ => NEVER,
        }
    }
}
