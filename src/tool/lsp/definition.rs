//! Where names are declared and used.

use gen_lsp_types::{DocumentHighlight, DocumentHighlightKind, Location};

use super::entity::{alike, declared, entity};
use super::workspace::View;
use super::writes::is_written;
use crate::rapid::names::Role;
use crate::rapid::text::Span;

/// The declarations of the identifier at a byte; none of a predefined one.
pub(super) fn definition(view: View<'_>, byte: u32) -> Vec<Location> {
    let own = declared(view, byte).into_iter().filter(|one| !one.names.is_predefined(one.id));
    own.map(|one| view.location(one.declaration().name)).collect()
}

/// The declaration of the type of the identifier at a byte.
pub(super) fn type_definition(view: View<'_>, byte: u32) -> Vec<Location> {
    let of_type = declared(view, byte).into_iter().filter_map(|one| {
        let id = one.declaration().value.declaration?;
        (!one.names.is_predefined(id)).then(|| one.names.declaration(id).name)
    });
    of_type.map(|span| view.location(span)).collect()
}

/// All places that name the same as the identifier at a byte.
pub(super) fn references(view: View<'_>, byte: u32, with: Declarations) -> Vec<Location> {
    let Some(entity) = entity(view, byte) else { return Vec::new() };
    let wanted = |role: Role| with == Declarations::Included || role != Role::Declaration;
    let places = entity.uses.into_iter().filter(|(_, role)| wanted(*role));
    places.map(|(span, _)| view.location(span)).collect()
}

/// Whether references include the declarations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Declarations {
    /// They do.
    Included,
    /// They do not.
    LeftOut,
}

/// The same places in the file itself; of a predefined name too.
pub(super) fn highlights(view: View<'_>, byte: u32) -> Vec<DocumentHighlight> {
    let file = view.file;
    let places: Vec<_> = match entity(view, byte) {
        Some(entity) => entity.uses.into_keys().filter(|span| span.file == file).collect(),
        None => alike(view, byte),
    };
    let parse = view.project.module(file).parse();
    let kind = |start: u32| {
        let written = is_written(&parse.tree, start);
        if written { DocumentHighlightKind::Write } else { DocumentHighlightKind::Read }
    };
    let highlight = |span: Span| DocumentHighlight {
        range: view.positions().range(span),
        kind: Some(kind(span.start)),
    };
    places.into_iter().map(highlight).collect()
}
