use super::*;

const LOG: &str = "# joulepath recorder 1\n# program 3f2a9c0d11e8a4b7\n# session 2026-11-29 08:33:12\n\
t,cycle,cmd,file,line,event,value,signal\n\
0.000,1,0,,,cycle,,\n\
0.010,1,1,A.mod,23,start,,\n\
3.120,1,1,A.mod,23,arrive,,\n\
3.121,1,1,B.mod,14,wait,,diDoor\n\
5.910,1,1,,,signal,1,diDoor\n\
5.902,1,1,B.mod,14,end,0,diDoor\n\
6.000,1,1,B.mod,14,wait,,diDoor\n\
9.000,1,1,B.mod,14,end,1,diDoor\n\
9.100,1,1,,,flush,0.05,\n\
10.0,2,0,,,cycle,,\n\
12.0,2,1,B.mod,14,wait,,diDoor\n";

fn error(text: &str) -> String {
    read(text.as_bytes()).expect_err(text).to_string()
}

#[test]
fn cycles_have_their_waits() {
    assert!(is_event_log(LOG.as_bytes()));
    let recording = read(LOG.as_bytes()).expect("a log");
    assert_eq!(recording.program.as_deref(), Some("3f2a9c0d11e8a4b7"));
    assert_eq!(recording.sessions[0].started.as_deref(), Some("2026-11-29 08:33:12"));
    let found = cycles(&recording);
    assert_eq!(found.len(), 1, "the second cycle has no end");
    let cycle = &found[0];
    assert!((cycle.duration() - 9.95).abs() < 1e-12);
    let [first, second] = &cycle.visits[..] else { panic!("{cycle:?}") };
    assert!((first.length().expect("ended") - 2.781).abs() < 1e-9);
    assert_eq!((first.occurrence, second.occurrence), (0, 1));
    assert_eq!((first.by_limit, second.by_limit), (false, true));
}

#[test]
fn spreadsheets_may_have_changed_the_marks() {
    let semicolons = LOG.replace(',', ";").replace('.', ",").replace(",mod", ".mod");
    let semicolons = semicolons.replace('\n', "\r\n");
    assert_eq!(cycles(&read(semicolons.as_bytes()).expect("a log")), {
        cycles(&read(LOG.as_bytes()).expect("a log"))
    });
}

#[test]
fn faults_are_named() {
    assert!(error("t,q1\n0,1\n").contains("`cycle`, `event`, `line` are missing"));
    assert!(error("").contains("no log of events"));
    let head = "t,cycle,cmd,file,line,event,value,signal\n";
    let of = |rows: &str| format!("{head}{rows}");
    let two =
        of("0,1,0,,,cycle,,\n1,2,0,,,cycle,,\n1.1,1,1,A.mod,3,wait,,\n1.2,2,1,A.mod,3,wait,,\n");
    assert!(error(&two).contains("two robots"), "{}", error(&two));
    let midnight = of("86390,1,0,,,cycle,,\n5,1,1,A.mod,3,wait,,\n");
    assert!(error(&midnight).contains("at midnight"), "{}", error(&midnight));
    let autumn = of("5000,1,0,,,cycle,,\n1402,1,1,A.mod,3,wait,,\n");
    assert!(error(&autumn).contains("summer time ends"), "{}", error(&autumn));
    let spring = of("5000,1,0,,,cycle,,\n8603,1,1,A.mod,3,arrive,,\n");
    assert!(error(&spring).contains("summer time begins"), "{}", error(&spring));
    let programs = format!("# program aa\n{head}0,1,0,,,cycle,,\n# program bb\n");
    assert!(error(&programs).contains("changes from aa to bb"), "{}", error(&programs));
    let corrupt = of("x,1,0,,,cycle,,\n0,1,0,,,wait,,\n0,1,0,,,cycle,,\n");
    assert!(error(&corrupt).contains("2 of 3 rows"), "{}", error(&corrupt));
}

#[test]
fn a_row_that_is_cut_off_is_left_out() {
    let cut = &LOG[..LOG.len() - 12];
    let recording = read(cut.as_bytes()).expect("a log");
    assert_eq!(recording.rejected.len(), 1);
    assert!(recording.rejected[0].1.contains("ends within"));
}
