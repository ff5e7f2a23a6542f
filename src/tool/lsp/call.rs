//! The call around the cursor, from the words before it.

use super::cursor::Cursor;
use crate::rapid::syntax::TokenKind;

/// An unfinished call.
pub(super) struct Call {
    /// The word that names the routine.
    pub(super) callee: usize,
    pub(super) argument: Argument,
    /// Whether the value of the argument has no word yet.
    pub(super) is_fresh: bool,
    /// The names of the options before the cursor.
    pub(super) given: Vec<usize>,
}

/// The argument at the cursor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Argument {
    /// The number of a required one, from 0.
    Position(usize),
    /// `name := …` or `\name …`, by the word of the name.
    Named(usize),
    /// `\` without a name.
    Unnamed,
}

/// Brackets around the cursor, or the statement itself.
struct Frame {
    callee: Option<usize>,
    /// Whether a routine around it can be meant: not in a list or an index.
    is_list: bool,
    positions: usize,
    segment: Vec<usize>,
    given: Vec<usize>,
}

impl Frame {
    fn new(callee: Option<usize>, is_list: bool) -> Frame {
        Frame { callee, is_list, positions: 0, segment: Vec::new(), given: Vec::new() }
    }
}

/// The frames around the cursor, from the statement to the innermost.
fn frames(cursor: &Cursor<'_>) -> Vec<Frame> {
    let words = &cursor.words;
    let kind = |index: usize| words.get(index).map(|word| cursor.kind(*word));
    let target = [TokenKind::Assign, TokenKind::Dot, TokenKind::LeftBrace, TokenKind::Colon];
    let calls = kind(0) == Some(TokenKind::Identifier)
        && kind(1).is_none_or(|next| !target.contains(&next));
    let first = calls.then(|| words[0]);
    let mut frames = vec![Frame::new(first, false)];
    let mut last: Option<usize> = None;
    for word in words.iter().copied().skip(usize::from(calls)) {
        let is_statement = frames.len() == 1;
        let Some(frame) = frames.last_mut() else { break };
        match cursor.kind(word) {
            TokenKind::LeftParen => {
                let named = last.filter(|last| cursor.kind(*last) == TokenKind::Identifier);
                let own = frame.callee.filter(|_| frame.segment.is_empty() && is_statement);
                frames.push(Frame::new(named.or(own), false));
            }
            TokenKind::LeftBracket | TokenKind::LeftBrace => frames.push(Frame::new(None, true)),
            TokenKind::RightParen | TokenKind::RightBracket | TokenKind::RightBrace => {
                if frames.len() > 1 {
                    frames.pop();
                }
                if let Some(frame) = frames.last_mut() {
                    frame.segment.push(word);
                }
            }
            TokenKind::Comma => {
                let begins = frame.segment.first().map(|first| cursor.kind(*first));
                frame.positions += usize::from(begins != Some(TokenKind::Backslash));
                frame.segment.clear();
            }
            _ => {
                if frame
                    .segment
                    .last()
                    .is_some_and(|last| cursor.kind(*last) == TokenKind::Backslash)
                {
                    frame.given.push(word);
                }
                frame.segment.push(word);
            }
        }
        last = Some(word);
    }
    frames
}

/// The innermost call around the cursor. A list in between hides its type, not the call.
pub(super) fn call(cursor: &Cursor<'_>) -> Option<Call> {
    let frames = frames(cursor);
    let at = frames.iter().rposition(|frame| frame.callee.is_some())?;
    let is_inner = at + 1 < frames.len();
    let frame = &frames[at];
    let (argument, is_fresh) = argument(cursor, frame);
    let is_fresh = is_fresh && !is_inner;
    Some(Call { callee: frame.callee?, argument, is_fresh, given: frame.given.clone() })
}

/// Whether the cursor is in a list or between the braces of an index.
pub(super) fn is_in_list(cursor: &Cursor<'_>) -> bool {
    frames(cursor).last().is_some_and(|frame| frame.is_list)
}

fn argument(cursor: &Cursor<'_>, frame: &Frame) -> (Argument, bool) {
    let segment = &frame.segment;
    let kind = |index: usize| segment.get(index).map(|word| cursor.kind(*word));
    let last = segment.iter().rposition(|word| cursor.kind(*word) == TokenKind::Backslash);
    if let Some(at) = last {
        let has_value = kind(at + 2) == Some(TokenKind::Assign);
        return match segment.get(at + 1) {
            None => (Argument::Unnamed, true),
            Some(name) => (Argument::Named(*name), has_value && at + 3 == segment.len()),
        };
    }
    if kind(1) == Some(TokenKind::Assign) {
        return (Argument::Named(segment[0]), segment.len() == 2);
    }
    (Argument::Position(frame.positions), segment.is_empty())
}
