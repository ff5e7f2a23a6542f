//! Reads a program: files, modules, entry.

use rayon::prelude::*;

use super::error::RetrofitError;
use super::files::{Source, file_and_line};
use crate::rapid::ir::lower;
use crate::rapid::ir::program::{Program, RoutineId};
use crate::rapid::syntax::{self, SyntaxError};
use crate::tool::emit;

/// Parses the files and finds the entry.
///
/// # Errors
/// No entry, several entries, or syntax errors in its module.
pub fn read_program(files: &[Source], entry: &str) -> Result<(Program, RoutineId), RetrofitError> {
    let parsed = files.par_iter().map(|source| {
        let parse = syntax::parse(&source.file.bytes);
        let modules = lower(source.file.id, &parse, &source.file.bytes);
        (parse.errors, modules)
    });
    let (errors, modules): (Vec<Vec<SyntaxError>>, Vec<_>) = parsed.unzip();
    let program = Program::new(modules.into_iter().flatten().collect());
    if let Some(clash) = program.clash(entry) {
        let [first, second] = [0, 1].map(|i| file_and_line(files, clash.spans[i]));
        return Err(RetrofitError::TwoEntries { entry: entry.to_owned(), first, second });
    }
    if let Some(missing) = emit::missing_streams(&program) {
        let file = &files[missing.span.file.0 as usize].file;
        return Err(RetrofitError::NoStreams {
            path: file.path.clone(),
            line: file.position(missing.span.start).line,
            function: missing.function,
            module: missing.module,
        });
    }
    // A syntax error may hide the entry, so it is reported first.
    let Some(id) = program.entry(entry) else {
        let broken = errors.iter().position(|list| !list.is_empty());
        let blank = |source: &Source| source.file.bytes.iter().all(u8::is_ascii_whitespace);
        return Err(match (broken, files) {
            (Some(i), _) => broken_entry(&files[i], &errors[i][0], entry),
            (None, [source]) if blank(source) => {
                RetrofitError::Empty { path: source.file.path.clone(), entry: entry.to_owned() }
            }
            (None, _) => RetrofitError::NoEntry { entry: entry.to_owned() },
        });
    };
    let file = program.modules[id.module].span.file.0 as usize;
    match errors[file].first() {
        Some(error) if !is_elsewhere(&program, id, error) => {
            Err(broken_entry(&files[file], error, entry))
        }
        _ => Ok((program, id)),
    }
}

/// Whether the error is inside another routine of the module, so that the entry is usable: at the first
/// word of a routine it belongs to what stands before.
fn is_elsewhere(program: &Program, entry: RoutineId, error: &SyntaxError) -> bool {
    program.modules[entry.module].routines.iter().enumerate().any(|(index, routine)| {
        index != entry.index && routine.span.start < error.start && error.end <= routine.span.end
    })
}

fn broken_entry(source: &Source, error: &SyntaxError, entry: &str) -> RetrofitError {
    let position = source.file.position(error.start);
    RetrofitError::BrokenEntry {
        path: source.file.path.clone(),
        line: position.line,
        column: position.column,
        message: error.message.clone(),
        entry: entry.to_owned(),
    }
}
