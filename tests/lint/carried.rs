//! No fix makes anything faster while a part is carried.

use crate::Fixture;

/// Whether the findings of a rule have fixes, in a program that carries a load over.
fn fixes(code: &str, load: &str, setting: &str, speed: &str) -> Vec<bool> {
    let text = format!(
        "MODULE M
            ! robot: IRB1600-10/1.45
            PERS tooldata tGripper:=[TRUE,[[58,0,172.46],[0.965925826,0,0.258819045,0]],[3.1,[31.5,0,78.2],[1,0,0,0],0.018,0.022,0.009]];
            PERS loaddata loadPart:=[2.4,[0,0,22],[1,0,0,0],0.0041,0.0041,0.0063];
            CONST jointtarget jHome:=[[0,-12,14,20,105,-136],[9E9,9E9,9E9,9E9,9E9,9E9]];
            CONST jointtarget jLeft:=[[60,-12,14,20,105,-136],[9E9,9E9,9E9,9E9,9E9,9E9]];
            CONST jointtarget jRight:=[[-60,-12,14,20,105,-136],[9E9,9E9,9E9,9E9,9E9,9E9]];
            PROC main()
                MoveAbsJ jHome,v1000,fine,tGripper;
                GripLoad {load};
                {setting}
                MoveAbsJ jLeft,{speed},fine,tGripper;
                MoveAbsJ jRight,{speed},fine,tGripper;
                WaitTime 1;
                GripLoad load0;
                MoveAbsJ jHome,v1000,fine,tGripper;
            ENDPROC
        ENDMODULE"
    );
    let report = Fixture::new("M.mod".into(), &text).report();
    let own = report.findings.iter().filter(|finding| finding.rule.code == code);
    own.map(|finding| finding.fix.is_some()).collect()
}

#[test]
fn nothing_is_made_faster_while_a_part_is_carried() {
    for (code, setting, speed) in [
        ("EW206", "", "v300"),
        ("EW602", "AccSet 20,20;", "v1000"),
        ("EW603", "VelSet 20,5000;", "v1000"),
    ] {
        assert_eq!(fixes(code, "loadPart", setting, speed), [false], "{code}");
        assert_eq!(fixes(code, "load0", setting, speed), [true], "{code}");
    }
}
