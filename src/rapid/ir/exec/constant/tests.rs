//! Expressions and their values.

use super::*;
use crate::rapid::ir::lower;
use crate::rapid::syntax;
use crate::rapid::text::FileId;

const MODULE: &str = r#"
MODULE Values
    RECORD station
        robtarget place;
        num count;
        bool used;
    ENDRECORD
    LOCAL RECORD pair
        station first;
        station second;
    ENDRECORD
    ALIAS num level;

    CONST num nTwo:=2;
    CONST level nLevel:=nTwo*3;
    VAR num nNever:=7;
    VAR num nCount:=1;
    PERS num nStored:=4;
    PERS num nEmpty;
    CONST dnum dnBig:=4294967296;
    CONST num nGrid{2,3}:=[[1,2,3],[4,5,6]];
    CONST pos pX:=[1,0,0];
    CONST pos pY:=[0,1,0];
    CONST orient oZ90:=[0.707106781,0,0,0.707106781];
    CONST pose peShift:=[[10,20,30],[1,0,0,0]];
    CONST pose peTurn:=[[10,0,0],[0.707106781,0,0,0.707106781]];
    CONST robtarget p10:=[[100,200,300],[1,0,0,0],[0,-1,2,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
    CONST robtarget p20:=Offs(p10,0,0,50);
    CONST robtarget p30:=[[200,200,300],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
    CONST robtarget p40:=[[150,300,300],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
    CONST jointtarget jHome:=[[0,-12,14,0,90,0],[0,0,0,0,0,0]];
    VAR station sEmpty;
    CONST station sFull:=[p10,3,TRUE];
    CONST station sAll{2}:=[sFull,[p20,nTwo,FALSE]];
    CONST pair paBoth:=[sFull,sFull];
    PERS tooldata tGrip:=[TRUE,[[0,0,120],[1,0,0,0]],[2.5,[0,0,60],[1,0,0,0],0,0,0]];
    CONST num nCircle:=nCircle+1;
    LOCAL CONST string stName:="Robotics";

    PROC main()
        nCount:=nCount+1;
    ENDPROC

    FUNC num Twice(num x)
        IF x<0 RETURN 0;
        RETURN 2*x;
    ENDFUNC
ENDMODULE
MODULE Other
    LOCAL CONST num nTwo:=22;
    CONST num nOther:=nTwo;
ENDMODULE
"#;

/// The value of an expression in the first module, and the program.
fn evaluated(text: &str) -> Value {
    let source = format!("{MODULE}\nMODULE Extra\nCONST num nAsked:={text};\nENDMODULE");
    let parse = syntax::parse(source.as_bytes());
    assert!(parse.errors.is_empty(), "{text}: {:?}", parse.errors);
    let program = Program::new(lower(FileId(0), &parse, source.as_bytes()));
    let asked = program.modules[2].data[0].init.clone().expect("a value");
    evaluate(&program, 0, &asked)
}

/// A value as text: numbers with 4 decimals at most.
fn shown(datum: &Datum) -> String {
    match datum {
        Datum::Num(x) => format!("{}", (x * 1e4).round() / 1e4 + 0.0),
        Datum::Bool(b) => format!("{b}"),
        Datum::Text(text) => format!("{text:?}"),
        Datum::List(items) => {
            let items: Vec<String> = items.iter().map(shown).collect();
            format!("[{}]", items.join(" "))
        }
        Datum::Signal(name) => format!("signal {name}"),
        Datum::Unknown(unknown) => format!("? {}", unknown.reason),
    }
}

const P10: &str =
    "[1 0 0 0] [0 -1 2 0] [9000000000 9000000000 9000000000 9000000000 9000000000 9000000000]]";

#[test]
fn expressions_have_their_values() {
    let target = |place: &str| format!("[{place} {P10}");
    let table: Vec<(&str, String)> = [
        // num, dnum
        ("1+2*3-4/8", "6.5"),
        ("-nTwo*3", "-6"),
        ("nLevel", "6"),
        ("14 DIV 4", "3"),
        ("-14 DIV 4", "-3"),
        ("14 MOD 4", "2"),
        ("2*-1", "-2"),
        ("0x1F+0b11", "34"),
        ("dnBig*2", "8589934592"),
        ("NumToDnum(3)", "3"),
        ("DnumToNum(dnBig)", "4294967296"),
        ("Abs(-3.5)", "3.5"),
        ("Pow(2,10)", "1024"),
        ("Sqrt(2)", "1.4142"),
        ("Exp(1)", "2.7183"),
        ("Sin(30)", "0.5"),
        ("Cos(60)", "0.5"),
        ("Tan(45)", "1"),
        ("ASin(0.5)", "30"),
        ("ACos(0.5)", "60"),
        ("ATan(1)", "45"),
        ("ATan2(1,-1)", "135"),
        ("Round(2.456\\Dec:=1)", "2.5"),
        ("Round(-2.5)", "-3"),
        ("Trunc(2.789\\Dec:=2)", "2.78"),
        ("Trunc(-2.7)", "-2"),
        ("pi", "3.1416"),
        ("Twice(nTwo)+Twice(-1)", "4"),
        // bool
        ("NOT TRUE OR 1<2", "true"),
        ("TRUE XOR TRUE", "false"),
        ("nTwo=2 AND nTwo<>3 AND nTwo>=2", "true"),
        ("FALSE AND nEmpty=1", "false"),
        // arrays and records
        ("nGrid{2,3}", "6"),
        ("Dim(nGrid,1)*10+Dim(nGrid,2)", "23"),
        ("nGrid{3,1}", "? index 3 is outside 1..2"),
        ("sFull.count", "3"),
        ("sFull.place.trans.z", "300"),
        ("sAll{2}.place.trans", "[100 200 350]"),
        ("paBoth.second.used", "true"),
        ("sEmpty", "[[[0 0 0] [0 0 0 0] [0 0 0 0] [0 0 0 0 0 0]] 0 false]"),
        ("jHome.robax.rax_5", "90"),
        ("tool0.tframe.rot.q1", "1"),
        ("tGrip.tload.mass", "2.5"),
        ("wobj0.uframe.trans", "[0 0 0]"),
        ("load0.mass", "0.001"),
        ("v150.v_tcp", "150"),
        ("z50.pzone_ori", "75"),
        ("fine.finep", "true"),
        // vectors, orientations, poses
        ("pX+pY*2", "[1 2 0]"),
        ("3*pX-pY", "[3 -1 0]"),
        ("-pX", "[-1 0 0]"),
        ("pX*pY", "[0 0 1]"),
        ("oZ90*oZ90", "[0 0 0 1]"),
        ("DotProd([1,2,3],[4,5,6])", "32"),
        ("VectMagn([3,4,0])", "5"),
        ("Distance(pX,pY)", "1.4142"),
        ("PoseMult(peTurn,peShift)", "[[-10 10 30] [0.7071 0 0 0.7071]]"),
        ("PoseInv(peTurn)", "[[0 10 0] [0.7071 0 0 -0.7071]]"),
        ("PoseVect(peTurn,[1,0,0])", "[10 1 0]"),
        ("OrientZYX(90,0,0)", "[0.7071 0 0 0.7071]"),
        ("OrientZYX(30,20,10)", "[0.9515 0.0381 0.1893 0.2393]"),
        ("EulerZYX(\\Z,OrientZYX(30,20,10))", "30"),
        ("EulerZYX(\\Y,OrientZYX(30,20,10))", "20"),
        ("EulerZYX(\\X,OrientZYX(30,20,10))", "10"),
        ("NOrient([2,0,0,0])", "[1 0 0 0]"),
        ("DefFrame(p10,p30,p40)", "[[100 200 300] [1 0 0 0]]"),
        ("DefFrame(p10,p30,p40\\Origin:=3)", "[[150 200 300] [1 0 0 0]]"),
        // strings
        ("StrLen(stName)", "8"),
        ("StrPart(stName,1,5)", "\"Robot\""),
        ("StrPart(stName,7,5)", "? 'StrPart' has no value for these arguments"),
        ("StrFind(stName,1,\"aeiou\")", "2"),
        ("StrFind(stName,1,\"Ro\"\\NotInSet)", "3"),
        ("StrFind(stName,1,\"xyz\")", "9"),
        ("StrMatch(stName,1,\"bo\")", "3"),
        ("StrMatch(stName,4,\"bo\")", "9"),
        ("StrMemb(stName,2,\"aeiou\")", "true"),
        ("StrMap(stName,\"aeiou\",\"AEIOU\")", "\"RObOtIcs\""),
        ("NumToStr(0.38521,3)", "\"0.385\""),
        ("NumToStr(143000,2\\Exp)", "\"1.43E+05\""),
        ("ValToStr(1.23456789)", "\"1.23457\""),
        ("ValToStr(9E9)", "\"9E+09\""),
        ("ValToStr(pX)", "\"[1,0,0]\""),
        ("ValToStr(TRUE)", "\"TRUE\""),
        ("\"p\"+NumToStr(nTwo*10,0)", "\"p20\""),
        ("ByteToStr(122\\Hex)", "\"7A\""),
        ("StrToByte(\"7A\"\\Hex)", "122"),
        // bits
        ("BitAnd(38,34)+BitOr(8,1)", "43"),
        ("BitXor(39,162)", "133"),
        ("BitNeg(38)", "217"),
        ("BitLSh(38,3)", "48"),
        ("BitRSh(38,3)", "4"),
        ("BitCheck(130,8)", "true"),
        // scopes
        ("nOther", "22"),
        // unknown values
        ("1/0", "? division by zero"),
        ("nCircle", "? its value refers to itself"),
        ("nEmpty+1", "? 'nEmpty' has no value in the source"),
        ("nCount", "? 'nCount' is written by the program"),
        ("Twice(nCount)", "? 'nCount' is written by the program"),
        ("nTwo+diPart", "? 'diPart' is not declared in the files given"),
        ("CRobT()", "? CRobT depends on where the robot is"),
        ("CalcRobT(jHome,tool0)", "? CalcRobT needs the robot's kinematics"),
        ("CalcJointT(p10,tool0)", "? CalcJointT needs the robot's kinematics"),
        ("Foo(1)", "? the function 'Foo' is not known"),
        ("Sqrt(-1)", "? 'Sqrt' has no value for these arguments"),
    ]
    .map(|(text, value)| (text, value.to_owned()))
    .into_iter()
    .chain([
        ("Offs(p10,1,2,-3)", target("[101 202 297]")),
        ("p20", target("[100 200 350]")),
        ("RelTool(p10,1,2,3)", target("[101 202 303]")),
        ("RelTool(p10,0,0,0\\Rz:=90).rot", "[0.7071 0 0 0.7071]".to_owned()),
    ])
    .collect();
    for (text, expected) in table {
        assert_eq!(shown(&evaluated(text).datum), expected, "{text}");
    }
}

#[test]
fn values_depend_on_stored_data_or_are_unknown() {
    let stored = |text: &str| {
        evaluated(text).origin.iter().find_map(|dependence| match dependence {
            Dependence::Persistent(name) | Dependence::TrustedPersistent(name) => {
                Some(name.to_string())
            }
            _ => None,
        })
    };
    assert_eq!(stored("nTwo*nNever"), None);
    assert_eq!(stored("nStored+1").as_deref(), Some("nStored"));
    assert_eq!(stored("Twice(nStored)").as_deref(), Some("nStored"));
    assert_eq!(stored("tGrip.tload.mass").as_deref(), Some("tGrip"));
    let value = evaluated("[nTwo, 3*CRobT().trans.x]");
    let Some(unknown) = value.datum.first_unknown() else { unreachable!("it is not known") };
    let text = format!("{MODULE}\nMODULE Extra\nCONST num nAsked:=[nTwo, 3*");
    assert_eq!(unknown.span.start as usize, text.len(), "where the doubt arises");
}

#[test]
fn data_have_their_values() {
    let parse = syntax::parse(MODULE.as_bytes());
    let program = Program::new(lower(FileId(0), &parse, MODULE.as_bytes()));
    let value = |module: usize, index: usize| value_of(&program, DataId { module, index }).datum;
    assert_eq!(value(0, 1), Datum::Num(6.0));
    assert_eq!((value(1, 0), value(1, 1)), (Datum::Num(22.0), Datum::Num(22.0)));
}
