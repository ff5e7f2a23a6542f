//! The front end on damaged, hostile and large input: it loses no byte, never panics, and its work
//! is linear in the length of the input.

#![expect(clippy::unwrap_used, reason = "a missing fixture fails the test")]

mod support;

use joulepath::rapid::ir;
use joulepath::rapid::syntax::{self, MAX_DEPTH, Parse};
use joulepath::rapid::text::FileId;
use support::{Random, check_tree, check_work, fixtures, mutate, token_ranges};

/// Mutations of each fixture.
const MUTATIONS: usize = 60;

fn check(bytes: &[u8]) -> Parse {
    let parse = syntax::parse(bytes);
    check_tree(&parse, bytes);
    check_work(&parse);
    let _ = ir::lower(FileId(0), &parse, bytes);
    parse
}

#[test]
fn mutated_programs_are_read_without_loss() {
    let mut random = Random(7);
    let mut read = 0;
    for (_, source) in fixtures("ok").into_iter().chain(fixtures("err")) {
        let tokens = token_ranges(&source);
        for _ in 0..MUTATIONS {
            let mut bytes = source.clone();
            for _ in 0..=random.below(3) {
                mutate(&mut bytes, &tokens, &mut random);
            }
            check(&bytes);
            read += 1;
        }
    }
    assert!(read > 5_000, "{read} mutations");
}

#[test]
fn random_bytes_are_read_without_loss() {
    let mut random = Random(11);
    for length in (0..400).chain([5_000, 20_000]) {
        let bytes: Vec<u8> = (0..length).map(|_| random.below(256) as u8).collect();
        check(&bytes);
    }
}

#[test]
fn every_truncation_is_read_without_loss() {
    let (_, bytes) = fixtures("ok").into_iter().find(|(n, _)| n == "control_flow.mod").unwrap();
    for length in 0..bytes.len() {
        let parse = check(&bytes[..length]);
        // A truncated word may be an additional error.
        let inside = length > 0 && !bytes[length - 1].is_ascii_whitespace();
        let most = if inside { 2 } else { 1 };
        assert!(parse.errors.len() <= most, "cut at {length}: {:?}", parse.errors);
    }
}

/// A program around some statements.
fn program(statements: &str) -> Vec<u8> {
    format!("MODULE a\nPROC main()\n{statements}\nKeep;\nENDPROC\nENDMODULE\n").into_bytes()
}

#[test]
fn too_deep_nesting_causes_one_error() {
    let many = 100_000;
    let nested = [
        format!("x := {}1{};", "(".repeat(many), ")".repeat(many)),
        format!("x := {}1;", "(".repeat(many)),
        format!("x := {}1{};", "[".repeat(many), "]".repeat(many)),
        format!("x := {}1{};", "f(".repeat(many), ")".repeat(many)),
        format!("x := {}1{};", "a{".repeat(many), "}".repeat(many)),
        format!("x := {}1;", "-".repeat(many)),
        format!("x := {}1;", "NOT ".repeat(many)),
        format!("x := 1{};", " + 1".repeat(many)),
        format!("x := 1{};", " + f(1)".repeat(many)),
        format!("x := a{};", ".b".repeat(many)),
        format!("x := a{};", "{1}".repeat(many)),
        format!("{}y;{}", "IF a THEN ".repeat(many), " ENDIF".repeat(many)),
        format!("{}y;{}", "IF a THEN\n".repeat(many), "\nENDIF".repeat(many)),
        format!("{}y;", "IF a ".repeat(many)),
        format!("{}y;{}", "WHILE a DO ".repeat(many), " ENDWHILE".repeat(many)),
        format!("{}{}", "TEST a CASE 1: ".repeat(many), " ENDTEST".repeat(many)),
        format!("{}{}", "FOR i FROM 1 TO 2 DO ".repeat(many), " ENDFOR".repeat(many)),
    ];
    for statements in &nested {
        let start = &statements[..30];
        let parse = check(&program(statements));
        assert_eq!(parse.errors.len(), 1, "{start}: {:?}", parse.errors.get(..3));
        // The parser reads the following statements.
        let kept = parse.tree.nodes().any(|node| {
            node.callee().is_some_and(|name| name.text(&program(statements)) == b"Keep")
        });
        assert!(kept, "{start}");
    }
    // Unclosed blocks contain the rest of the text; they must not overflow the stack.
    for opener in
        ["IF a THEN ", "ELSE ", "WHILE a DO\n", "CASE 1: ", "TEST x CASE 1: ", "PROC a() "]
    {
        check(&program(&opener.repeat(many)));
        check(opener.repeat(many).as_bytes());
    }
    for opener in ["MODULE a\n", "%%%\n", "ENDMODULE ", "MODULE ", "RECORD a\n", "TRAP "] {
        check(opener.repeat(many).as_bytes());
    }
}

