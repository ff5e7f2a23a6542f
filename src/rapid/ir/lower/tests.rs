//! Lowering of declarations and statements.

use super::*;
use crate::rapid::ir::hir::{Arg, ArgKind, ExprKind};
use crate::rapid::syntax;

fn modules(bytes: &[u8]) -> Vec<Module> {
    lower(FileId(3), &syntax::parse(bytes), bytes)
}

fn statements(text: &str) -> Vec<Stmt> {
    let text = format!("MODULE m PROC p()\n{text}\nENDPROC ENDMODULE");
    modules(text.as_bytes()).remove(0).routines.remove(0).body
}

/// An expression as text, fully parenthesised.
fn shown(expr: &Expr) -> String {
    let list = |parts: &[Expr]| parts.iter().map(shown).collect::<Vec<_>>().join(" ");
    match &expr.kind {
        ExprKind::Num(value) => format!("{value}"),
        ExprKind::Str(text) => format!("{text:?}"),
        ExprKind::Bool(value) => format!("{value}"),
        ExprKind::Ref(name) => name.key.clone(),
        ExprKind::Field(base, name) => format!("{}.{}", shown(base), name.key),
        ExprKind::Index(base, indices) => format!("{}{{{}}}", shown(base), list(indices)),
        ExprKind::Call(name, args) => {
            let args: Vec<String> = args.iter().map(shown_arg).collect();
            format!("{}({})", name.key, args.join(" "))
        }
        ExprKind::Aggregate(parts) => format!("[{}]", list(parts)),
        ExprKind::Unary(op, operand) => format!("({op:?} {})", shown(operand)),
        ExprKind::Binary(op, left, right) => {
            format!("({} {op:?} {})", shown(left), shown(right))
        }
        ExprKind::AnyPosition => "*".to_owned(),
        ExprKind::Placeholder => "<>".to_owned(),
        ExprKind::Broken => "broken".to_owned(),
    }
}

fn shown_arg(arg: &Arg) -> String {
    match &arg.kind {
        ArgKind::Positional(value) => shown(value),
        ArgKind::Named(name, value) => format!("{}={}", name.key, shown(value)),
        ArgKind::Optional(name, None) => format!("\\{}", name.key),
        ArgKind::Optional(name, Some(value)) => format!("\\{}={}", name.key, shown(value)),
        ArgKind::Conditional(name, parameter) => format!("\\{}?{}", name.key, shown(parameter)),
    }
}

fn value(text: &str) -> String {
    match &statements(&format!("x := {text};"))[0].kind {
        StmtKind::Assign { value, .. } => shown(value),
        other => format!("{other:?}"),
    }
}

#[test]
fn operators_bind_as_the_priority_table_says() {
    assert_eq!(value("1+2*3-4"), "((1 Add (2 Mul 3)) Sub 4)");
    assert_eq!(value("8/4/2 DIV 1"), "(((8 Div 4) Div 2) IntDiv 1)");
    assert_eq!(value("-a*b+c"), "((Minus (a Mul b)) Add c)");
    assert_eq!(value("a*-1"), "(a Mul (Minus 1))");
    assert_eq!(value("NOT a AND b"), "(Not (a And b))");
    assert_eq!(value("NOT a OR b"), "((Not a) Or b)");
    assert_eq!(value("a OR b AND c XOR d"), "((a Or (b And c)) Xor d)");
    assert_eq!(value("a AND NOT b AND c"), "((a And (Not b)) And c)");
    assert_eq!(value("a=b AND c<>d"), "((a Eq b) And (c Ne d))");
    assert_eq!(value("(a+b)*c"), "((a Add b) Mul c)");
}

