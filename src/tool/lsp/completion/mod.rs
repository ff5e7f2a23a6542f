//! Completion.
//!
//! `wanted` tells from the words before the cursor what may stand there, `offers` lists it, `item` makes
//! the entries, `keywords` has the reserved words.

mod item;
mod keywords;
mod offers;
mod wanted;

use gen_lsp_types::CompletionList;

use self::item::Entry;
pub(super) use self::item::Form;
use super::cursor::Cursor;
use super::scope::Scope;
use super::workspace::View;

/// Most entries in one answer.
const MOST: usize = 500;

/// What may stand at a byte.
pub(super) fn completion(view: View<'_>, byte: u32, form: Form) -> Option<CompletionList> {
    let cursor = Cursor::new(view.project.module(view.file), byte);
    if cursor.in_text {
        return None;
    }
    let scope = Scope::new(view, byte)?;
    let wanted = wanted::wanted(&cursor, &scope);
    let typed = cursor.typed();
    let mut entries = offers::offers(&scope, &cursor, &wanted);
    entries.retain(|entry| entry.label.to_lowercase().contains(&typed));
    entries.sort_by_cached_key(Entry::order);
    entries.dedup_by(|a, b| a.label.eq_ignore_ascii_case(&b.label));
    // The best ones stay where there are too many.
    entries.sort_by_key(|entry| entry.rank);
    let is_incomplete = entries.len() > MOST;
    entries.truncate(MOST);
    let items = entries.into_iter().map(|entry| entry.item(&scope, &cursor, form)).collect();
    Some(CompletionList { is_incomplete, items, ..CompletionList::default() })
}
