//! The formatter: what it changes, and what it leaves as it is.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod layouts;

use std::path::PathBuf;

use joulepath::rapid::format::{Indent, KeywordCase, Style, format, format_range};
use joulepath::rapid::syntax::{self, NodeKind, TokenKind};
use joulepath::rapid::text::{SourceFile, apply};
use layouts::{Continued, Random, file, ir, modules, read, relaid, words};
use proptest::prelude::*;

fn formatted(file: &SourceFile, style: &Style) -> Vec<u8> {
    apply(&file.bytes, &format(file, style)).unwrap()
}

fn text(before: &str) -> String {
    String::from_utf8(formatted(&file(before), &Style::default())).unwrap()
}

fn styles() -> [Style; 4] {
    let default = Style::default();
    [
        default,
        Style { indent: Indent::Tab, blank_lines: 0, ..default },
        Style { indent: Indent::Spaces(4), keywords: KeywordCase::Keep, ..default },
        Style { indent: Indent::Spaces(1), blank_lines: 3, ..default },
    ]
}

/// Same program, same words, and formatted again it stays.
fn check(name: &str, source: &SourceFile, style: &Style) {
    let once = formatted(source, style);
    assert_eq!(ir(&source.bytes), ir(&once), "{name}");
    let (before, after) = (words(&source.bytes), words(&once));
    assert_eq!(before.len(), after.len(), "{name}");
    for ((kind, old), (_, new)) in before.iter().zip(&after) {
        assert!(old == new || kind.is_keyword() && old.eq_ignore_ascii_case(new), "{name}");
    }
    let again = file(once.clone());
    let twice = formatted(&again, style);
    let shown = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    assert_eq!(shown(&once), shown(&twice), "{name}: {style:?}");
}

fn all() -> Vec<PathBuf> {
    modules(".")
}

#[test]
fn every_fixture_stays_the_same_program_and_is_formatted_at_once() {
    let paths = all();
    assert!(paths.len() > 400, "{}", paths.len());
    let mut changed = 0;
    for path in paths {
        let source = read(&path);
        for style in styles() {
            check(&path.display().to_string(), &source, &style);
        }
        changed += usize::from(!format(&source, &Style::default()).is_empty());
    }
    assert!(changed > 200, "{changed} files change");
}

#[test]
fn layout_and_keywords_are_those_of_a_controller() {
    let before = "%%%\n  VERSION:1\n  LANGUAGE:ENGLISH\n%%%\n\n\n\nmodule  Cell ( sysmodule )\n\
        var num a{2,3} := [ [1, 2,3] , [4,5,6]];\n\
        Local proc  rPick ( num x , \\ switch y )\n  var num i;\n\
        if ( a{1,1} = 1 and  not b ) then MoveJ   p10 , v1000\\V := 50, z50 , tool0 \\WObj:=w;\n\
        elseif di1<>0 then\n!inner\nelse  ; ConfL \\Off; endif\n\
        for i from 1 to -n step 2*k do x := x + 1 ; endfor\n\
        test  reg1\n! first\ncase 1 , 2 : rPick ( 1 );\ndefault : endtest\n\
        if a = b and c stop ;\n lbl : goto lbl ;\n %\"r\" + n% x, y ;\n\
        return ;\nerror ( ERR_A )\nretry;\nendproc\nendmodule";
    let after = "%%%\n  VERSION:1\n  LANGUAGE:ENGLISH\n%%%\n\n\n\nMODULE Cell(sysmodule)\n  \
        VAR num a{2,3}:=[[1,2,3],[4,5,6]];\n  \
        LOCAL PROC rPick(num x,\\switch y)\n    VAR num i;\n    \
        IF (a{1,1}=1 AND NOT b) THEN\n      MoveJ p10,v1000\\V:=50,z50,tool0\\WObj:=w;\n    \
        ELSEIF di1<>0 THEN\n    !inner\n    ELSE;\n      ConfL\\Off;\n    ENDIF\n    \
        FOR i FROM 1 TO -n STEP 2*k DO\n      x:=x+1;\n    ENDFOR\n    \
        TEST reg1\n    ! first\n    CASE 1,2:\n      rPick (1);\n    DEFAULT:\n    ENDTEST\n    \
        IF a=b AND c stop;\n    lbl:\n    GOTO lbl;\n    %\"r\"+n% x,y;\n    \
        RETURN;\n  ERROR (ERR_A)\n    RETRY;\n  ENDPROC\nENDMODULE";
    assert_eq!(text(before), after);
}

