//! The lossless tree.
//!
//! Flat arrays: the tokens, which cover the file without gaps, and the nodes in preorder, each
//! with its range of tokens and the end of its subtree. A node takes 13 bytes and no allocation,
//! and a walk over the tree reads memory in order. No token is moved, so no byte is lost. White
//! space and comments belong to the smallest node around them.

use std::ops::Range;

use super::node::NodeKind;
use super::token::{TokenKind, Tokens};

/// A parsed file.
#[derive(Clone, Debug, Default)]
pub struct Tree {
    tokens: Tokens,
    kinds: Vec<NodeKind>,
    nodes: Vec<Entry>,
}

#[derive(Clone, Copy, Debug)]
struct Entry {
    /// Index of its first token.
    first: u32,
    /// One past its last token.
    last: u32,
    /// One past the last node of its subtree.
    end: u32,
}

/// A node of a tree.
#[derive(Clone, Copy, Debug)]
pub struct Node<'t> {
    tree: &'t Tree,
    index: usize,
}

/// A token of a tree.
#[derive(Clone, Copy, Debug)]
pub struct Token<'t> {
    tree: &'t Tree,
    index: usize,
}

/// A child of a node.
#[derive(Clone, Copy, Debug)]
pub enum Element<'t> {
    /// A node.
    Node(Node<'t>),
    /// A token of the node itself.
    Token(Token<'t>),
}

impl Tree {
    /// The node of the whole file.
    #[must_use]
    pub fn root(&self) -> Node<'_> {
        Node { tree: self, index: 0 }
    }

    /// Its tokens.
    #[must_use]
    pub fn tokens(&self) -> &Tokens {
        &self.tokens
    }

    /// All nodes in preorder.
    pub fn nodes(&self) -> impl Iterator<Item = Node<'_>> {
        (0..self.nodes.len()).map(|index| Node { tree: self, index })
    }
}

impl<'t> Node<'t> {
    fn entry(self) -> Entry {
        // In range: a tree has at least its root, and a `Node` comes only from its entries.
        self.tree.nodes[self.index]
    }

    /// Its kind.
    #[must_use]
    pub fn kind(self) -> NodeKind {
        self.tree.kinds[self.index]
    }

    /// Its bytes, without the trivia around it.
    #[must_use]
    pub fn range(self) -> Range<u32> {
        let Entry { first, last, .. } = self.entry();
        let start = self.tree.tokens.range(first as usize).start;
        if first == last {
            return start..start;
        }
        start..self.tree.tokens.range(last as usize - 1).end
    }

    /// Its bytes in the file.
    #[must_use]
    pub fn text(self, bytes: &[u8]) -> &[u8] {
        let range = self.range();
        bytes.get(range.start as usize..range.end as usize).unwrap_or_default()
    }

    /// Its child nodes in order.
    pub fn children(self) -> impl Iterator<Item = Node<'t>> + use<'t> {
        let end = self.entry().end as usize;
        let tree = self.tree;
        let mut next = self.index + 1;
        std::iter::from_fn(move || {
            if next >= end {
                return None;
            }
            let node = Node { tree, index: next };
            next = node.entry().end as usize;
            Some(node)
        })
    }

