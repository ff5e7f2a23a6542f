//! Names for emitted modules that the program does not use.

use std::collections::BTreeSet;

use serde::Serialize;

use crate::rapid::ir::hir::{Block, ExprKind, Routine, StmtKind};
use crate::rapid::ir::program::Program;
use crate::rapid::syntax::{TokenKind, tokenize};
use crate::rapid::text::{SourceFile, Span};

/// Beginnings of the names of modules. That of a recorder must not begin like that of streams: the
/// streams of a program that is recorded would then get other names.
const STREAMS: &str = "Joulepath";
const RECORDER: &str = "JlpRecorder";

/// The names of a module of streams or of a recorder.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Names {
    /// Prefix of all names.
    pub prefix: String,
    /// The module name.
    pub module: String,
}

impl Names {
    /// A prefix that no word of the files begins with: data, routines, labels, loop variables, also
    /// signals and modules declared elsewhere. The module name differs from all file names.
    pub fn free(files: &[SourceFile]) -> Names {
        Names::first_free(files, "jp", STREAMS)
    }

    /// The same for a recorder.
    pub fn of_recorder(files: &[SourceFile]) -> Names {
        Names::first_free(files, "jr", RECORDER)
    }

    fn first_free(files: &[SourceFile], beginning: &str, module: &str) -> Names {
        let taken = used_words(files);
        let is_free = |beginning: &str| {
            let beginning = beginning.to_lowercase();
            let next = taken.range(beginning.clone()..).next();
            next.is_none_or(|word| !word.starts_with(&beginning))
        };
        let mut prefix = beginning.to_owned();
        let mut round = 1;
        while !is_free(&prefix) || !is_free(&numbered(module, round)) {
            round += 1;
            prefix = format!("{beginning}{round}_");
        }
        Names { module: numbered(module, round), prefix }
    }

    /// The name of the module with part `index` (from 0) of the streams.
    pub fn part(&self, index: usize) -> String {
        if index == 0 { self.module.clone() } else { format!("{}_{}", self.module, index + 1) }
    }
}

/// A guard that calls a function of a missing module of streams.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MissingStreams {
    /// The called function.
    pub function: String,
    /// Place of the call.
    pub span: Span,
    /// The file that should declare it.
    pub module: String,
}

/// The first guard whose function the program does not declare.
pub fn missing_streams(program: &Program) -> Option<MissingStreams> {
    program.modules.iter().enumerate().find_map(|(m, module)| {
        let mut blocks = module.routines.iter().flat_map(Routine::blocks);
        blocks.find_map(|block| guard(program, m, block))
    })
}

/// Whether the program contains a module of streams or of EGM positions.
pub fn has_streams(program: &Program) -> bool {
    program.modules.iter().any(|module| {
        let ours = module.name.key.starts_with(&module_name(1).to_lowercase());
        let is_at = |routine: &Routine| prefix_number(&routine.name.key).is_some();
        ours && (module.name.key.contains("egm") || module.routines.iter().any(is_at))
    })
}

/// The first predefined name that streams use and the program redeclares.
pub fn redeclared_name(program: &Program) -> Option<&'static str> {
    USED.into_iter().find(|name| program.resolve_global(&name.to_lowercase()).is_some())
}

/// Predefined RAPID names that streams use.
const USED: [&str; 24] = [
    "Abs",
    "C_MOTSET",
    "C_PROGDISP",
    "CalcRobT",
    "CJointT",
    "CSpeedOverride",
    "Distance",
    "ErrWrite",
    "fine",
    "GetSysInfo",
    "Incr",
    "MoveAbsJ",
    "StrLen",
    "StrMatch",
    "StrPart",
    "tool0",
    "TPErase",
    "TPWrite",
    "v1000",
    "ValToStr",
    "WaitTime",
    "z200",
    "load0",
    "motsetdata",
];

fn guard(program: &Program, module: usize, block: &Block) -> Option<MissingStreams> {
    block.iter().find_map(|stmt| {
        if let StmtKind::If { branches, .. } = &stmt.kind
            && let Some(ExprKind::Call(name, _)) = branches.first().map(|(c, _)| &c.kind)
            && let Some(round) = prefix_number(&name.key)
            && program.resolve(module, &name.key).is_none()
        {
            return Some(MissingStreams {
                function: name.text.clone(),
                span: name.span,
                module: format!("{}.mod", module_name(round)),
            });
        }
        stmt.kind.blocks().into_iter().find_map(|inner| guard(program, module, inner))
    })
}

/// The number in the prefix of a guard function's lower-case name; 1 without a number.
fn prefix_number(key: &str) -> Option<usize> {
    let (round, site) = key.strip_prefix("jp")?.split_once("fits")?;
    site.parse::<usize>().ok()?;
    match round {
        "" => Some(1),
        round => round.strip_suffix('_')?.parse().ok(),
    }
}

fn module_name(round: usize) -> String {
    numbered(STREAMS, round)
}

fn numbered(module: &str, round: usize) -> String {
    if round == 1 { module.to_owned() } else { format!("{module}{round}") }
}

/// All words and file names, in lower case.
fn used_words(files: &[SourceFile]) -> BTreeSet<String> {
    let mut taken = BTreeSet::new();
    for file in files {
        let name = file.path.rsplit(['/', '\\']).next().unwrap_or(&file.path);
        let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
        taken.insert(stem.to_lowercase());
        let tokens = tokenize(&file.bytes);
        for index in (0..tokens.count()).filter(|i| tokens.kind(*i) == TokenKind::Identifier) {
            let range = tokens.range(index);
            let word = &file.bytes[range.start as usize..range.end as usize];
            taken.insert(String::from_utf8_lossy(word).to_lowercase());
        }
    }
    taken
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rapid::text::FileId;

    fn names(path: &str, text: &str) -> Names {
        Names::free(&[SourceFile::new(FileId(0), path.into(), text.into())])
    }

    #[test]
    fn a_word_that_begins_as_ours_is_taken_whatever_it_stands_for() {
        let free = names("a/m.mod", "MODULE m\nPROC main()\nSetDO doA,1;\nENDPROC\nENDMODULE\n");
        assert_eq!((free.prefix.as_str(), free.part(0).as_str()), ("jp", "Joulepath"));
        assert_eq!(free.part(1), "Joulepath_2");
        let uses = [
            "VAR num JPx;",
            "PROC a()\nJPagain:\nGOTO JPagain;\nENDPROC",
            "PROC a()\nFOR jpI FROM 1 TO 2 DO\nENDFOR\nENDPROC",
            "PROC a()\nSetDO jpSignal,1;\nENDPROC",
            "PROC a(num jp)\nENDPROC",
            "PROC a()\n%\"x\"%;\njpElsewhere;\nENDPROC",
            "PROC a()\nLoad \"HOME:\" \\File:=\"x\"; Joulepath_3:rGo;\nENDPROC",
        ];
        for text in uses {
            let taken = names("m.mod", &format!("MODULE m\n{text}\nENDMODULE\n"));
            assert_eq!(taken.prefix, "jp2_", "{text}");
            assert_eq!(taken.part(1), "Joulepath2_2", "{text}");
        }
        // A word in a string or a comment does not count.
        let said = names("m.mod", "MODULE m\nCONST string s:=\"jpAt\"; ! jpAt\nENDMODULE\n");
        assert_eq!(said.prefix, "jp");
        assert_eq!(names("x/JOULEPATH.MOD", "MODULE m\nENDMODULE\n").module, "Joulepath2");
    }
}