#[test]
fn statements_keep_their_line_breaks_and_comments() {
    let before = "MODULE m\nPROC p()\nMoveL Offs(p10,\n0 , 0, 50), ! high\n  v100 ,\n\n   z10, tool0 ;\n\
        x:=1;   ! one\nlonger := 2; ! two\ny:=3;!three\n\n\n\n\n! alone\nENDPROC\n\n! of the module\nENDMODULE\n\n\n";
    let after = "MODULE m\n  PROC p()\n    MoveL Offs(p10,\n      0,0,50), ! high\n      v100,\n      z10,tool0;\n    \
        x:=1; ! one\n    longer:=2; ! two\n    y:=3; !three\n\n    ! alone\n  ENDPROC\n\n  ! of the module\nENDMODULE\n";
    assert_eq!(text(before), after);
}

#[test]
fn aligned_comments_stay_aligned() {
    let before = "MODULE m\nPROC p()\nx := 1;      ! one\nlonger := 2; ! two\nEXIT;  ! other\nENDPROC\nENDMODULE\n";
    let after = "MODULE m\n  PROC p()\n    x:=1;      ! one\n    longer:=2; ! two\n    EXIT; ! other\n  ENDPROC\nENDMODULE\n";
    assert_eq!(text(before), after);
}

#[test]
fn comments_before_a_branch_belong_to_the_side_to_which_they_are_indented() {
    let before = "MODULE m\nPROC p()\nIF a THEN\n  x;\n  ! inner\n! outer\nELSE\ny;\n    ! deep\nENDIF\nENDPROC\nENDMODULE\n";
    let after = "MODULE m\n  PROC p()\n    IF a THEN\n      x;\n      ! inner\n    ! outer\n    ELSE\n      y;\n      ! deep\n    ENDIF\n  ENDPROC\nENDMODULE\n";
    assert_eq!(text(before), after);
}

#[test]
fn lines_with_syntax_errors_stay() {
    let before = "MODULE m\nPROC p()\n   x := ;  y:=1 ;\nz := 2 ;\nENDPROC\nPROC q()\nw := 3;\nENDPROC\nENDMODULE\n";
    let after = "MODULE m\n  PROC p()\n   x := ;  y:=1 ;\n    z:=2;\n  ENDPROC\n  PROC q()\n    w:=3;\n  ENDPROC\nENDMODULE\n";
    assert!(!syntax::parse(before.as_bytes()).errors.is_empty());
    assert_eq!(text(before), after);
}

#[test]
fn encodings_and_line_ends_stay() {
    // Latin-1, with CRLF and an odd CR.
    let before = b"MODULE m\r\nPROC p()\r\n! f\xFCr \xC4nderung\r\nTPWrite  \"\xE4  \xF6\";\rx:=1;y:=2;\r\nENDPROC\r\nENDMODULE\r\n";
    let after = b"MODULE m\r\n  PROC p()\r\n    ! f\xFCr \xC4nderung\r\n    TPWrite \"\xE4  \xF6\";\r    x:=1;\r\n    y:=2;\r\n  ENDPROC\r\nENDMODULE\r\n";
    assert_eq!(formatted(&file(before.to_vec()), &Style::default()), after);
    // A byte order mark, and UTF-16 without loss.
    let text = "MODULE m\r\nproc p()\r\n! Größe 🙂\r\nENDPROC\r\nENDMODULE\r\n";
    let marked = file([b"\xEF\xBB\xBF", text.as_bytes()].concat());
    assert!(formatted(&marked, &Style::default()).starts_with(b"\xEF\xBB\xBFMODULE m\r\n  PROC"));
    let units: Vec<u8> =
        std::iter::once(0xFEFF).chain(text.encode_utf16()).flat_map(u16::to_le_bytes).collect();
    let wide = file(units);
    let stored = wide.stored(&formatted(&wide, &Style::default())).into_owned();
    let again = file(stored);
    assert_eq!(again.encoding(), "UTF-16LE");
    let expected = "MODULE m\r\n  PROC p()\r\n    ! Größe 🙂\r\n  ENDPROC\r\nENDMODULE\r\n";
    assert_eq!(again.bytes, expected.as_bytes());
    // A module in ABB's binary encoding.
    assert!(format(&file(b"\xFC\x01 \x02".to_vec()), &Style::default()).is_empty());
}

