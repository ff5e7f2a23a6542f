//! `joulepath optimize` with other cost functions, curves of energy over time, and keep-out zones.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod command;

use std::fs;

use command::{KNOWN_LIMITS, number};
use serde_json::Value;

const PROGRAM: &str = "MODULE M\n\
    CONST jointtarget jA:=[[0,-12,14,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
    CONST jointtarget jB:=[[60,20,0,-20,65,30],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
    PROC main()\n\
    MoveAbsJ jA,v1000,fine,tool0;\n\
    MoveAbsJ jB,vmax,fine,tool0;\n\
    MoveAbsJ jA,v1000,fine,tool0;\n\
    ENDPROC\n\
    ENDMODULE\n";
/// Relative tolerance of a local optimum.
const LOCAL: f64 = 5e-3;

fn optimize(config: &str, options: &[&str]) -> Value {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("joulepath.toml"), config).unwrap();
    let robot = ["--robot", KNOWN_LIMITS, "--allow-faster-joints"];
    command::optimize(folder.path(), PROGRAM, &[&robot[..], options].concat())
}

fn energy(result: &Value) -> f64 {
    number(result, "/optimized/motion_energy_j")
}

#[test]
fn no_other_cost_function_saves_more_energy() {
    let electrical = energy(&optimize("", &["--energy", "electrical"]));
    let others = ["electrical-no-regeneration", "mechanical", "velocity", "torque"]
        .map(|cost| energy(&optimize("", &["--energy", cost])));
    assert!(others.iter().all(|other| *other > (1.0 - LOCAL) * electrical), "{others:?}");
    // Each cost function of the literature has another timing.
    assert!(others[2] != electrical && others[3] != electrical && others[2] != others[3]);
    // This robot does not regenerate.
    assert_eq!(others[0], electrical);
}

#[test]
fn energy_time_curves_fall_and_stay_above_their_bounds() {
    let result = optimize("", &["--pareto", "6", "--allow-faster-tcp"]);
    let mut curves = 0;
    for segment in result["segments"].as_array().unwrap() {
        let Some(curve) = segment["pareto"].as_array() else { continue };
        curves += 1;
        assert_eq!(curve.len(), 6);
        for point in curve {
            assert!(number(point, "/lower_bound_j") <= number(point, "/energy_j"), "{point}");
        }
        for pair in curve.windows(2) {
            assert!(number(&pair[0], "/time_s") < number(&pair[1], "/time_s"));
        }
        // The first increases of the duration save most.
        assert!(number(&curve[1], "/energy_j") < number(&curve[0], "/energy_j"));
        assert!(number(&curve[0], "/time_s") < number(segment, "/time_before_s"));
    }
    assert_eq!(curves, 2);
}

#[test]
fn keep_out_zones_restrict_only_free_paths() {
    let free = ["--free-path", "--deviation", "80"];
    let alone = energy(&optimize("", &free));
    let kept = energy(&optimize("", &[]));
    assert!(alone < kept);
    let far = "[[keep_out]]\nplane = [0, 0, 1, -9]\n";
    assert_eq!(energy(&optimize(far, &free)), alone);
    // The zone leaves no space to deviate from the path.
    let everywhere = "[[keep_out]]\nbox = [[-4, -4, -4], [4, 4, 4]]\n";
    assert_eq!(energy(&optimize(everywhere, &free)), kept);
}
