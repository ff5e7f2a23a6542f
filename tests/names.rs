//! The index of names: what an identifier means, where a declaration is used, what is visible.

#![expect(clippy::unwrap_used, reason = "a missing identifier fails the test")]

mod marks;

use std::fmt::Write as _;

use joulepath::rapid::names::{DeclarationId, Kind, Meaning, Names, SourceText};
use joulepath::rapid::syntax::{self, Parse};
use joulepath::rapid::text::{FileId, SourceFile};
use marks::unmarked;

/// Identifiers that the tests ask for are marked: `<1>name`.
struct Program {
    files: Vec<SourceFile>,
    names: Names,
    /// File and byte of each mark.
    marks: Vec<(u32, FileId, u32)>,
}

fn program(texts: &[&str]) -> Program {
    let mut files = Vec::new();
    let mut marks = Vec::new();
    for (index, text) in texts.iter().enumerate() {
        let id = FileId(index as u32);
        let (plain, found) = unmarked(text);
        marks.extend(found.into_iter().map(|(number, byte)| (number, id, byte as u32)));
        files.push(SourceFile::new(id, format!("{index}.mod"), plain.into_bytes()));
    }
    let parses: Vec<Parse> = files.iter().map(|file| syntax::parse(&file.bytes)).collect();
    let sources: Vec<SourceText<'_>> =
        files.iter().zip(&parses).map(|(file, parse)| SourceText { file, parse }).collect();
    let names = Names::new(&sources);
    Program { files, names, marks }
}

impl Program {
    fn meaning(&self, number: u32) -> Meaning {
        let (_, file, byte) = self.marks.iter().find(|mark| mark.0 == number).unwrap();
        self.names.at(*file, *byte).unwrap_or_else(|| panic!("no name at mark {number}")).meaning
    }

    fn declared(&self, number: u32) -> DeclarationId {
        match self.meaning(number) {
            Meaning::Declared(id) => id,
            other => panic!("mark {number} is {other:?}"),
        }
    }

    fn assert_same(&self, numbers: &[u32]) {
        let ids: Vec<DeclarationId> = numbers.iter().map(|one| self.declared(*one)).collect();
        assert!(ids.iter().all(|id| *id == ids[0]), "{numbers:?} are {ids:?}");
    }

    fn text(&self, id: DeclarationId) -> String {
        let name = self.names.declaration(id).name;
        self.files[name.file.0 as usize].text(name).into_owned()
    }
}

const SCOPES: &str = "MODULE A
  RECORD part num <1>size; pos <2>place; ENDRECORD
  LOCAL VAR num <3>count := 0;
  VAR part <4>current{2};
  PROC main(\\num <5>count | switch <6>Fast)
    VAR num <7>inner;
    <8>COUNT := 1;
    FOR <9>inner FROM 1 TO <10>inner DO
      <11>inner_proc <12>inner, \\<13>level := <14>inner;
      <15>current{<16>inner}.<17>Place.<18>x := <19>current{1}.<20>size;
    ENDFOR
    <21>inner := 2;
    GOTO <22>end;
    <23>end:
    %<24>\"late\"%;
    <25>other <26>v100;
    <27>gone;
    IF Present(<28>Fast) <29>main \\<30>Fast?<31>Fast;
    <32>MoveL <33>p1, v100, fine, <34>tool0 \\<35>WObj := wobj0;
    <36>ArcL p1;
  ENDPROC
  PROC <37>inner_proc(num a \\num <38>level)
    <39>count := a;
    CONNECT intr WITH <40>tTrap;
  ENDPROC
  TRAP <41>tTrap
  ENDTRAP
ENDMODULE";

const OTHER: &str = "MODULE B
  VAR num <51>count := 1;
  LOCAL PROC <52>inner_proc() ENDPROC
  PROC <53>other(speeddata v)
    <54>count := <55>current{1}.<56>size + v.<57>v_tcp + v.<58>nothing;
    <59>inner_proc;
    <60>unknown_record.<61>field := 1;
  ENDPROC
ENDMODULE";

#[test]
fn names_are_resolved_by_scope() {
    let it = program(&[SCOPES, OTHER]);
    it.assert_same(&[5, 8]);
    it.assert_same(&[3, 39]);
    it.assert_same(&[51, 54]);
    it.assert_same(&[7, 10, 21]);
    it.assert_same(&[9, 12, 14, 16]);
    it.assert_same(&[37, 11]);
    it.assert_same(&[52, 59]);
    it.assert_same(&[38, 13]);
    it.assert_same(&[4, 15, 19, 55]);
    it.assert_same(&[2, 17]);
    it.assert_same(&[1, 20, 56]);
    it.assert_same(&[22, 23]);
    it.assert_same(&[53, 25]);
    it.assert_same(&[6, 28, 30, 31]);
    it.assert_same(&[41, 40]);
    assert_eq!(it.meaning(24), Meaning::Late);
    assert!(matches!(it.meaning(26), Meaning::Predefined(_)));
    assert_eq!(it.meaning(27), Meaning::Unknown);
    assert_eq!(it.meaning(33), Meaning::Unknown);
    assert_eq!(it.meaning(36), Meaning::Known);
    assert_eq!(it.meaning(58), Meaning::Unknown);
    assert_eq!(it.meaning(61), Meaning::Open);
    for number in [18, 32, 34, 35, 57] {
        assert!(it.names.is_predefined(it.declared(number)), "{number}");
    }
}