#[test]
fn what_would_become_another_token_keeps_its_blank() {
    let before = "MODULE m\nPROC p()\nb := x < ID > y;\ns := \"a\" + \"b\";\nz := 1 .. 2;\nENDPROC\nENDMODULE\n";
    let source = file(before);
    check("glue", &source, &Style::default());
    let text = "MODULE m\nPROC p()\nb := x < ID;\nENDPROC\nENDMODULE\n";
    assert!(self::text(text).contains("b:=x< ID;"));
}

#[test]
fn a_range_formats_whole_statements_and_nothing_else() {
    let before =
        "MODULE m\nproc p()\n\n\n\n   x := 1 ;  y:=2 ;   ! two\nz :=   3;\nENDPROC\nENDMODULE\n";
    let at = |text: &str| before.find(text).unwrap() as u32;
    let part = |range: std::ops::Range<u32>| {
        let source = file(before);
        let edits = format_range(&source, range, &Style::default());
        String::from_utf8(apply(&source.bytes, &edits).unwrap()).unwrap()
    };
    // One letter of the second statement.
    let y = at("y:=");
    assert_eq!(part(y..y + 1), before.replace("  y:=2 ;   ! two", "\n    y:=2; ! two"));
    // An empty range in the first one.
    let x = at("x :=") + 1;
    assert_eq!(part(x..x), before.replace("   x := 1 ;", "    x:=1;"));
    assert_eq!(part(at("z :=")..at("z :=") + 2), before.replace("z :=   3;", "    z:=3;"));
    // Both together: the blank lines before them stay.
    let both = before.replace("   x := 1 ;  y:=2 ;   ! two", "    x:=1;\n    y:=2; ! two");
    assert_eq!(part(x..y + 1), both);
}

#[test]
fn every_range_of_every_fixture_is_safe() {
    let mut random = Random::new(7);
    for path in modules("hard").into_iter().chain(modules("syntax")).step_by(3) {
        let source = read(&path);
        let length = source.bytes.len();
        for _ in 0..4 {
            let (a, b) = (random.below(length + 1) as u32, random.below(length + 1) as u32);
            let range = a.min(b)..a.max(b);
            let edits = format_range(&source, range.clone(), &Style::default());
            let bytes = apply(&source.bytes, &edits).unwrap();
            assert_eq!(ir(&source.bytes), ir(&bytes), "{}", path.display());
            // Formatting a range is a part of formatting all: what it changes, that changes, too.
            let whole = format(&source, &Style::default());
            for edit in &edits {
                let is_part = whole.iter().any(|other| {
                    other.span.start <= edit.span.start && edit.span.end <= other.span.end
                });
                assert!(is_part, "{}: {edit:?}", path.display());
            }
        }
    }
}

proptest! {
    #[test]
    fn random_layouts_become_the_same_text(seed: u64) {
        let mut random = Random::new(seed);
        let paths = all();
        let source = read(random.pick::<PathBuf>(&paths));
        prop_assume!(source.bytes.len() < 60_000);
        let other = file(relaid(&source.bytes, Continued::Anyhow, &mut random));
        let style = random.pick(&styles()).to_owned();
        check("relaid", &other, &style);
        // Where all text is read, the end of each procedure begins a line.
        let parse = syntax::parse(&other.bytes);
        let is_read = parse.tree.nodes().all(|node| node.kind() != NodeKind::OutsideText);
        if parse.errors.is_empty() && is_read {
            let bytes = formatted(&other, &style);
            let parse = syntax::parse(&bytes);
            let tokens = parse.tree.tokens();
            let ends = (0..tokens.count()).filter(|i| tokens.kind(*i) == TokenKind::EndProc);
            for end in ends {
                let start = tokens.range(end).start as usize;
                let line = bytes[..start].iter().rposition(|b| matches!(b, b'\n' | b'\r'));
                let indent = &bytes[line.map_or(0, |at| at + 1)..start];
                prop_assert!(indent.iter().all(|b| matches!(b, b' ' | b'\t')), "{:?}", indent);
            }
        }
    }
}