#[test]
fn nesting_up_to_the_limit_is_read() {
    let levels = MAX_DEPTH as usize - 1;
    let statements = format!("x := {}1{};", "(".repeat(levels), ")".repeat(levels));
    assert_eq!(check(&program(&statements)).errors, []);
    let statements = format!("x := {}1{};", "(".repeat(levels + 1), ")".repeat(levels + 1));
    assert_eq!(check(&program(&statements)).errors.len(), 1);
}

/// The number of steps per token must not grow with the length of inputs that require look-ahead.
#[test]
fn the_work_of_the_parser_is_linear() {
    let pieces = [
        "x := 1;\n",
        "IF a ",
        "IF a THEN ",
        "Proc(",
        "Proc(a ",
        "Proc(a, ",
        "a ",
        "a\n",
        "(",
        ")",
        "[",
        ";",
        "%",
        "%%%\n",
        "\"",
        "\"\n",
        "! c\n",
        "ELSE\n",
        "ELSEIF ",
        "ENDIF\n",
        "CASE ",
        "TEST ",
        "END IF\n",
        "ENIDF\n",
        "ERROR (",
        "VAR num ",
        "CONST ",
        "LOCAL ",
        "TASK\n",
        "MODULE ",
        "MODULE a\n",
        "ENDMODULE\n",
        "PROC ",
        "PROC a(",
        "RECORD a ",
        "\\",
        "\\a?",
        ", \\",
        ":= ",
        "NOT ",
        "a.b",
        "a{1}",
        "- ",
        "* ",
        "<SMT> ",
        "<",
        "@",
        "\u{3000}",
        "é",
        "ENDPROC ",
        "FOR ",
        "FOR i FROM ",
        "CONNECT a ",
        "a: ",
        "GOTO ",
        "0x",
        "1.",
        "RETURN\n",
        "UNDO\n",
        "module text\n",
        "text\n",
        "a b THEN ",
        "a b DO\n",
        "Proc(a\n",
        "Proc((a)\n",
        "x y; z\n",
        "PROC a(\nnum ",
        "LOCAL a (",
        "LOCAL LOCAL ",
        "num a := [\n",
        "IF a\nb;\nENDIF\n",
        "IF ! THEN\n",
        "IF a != 1 THEN\n",
        "WHILE ! DO\n",
        "END\n",
        "CASE CASE\n",
        "TEST a\n1:\n",
    ];
    for piece in pieces {
        for around in ["", "MODULE a\n", "MODULE a PROC b() ", "MODULE a PROC b()\nx := "] {
            let text = format!("{around}{}", piece.repeat(20_000));
            check(text.as_bytes());
        }
    }
}

#[test]
fn long_lines_and_large_files_are_read() {
    let list = format!("x := [{}1];", "1, ".repeat(3_400_000));
    assert_eq!(check(&program(&list)).errors, []);
    let string = format!("x := \"{}\";", "a".repeat(10_000_000));
    assert_eq!(check(&program(&string)).errors, []);
    let text = "MoveL p10, v100, z10, tool0 \\WObj:=wobj0;\n".repeat(1_200_000);
    let bytes = program(&text);
    assert!(bytes.len() > 50_000_000, "{}", bytes.len());
    let parse = syntax::parse(&bytes);
    check_work(&parse);
    assert_eq!(parse.errors, []);
    assert_eq!(parse.tree.root().range().end as usize, bytes.len());
}