    /// Its first child of a kind.
    #[must_use]
    pub fn child(self, kind: NodeKind) -> Option<Node<'t>> {
        self.children().find(|child| child.kind() == kind)
    }

    /// The name of the procedure that a call statement calls, unless it is bound late.
    #[must_use]
    pub fn callee(self) -> Option<Node<'t>> {
        let is_call = self.kind() == NodeKind::CallStatement;
        self.children().next().filter(|first| is_call && first.kind() == NodeKind::Name)
    }

    /// The node and its descendants, in preorder.
    pub fn subtree(self) -> impl Iterator<Item = Node<'t>> + use<'t> {
        let tree = self.tree;
        (self.index..self.entry().end as usize).map(move |index| Node { tree, index })
    }

    /// Its child nodes and own tokens, trivia included, in order.
    pub fn elements(self) -> impl Iterator<Item = Element<'t>> + use<'t> {
        let tree = self.tree;
        let last = self.entry().last as usize;
        let mut token = self.entry().first as usize;
        let mut children = self.children().peekable();
        std::iter::from_fn(move || {
            if let Some(child) = children.peek().copied()
                && child.entry().first as usize <= token
            {
                children.next();
                token = token.max(child.entry().last as usize);
                return Some(Element::Node(child));
            }
            (token < last).then(|| {
                token += 1;
                Element::Token(Token { tree, index: token - 1 })
            })
        })
    }

    /// All tokens in its range, trivia included.
    pub fn all_tokens(self) -> impl Iterator<Item = Token<'t>> + use<'t> {
        let tree = self.tree;
        let Entry { first, last, .. } = self.entry();
        (first as usize..last as usize).map(move |index| Token { tree, index })
    }

    /// Its own tokens without trivia.
    pub fn own_tokens(self) -> impl Iterator<Item = Token<'t>> + use<'t> {
        self.elements().filter_map(|element| match element {
            Element::Token(token) if !token.kind().is_trivia() => Some(token),
            _ => None,
        })
    }

    /// Its first own token of a kind.
    #[must_use]
    pub fn own_token(self, kind: TokenKind) -> Option<Token<'t>> {
        self.own_tokens().find(|token| token.kind() == kind)
    }
}

impl Token<'_> {
    /// Its kind.
    #[must_use]
    pub fn kind(self) -> TokenKind {
        self.tree.tokens.kind(self.index)
    }

    /// Its bytes.
    #[must_use]
    pub fn range(self) -> Range<u32> {
        self.tree.tokens.range(self.index)
    }

    /// Its bytes in the file.
    #[must_use]
    pub fn text(self, bytes: &[u8]) -> &[u8] {
        let range = self.range();
        bytes.get(range.start as usize..range.end as usize).unwrap_or_default()
    }
}

/// The start of a node.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mark {
    token: u32,
    node: u32,
}

/// Collects nodes in postorder: a node follows its children, so that an operator can take the
/// operand before it as its child.
#[derive(Debug, Default)]
pub(super) struct Builder {
    kinds: Vec<NodeKind>,
    /// Here `end` is the number of descendants.
    nodes: Vec<Entry>,
}

impl Builder {
    pub(super) fn with_capacity(nodes: usize) -> Builder {
        Builder { kinds: Vec::with_capacity(nodes), nodes: Vec::with_capacity(nodes) }
    }

    /// Begins a node whose first token will be `token`.
    pub(super) fn mark(&self, token: usize) -> Mark {
        Mark { token: token as u32, node: self.nodes.len() as u32 }
    }

    /// Adds the node from `mark` to before token `end`; the nodes added since `mark` are its
    /// descendants. A node without tokens is empty at `end`.
    pub(super) fn finish(&mut self, mark: Mark, kind: NodeKind, end: usize) {
        let last = end as u32;
        let mut first = mark.token.min(last);
        if let Some(leaf) = self.nodes.get(mark.node as usize) {
            // The first leaf may be an empty node before the token of `mark`.
            first = first.min(leaf.first);
        }
        let below = self.nodes.len() as u32 - mark.node;
        self.kinds.push(kind);
        self.nodes.push(Entry { first, last, end: below });
    }

    /// The tree, permuted to preorder in place, because allocation dominates the time for large
    /// files.
    ///
    /// Index in preorder = index in postorder − number of descendants + number of ancestors.
    pub(super) fn finish_tree(self, tokens: Tokens) -> Tree {
        let Builder { mut kinds, mut nodes } = self;
        let mut places = vec![0_u32; nodes.len()];
        // For each ancestor, its first descendant in postorder.
        let mut above: Vec<u32> = Vec::new();
        for (index, node) in nodes.iter().enumerate().rev() {
            let index = index as u32;
            while above.last().is_some_and(|&from| index < from) {
                above.pop();
            }
            let from = index - node.end;
            places[index as usize] = from + above.len() as u32;
            above.push(from);
        }
        for index in 0..nodes.len() {
            let mut place = places[index] as usize;
            while place != index {
                kinds.swap(index, place);
                nodes.swap(index, place);
                place = std::mem::replace(&mut places[place], place as u32) as usize;
            }
            nodes[index].end += index as u32 + 1;
        }
        Tree { tokens, kinds, nodes }
    }
}
