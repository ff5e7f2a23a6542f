//! Lines that stay as they are.

use std::ops::Range;

use crate::rapid::syntax::{Node, NodeKind, Parse};
use crate::rapid::text::SourceFile;

/// Ranges of bytes that stay as they are, ascending and apart from each other.
#[derive(Clone, Debug, Default)]
pub(super) struct Protected {
    ranges: Vec<Range<u32>>,
}

impl Protected {
    /// The lines of headers, of text outside of modules, and of syntax errors.
    pub(super) fn lines(file: &SourceFile, parse: &Parse) -> Protected {
        let kept = |node: &Node<'_>| {
            matches!(
                node.kind(),
                NodeKind::Header
                    | NodeKind::OutsideText
                    | NodeKind::EncodedModule
                    | NodeKind::Error
            )
        };
        let nodes = parse.tree.nodes().filter(kept).map(Node::range);
        let errors = parse.errors.iter().flat_map(|error| {
            let related = error.related.iter().map(|related| related.start..related.end);
            std::iter::once(error.start..error.end).chain(related)
        });
        Protected::new(nodes.chain(errors).map(|range| whole_lines(file, &range)).collect())
    }

    /// These and all of the declarations in which they are.
    pub(super) fn with_declarations(&self, file: &SourceFile, parse: &Parse) -> Protected {
        let is_declaration = |node: &Node<'_>| {
            node.kind().is_routine()
                || matches!(node.kind(), NodeKind::DataDeclaration | NodeKind::RecordDeclaration)
        };
        let declarations = parse.tree.nodes().filter(is_declaration).map(Node::range);
        let broken = declarations.filter(|range| self.touches(range));
        let all = broken.map(|range| whole_lines(file, &range)).chain(self.ranges.iter().cloned());
        Protected::new(all.collect())
    }

    fn new(mut ranges: Vec<Range<u32>>) -> Protected {
        ranges.sort_by_key(|range| (range.start, range.end));
        let mut joined: Vec<Range<u32>> = Vec::new();
        for range in ranges {
            match joined.last_mut() {
                Some(last) if range.start <= last.end => last.end = last.end.max(range.end),
                _ => joined.push(range),
            }
        }
        Protected { ranges: joined }
    }

    /// Whether a range has bytes in common with these, or touches them.
    pub(super) fn touches(&self, range: &Range<u32>) -> bool {
        let next = self.ranges.partition_point(|kept| kept.end < range.start);
        self.ranges.get(next).is_some_and(|kept| kept.start <= range.end)
    }
}

/// The lines of a range, without the last line end.
fn whole_lines(file: &SourceFile, range: &Range<u32>) -> Range<u32> {
    let first = file.lines.range(file.position(range.start).line);
    let last = file.lines.range(file.position(range.end).line);
    let line = &file.bytes[last.start as usize..last.end as usize];
    let ends = line.iter().rev().take_while(|byte| matches!(byte, b'\n' | b'\r')).count();
    first.start..(last.end - ends as u32).max(range.end)
}
