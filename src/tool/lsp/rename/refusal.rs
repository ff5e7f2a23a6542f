//! Why a name stays.

use crate::rapid::text::Span;
use crate::tool::lsp::workspace::View;

/// Why a name stays.
#[derive(Debug, thiserror::Error)]
pub(in crate::tool::lsp) enum Refusal {
    /// There is no name.
    #[error("there is no name here")]
    NoName,
    /// It is predefined.
    #[error("'{0}' belongs to RAPID or RobotWare and cannot be renamed")]
    BuiltIn(String),
    /// No file declares it.
    #[error("no file of the workspace declares '{0}': open the folder with its declaration")]
    NotDeclared(String),
    /// It starts the program.
    #[error("'{0}' starts the program: the controller looks for this name")]
    Entry(String),
    /// The new name is none.
    #[error("'{0}' is no name: use letters, digits and _, with a letter first")]
    NotAName(String),
    /// The new name is too long.
    #[error("'{name}' has {length} characters: a name of RAPID has at most 32")]
    TooLong {
        /// The new name.
        name: String,
        /// Its length.
        length: usize,
    },
    /// The new name is a keyword.
    #[error("'{0}' is a reserved word of RAPID: choose another name")]
    Keyword(String),
    /// The new name is predefined.
    #[error("'{0}' is a name of RAPID or RobotWare: choose another one")]
    Taken(String),
    /// The encoding of a file lacks a letter of the new name.
    #[error("{file} is {encoding}, which cannot hold '{name}': choose letters that it has")]
    Encoding {
        /// The file.
        file: String,
        /// Its encoding.
        encoding: &'static str,
        /// The new name.
        name: String,
    },
    /// Another declaration in the same scope has the new name.
    #[error("'{name}' is declared at {place}: choose another name")]
    Clash {
        /// The new name.
        name: String,
        /// Where it is declared.
        place: String,
    },
    /// Another declaration would be meant.
    #[error(
        "with the name '{name}', what stands at {place} would mean another declaration: choose another name"
    )]
    Captured {
        /// The new name.
        name: String,
        /// An identifier that would change its meaning.
        place: String,
    },
    /// Whether it is meant is not known.
    #[error("'{name}' at {place} may mean it, too, which is not known: {why}")]
    Doubtful {
        /// The old name.
        name: String,
        /// The place.
        place: String,
        /// Why it is not known.
        why: &'static str,
    },
}

/// A place for messages: file and line.
pub(super) fn place(view: View<'_>, span: Span) -> String {
    let file = &view.project.module(span.file).file;
    let name = file.path.rsplit('/').next().unwrap_or(&file.path);
    format!("{name}:{}", file.position(span.start).line)
}