#[test]
fn references_are_in_all_files() {
    let it = program(&[SCOPES, OTHER]);
    let places: Vec<(u32, u32)> =
        it.names.references(it.declared(4)).map(|span| (span.file.0, span.start)).collect();
    let expected: Vec<(u32, u32)> = it
        .marks
        .iter()
        .filter(|(number, ..)| [4, 15, 19, 55].contains(number))
        .map(|(_, file, byte)| (file.0, *byte))
        .collect();
    assert_eq!(places, expected);
    assert_eq!(it.names.references(it.declared(23)).count(), 2);
}

#[test]
fn declarations_form_a_tree() {
    let it = program(&[SCOPES, OTHER]);
    let modules: Vec<DeclarationId> = it.names.modules().collect();
    let inside = |id| it.names.inside(id).map(|id| it.text(id)).collect::<Vec<_>>();
    assert_eq!(modules.iter().map(|id| it.text(*id)).collect::<Vec<_>>(), ["A", "B"]);
    assert_eq!(inside(modules[0]), ["part", "count", "current", "main", "inner_proc", "tTrap"]);
    assert_eq!(inside(it.declared(29)), ["count", "Fast", "inner", "inner", "end"]);
    assert_eq!(it.names.declaration(it.declared(9)).kind, Kind::Counter);
    let current = it.names.declaration(it.declared(4));
    assert_eq!(it.text(current.value.declaration.unwrap()), "part");
    assert_eq!(current.value.dimensions, 1);
}

#[test]
fn visible_names_leave_out_hidden_ones() {
    let it = program(&[SCOPES, OTHER]);
    let visible = |number: u32| {
        let (_, file, byte) = it.marks.iter().find(|mark| mark.0 == number).unwrap();
        it.names.visible(*file, *byte)
    };
    let inside = visible(16);
    for number in [5, 9, 37, 53] {
        assert!(inside.contains(&it.declared(number)), "{number}");
    }
    for number in [3, 51, 52] {
        assert!(!inside.contains(&it.declared(number)), "{number}");
    }
    // The counter is visible in its loop only.
    assert!(visible(21).contains(&it.declared(7)) && !visible(21).contains(&it.declared(9)));
    assert!(visible(54).contains(&it.declared(52)) && !visible(54).contains(&it.declared(3)));
}

#[test]
fn text_with_errors_keeps_its_names() {
    let it = program(&["MODULE A
  VAR num <1>a := ;
  PROC main(
    <2>a := := 1;
    IF <3>a = 1 THEN
      <4>rWork
  ENDPROC
  PROC <5>rWork()
    <6>a := <7>a + 1;
"]);
    it.assert_same(&[1, 6, 7]);
    it.assert_same(&[4, 5]);
}

#[test]
fn circles_of_types_end() {
    let it = program(&["MODULE A
  ALIAS b a; ALIAS a b;
  RECORD r r <1>inner; ENDRECORD
  VAR a x; VAR r <2>y;
  PROC main() x.<3>z := y.inner.<4>inner.inner; ENDPROC
ENDMODULE"]);
    assert_eq!(it.meaning(3), Meaning::Open);
    it.assert_same(&[1, 4]);
}

/// Far above the expected time of a build without optimisation; a quadratic algorithm takes longer.
#[test]
fn large_programs_are_indexed_in_linear_time() {
    let mut text = String::from("MODULE Large\n");
    for i in 0..12_000 {
        let _ = writeln!(
            text,
            "  LOCAL VAR num n{i} := {i};\n  PROC p{i}(num a)\n    n{i} := a + n{};\n    p{} n{i};\n  ENDPROC",
            i / 2,
            i / 3
        );
    }
    text += "ENDMODULE\n";
    let file = SourceFile::new(FileId(0), "Large.mod".into(), text.into_bytes());
    let parse = syntax::parse(&file.bytes);
    assert!(file.bytes.len() > 1_000_000);
    let start = std::time::Instant::now();
    let names = Names::new(&[SourceText { file: &file, parse: &parse }]);
    let seconds = start.elapsed().as_secs_f64();
    assert!(names.uses(FileId(0)).iter().all(|one| one.meaning != Meaning::Unknown));
    assert!(seconds < 1.0, "{seconds} s");
}
