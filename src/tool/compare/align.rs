//! Which statements of two routines correspond.

use std::collections::{BTreeMap, BTreeSet};

use similar::{Algorithm, DiffOp, capture_diff_slices};

use super::edit_distance;
use super::node::Node;

/// Largest number of steps of one search for the cheapest edit; larger ones are divided at equal
/// statements.
const MOST_STEPS: u64 = 8_000_000;

/// Corresponding nodes: for each old number the new one, and the reverse.
#[derive(Debug)]
pub(super) struct Alignment {
    pub(super) new_of: Vec<Option<usize>>,
    pub(super) old_of: Vec<Option<usize>>,
    /// The old nodes whose equal new one stands at another place.
    pub(super) moved: BTreeMap<usize, usize>,
}

/// Aligns the statements of two routines.
pub(super) fn align(old: &[Node<'_>], new: &[Node<'_>]) -> Alignment {
    let count = |nodes: &[Node<'_>]| nodes.iter().map(|node| node.subtree().len()).sum::<usize>();
    let mut alignment = Alignment {
        new_of: vec![None; count(old)],
        old_of: vec![None; count(new)],
        moved: BTreeMap::new(),
    };
    let (olds, news): (Vec<&Node<'_>>, Vec<&Node<'_>>) =
        (old.iter().collect(), new.iter().collect());
    alignment.lists(&olds, &news);
    alignment.uncross(old, new);
    alignment.find_moved(old, new);
    alignment
}

impl Alignment {
    fn pair(&mut self, old: usize, new: usize) {
        self.new_of[old] = Some(new);
        self.old_of[new] = Some(old);
    }

    /// Two trees that are equal.
    fn equal(&mut self, old: &Node<'_>, new: &Node<'_>) {
        for (old, new) in old.subtree().into_iter().zip(new.subtree()) {
            self.pair(old.id, new.id);
        }
    }

    fn lists(&mut self, mut old: &[&Node<'_>], mut new: &[&Node<'_>]) {
        while let ([a, rest @ ..], [b, others @ ..]) = (old, new)
            && a.whole == b.whole
        {
            self.equal(a, b);
            (old, new) = (rest, others);
        }
        while let ([rest @ .., a], [others @ .., b]) = (old, new)
            && a.whole == b.whole
        {
            self.equal(a, b);
            (old, new) = (rest, others);
        }
        if old.is_empty() || new.is_empty() {
            return;
        }
        let wholes = once_in_both(old, new);
        if let Some(pairs) = edit_distance::pairs(old, new, &wholes, MOST_STEPS) {
            for (old, new) in pairs {
                if wholes.contains(&old.whole) {
                    self.equal(old, new);
                } else {
                    self.pair(old.id, new.id);
                }
            }
            return;
        }
        // Equal trees divide the lists, and where nothing is equal, equal headers of blocks.
        let whole = |nodes: &[&Node<'_>]| nodes.iter().map(|node| node.whole).collect::<Vec<_>>();
        let own = |nodes: &[&Node<'_>]| nodes.iter().map(|node| node.own).collect::<Vec<_>>();
        if !self.divided(old, new, whole) {
            self.divided(old, new, own);
        }
    }

    /// Divides two lists at nodes with equal keys; false if there are none.
    fn divided(
        &mut self,
        old: &[&Node<'_>],
        new: &[&Node<'_>],
        key: impl Fn(&[&Node<'_>]) -> Vec<u32>,
    ) -> bool {
        let ops = capture_diff_slices(Algorithm::Myers, &key(old), &key(new));
        if !ops.iter().any(|op| matches!(op, DiffOp::Equal { .. })) {
            return false;
        }
        for op in ops {
            match op {
                DiffOp::Equal { old_index, new_index, len } => {
                    for (a, b) in old[old_index..][..len].iter().zip(&new[new_index..][..len]) {
                        if a.whole == b.whole {
                            self.equal(a, b);
                        } else {
                            self.pair(a.id, b.id);
                            let below = |node: &&Node<'_>| node.children.len();
                            debug_assert!(
                                below(a) > 0 || below(b) > 0,
                                "leaves are their own whole"
                            );
                            let (a, b): (Vec<_>, Vec<_>) =
                                (a.children.iter().collect(), b.children.iter().collect());
                            self.lists(&a, &b);
                        }
                    }
                }
                DiffOp::Replace { old_index, old_len, new_index, new_len } => {
                    self.lists(&old[old_index..][..old_len], &new[new_index..][..new_len]);
                }
                DiffOp::Delete { .. } | DiffOp::Insert { .. } => {}
            }
        }
        true
    }

    /// Two statements that changed places are no two changed statements.
    fn uncross(&mut self, old: &[Node<'_>], new: &[Node<'_>]) {
        let (olds, news) = (flat(old), flat(new));
        let mut changed: BTreeMap<(u32, u32), Vec<usize>> = BTreeMap::new();
        let pairs: Vec<(usize, usize)> = self
            .new_of
            .iter()
            .enumerate()
            .filter_map(|(old, new)| Some((old, (*new)?)))
            .filter(|(a, b)| olds[*a].whole != news[*b].whole)
            .filter(|(a, b)| olds[*a].children.is_empty() && news[*b].children.is_empty())
            .collect();
        for (a, b) in pairs {
            let (from, to) = (olds[a].whole, news[b].whole);
            let opposite = changed.get_mut(&(to, from)).and_then(Vec::pop);
            let Some(other) = opposite else {
                changed.entry((from, to)).or_default().push(a);
                continue;
            };
            // `other` comes first in both; its equal is at `b`, and that of `a` where `other` was.
            let Some(first) = self.new_of[other] else { continue };
            self.pair(other, b);
            self.new_of[a] = None;
            self.old_of[first] = None;
        }
    }

    /// Removed trees that were added elsewhere.
    fn find_moved(&mut self, old: &[Node<'_>], new: &[Node<'_>]) {
        let mut added: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for node in flat(new).into_iter().rev().filter(|node| is_alone(node, &self.old_of)) {
            added.entry(node.whole).or_default().push(node.id);
        }
        for node in flat(old) {
            // A part of what has moved moves with it.
            if !is_alone(node, &self.new_of) || self.moved.contains_key(&node.id) {
                continue;
            }
            let Some(to) = added.get_mut(&node.whole).and_then(|list| {
                let free = list.iter().rposition(|id| self.old_of[*id].is_none())?;
                Some(list.remove(free))
            }) else {
                continue;
            };
            let size = node.subtree().len();
            for below in 0..size {
                self.pair(node.id + below, to + below);
                self.moved.insert(node.id + below, to + below);
            }
        }
    }
}

/// The trees of more than one node that stand exactly once on each side.
fn once_in_both(old: &[&Node<'_>], new: &[&Node<'_>]) -> BTreeSet<u32> {
    let once = |nodes: &[&Node<'_>]| -> BTreeSet<u32> {
        let mut counts: BTreeMap<u32, usize> = BTreeMap::new();
        for node in nodes.iter().flat_map(|node| node.subtree()) {
            if !node.children.is_empty() {
                *counts.entry(node.whole).or_default() += 1;
            }
        }
        counts.into_iter().filter(|(_, count)| *count == 1).map(|(whole, _)| whole).collect()
    };
    once(old).intersection(&once(new)).copied().collect()
}

/// Whether neither the node nor anything below corresponds to a node of the other side.
fn is_alone(node: &Node<'_>, other: &[Option<usize>]) -> bool {
    node.subtree().iter().all(|below| other[below.id].is_none())
}

/// All nodes, in preorder.
pub(super) fn flat<'n, 'a>(nodes: &'n [Node<'a>]) -> Vec<&'n Node<'a>> {
    nodes.iter().flat_map(Node::subtree).collect()
}