#[test]
fn literals_have_their_values() {
    assert_eq!(value("[1., .5, 1E3, 2.5e-1, 9E+09]"), "[1 0.5 1000 0.25 9000000000]");
    assert_eq!(value("[0x1F, 0B101, 0o17]"), "[31 5 15]");
    assert_eq!(value("True"), "true");
    assert_eq!(value(r#""a""b\\c\41\0Ad\zz""#), "\"a\\\"b\\\\cA\\nd\\\\zz\"");
    assert_eq!(value("A.b{1, i}.C"), "a.b{1 i}.c");
    assert_eq!(value("f(1, \\On, \\v:=2, x:=3, *)"), "f(1 \\on \\v=2 x=3 *)");
}

#[test]
fn calls_keep_all_forms_of_arguments() {
    let body = statements("MoveJ \\Conc, *, v100 \\T:=2, Tool:=t \\WObj?w;\n%\"a\"% 1;\nHome(2);");
    let calls: Vec<(String, Vec<String>)> = body
        .iter()
        .map(|stmt| match &stmt.kind {
            StmtKind::Call(Call { callee, args }) => (
                match callee {
                    Callee::Name(name) => name.text.clone(),
                    Callee::Late(expr) => shown(expr),
                },
                args.iter().map(shown_arg).collect(),
            ),
            other => panic!("{other:?}"),
        })
        .collect();
    let call = |name: &str, args: &[&str]| {
        (name.to_owned(), args.iter().map(|&arg| arg.to_owned()).collect::<Vec<_>>())
    };
    assert_eq!(
        calls,
        [
            call("MoveJ", &["\\conc", "*", "v100", "\\t=2", "tool=t", "\\wobj?w"]),
            call("\"a\"", &["1"]),
            call("Home", &["2"]),
        ]
    );
}

#[test]
fn spans_are_those_of_the_original_bytes() {
    let bytes = b"\xEF\xBB\xBFMODULE m\r\n PROC p()\r\n  ! c\r\n  MoveJ a,\r\n   b; ! d\r\n ENDPROC\r\nENDMODULE";
    let module = modules(bytes).remove(0);
    let stmt = &module.routines[0].body[0];
    assert_eq!(stmt.span.file, FileId(3));
    assert_eq!(&bytes[stmt.span.start as usize..stmt.span.end as usize], b"MoveJ a,\r\n   b;");
    assert_eq!(module.span.start, 3);
}

#[test]
fn names_are_decoded_and_compared_without_case() {
    let module =
        modules(b"MODULE m\nCONST num A\xD1O := 1;\n! f\xFCr die Gr\xF6\xDFe\nENDMODULE").remove(0);
    assert_eq!(module.data[0].name.text, "AÑO");
    assert_eq!(module.data[0].name.key, "año");
}

#[test]
fn declarations_keep_everything() {
    let module = modules(
        b"MODULE m(sysmodule, NOSTEPIN)
        LOCAL RECORD r num a; string b; ENDRECORD
        ALIAS num level;
        TASK PERS num a{2, n};
        PROC p(VAR num a{*, *}, \\switch b | num c, PERS bool d)
          VAR num x := 1;
          VAR bool y;
          x := 2;
          VAR num z;
        BACKWARD p;
        ERROR (ERR_A, ERR_B) RETRY;
        ERROR TRYNEXT;
        UNDO RAISE 5;
        ENDPROC
        LOCAL FUNC num f() RETURN 1; ENDFUNC
        TRAP t ENDTRAP
        ENDMODULE",
    )
    .remove(0);
    assert_eq!(module.attributes, ["SYSMODULE", "NOSTEPIN"]);
    assert!(matches!(&module.types[0].kind, TypeDefKind::Record(parts) if parts.len() == 2));
    assert!(matches!(&module.types[1].kind, TypeDefKind::Alias(name) if name.key == "num"));
    let data = &module.data[0];
    assert_eq!((data.scope, data.kind, data.dims.len()), (Scope::Task, DataKind::Pers, 2));
    let [p, f, t] = &module.routines[..] else { panic!("three routines") };
    let params: Vec<_> = p
        .params
        .iter()
        .map(|param| (param.name.key.as_str(), param.mode, param.optional))
        .collect();
    assert_eq!(
        params,
        [
            ("a", ParamMode::Var, false),
            ("b", ParamMode::In, true),
            ("c", ParamMode::In, true),
            ("d", ParamMode::Pers, false),
        ]
    );
    assert_eq!(p.data.len(), 2);
    assert!(matches!(p.body[1].kind, StmtKind::Data(_)));
    assert_eq!(p.backward.as_ref().unwrap().len(), 1);
    assert_eq!(p.error.iter().map(|(numbers, _)| numbers.len()).collect::<Vec<_>>(), [2, 0]);
    assert!(matches!(p.undo.as_ref().unwrap()[0].kind, StmtKind::Raise(Some(_))));
    assert!(matches!(f.kind, RoutineKind::Func));
    assert_eq!((f.scope, t.scope), (Scope::Local, Scope::Global));
    assert!(matches!(t.kind, RoutineKind::Trap));
}

#[test]
fn statements_with_errors_are_broken_and_their_neighbours_are_not() {
    let body = statements(
        "a;
        MoveJ p1 v100, z10, t;
        x = 1;
        y := [1, 2;
        IF a := 1 THEN b; ENDIF
        IF a = 1 c d e;
        FOR i := 1 TO 2 DO f; ENDFOR
        WHILE (a DO g; ENDWHILE
        z;",
    );
    let kinds: Vec<bool> = body.iter().map(|stmt| matches!(stmt.kind, StmtKind::Broken)).collect();
    let StmtKind::If { branches, .. } = &body[4].kind else { panic!("{:?}", body[4]) };
    assert!(matches!(branches[0].0.kind, ExprKind::Broken));
    assert_eq!(branches[0].1.len(), 1);
    let StmtKind::If { branches, .. } = &body[5].kind else { panic!("{:?}", body[5]) };
    assert!(matches!(branches[0].1[0].kind, StmtKind::Broken));
    let StmtKind::While { condition, .. } = &body[7].kind else { panic!("{:?}", body[7]) };
    assert!(matches!(condition.kind, ExprKind::Broken));
    assert_eq!(kinds, [false, true, true, true, false, false, true, false, false]);
}

#[test]
fn control_flow_keeps_its_branches() {
    let body = statements(
        "IF a THEN b; ELSEIF c THEN d; e; ELSE f; ENDIF
        FOR i FROM 1 TO 9 STEP 2 DO g; ENDFOR
        TEST x CASE 1, 2: h; CASE 3: DEFAULT: k; l; ENDTEST
        lab: GOTO lab;
        CONNECT n WITH t;
        <SMT>",
    );
    let StmtKind::If { branches, otherwise } = &body[0].kind else { panic!() };
    assert_eq!(branches.iter().map(|(_, block)| block.len()).collect::<Vec<_>>(), [1, 2]);
    assert_eq!(otherwise.as_ref().unwrap().len(), 1);
    let StmtKind::For { var, from, to, step, body: inner } = &body[1].kind else { panic!() };
    assert_eq!((var.key.as_str(), shown(from), shown(to)), ("i", "1".into(), "9".into()));
    assert_eq!((shown(step.as_ref().unwrap()), inner.len()), ("2".into(), 1));
    let StmtKind::Test { cases, default, .. } = &body[2].kind else { panic!() };
    let sizes: Vec<_> = cases.iter().map(|(values, block)| (values.len(), block.len())).collect();
    assert_eq!((sizes, default.as_ref().unwrap().len()), (vec![(2, 1), (1, 0)], 2));
    assert!(matches!(&body[3].kind, StmtKind::Label(name) if name.key == "lab"));
    assert!(matches!(&body[4].kind, StmtKind::Goto(name) if name.key == "lab"));
    assert!(matches!(&body[5].kind, StmtKind::Connect { trap, .. } if trap.key == "t"));
    assert!(matches!(body[6].kind, StmtKind::Placeholder));
}

#[test]
fn declarations_without_a_module_form_one() {
    let modules = modules(b"CONST num a := 1;\nPROC main()\nENDPROC\n");
    assert_eq!(modules.len(), 1);
    assert_eq!(modules[0].name.text, "");
    assert_eq!((modules[0].data.len(), modules[0].routines.len()), (1, 1));
    assert!(super::lower(FileId(0), &syntax::parse(b"! nothing"), b"! nothing").is_empty());
}
