//! `joulepath robots check`: checks a robot and lists its missing data.

use std::fmt::Write as _;
use std::process::ExitCode;

use serde_json::{Map, Value, json};

use crate::arm::effects;
use crate::arm::kinematics::{fk, ik_near, limits_ok, radical_inverse};
use crate::arm::robot::{self, Lack, Model, Use, implausible, lacking};
use crate::tool::cli::common::{Format, notes, print};

/// Number of poses at which forward and inverse kinematics are compared.
const POSES: u32 = 64;
/// Maximum difference of the poses \[m\] and \[rad\].
const POSE_TOLERANCE: f64 = 1e-6;

/// The findings on one robot.
struct Finding {
    name: String,
    joints: usize,
    problems: Vec<String>,
    /// What each command would lack.
    lacks: Vec<(Use, Vec<String>)>,
}

/// Checks the named robots, or the whole catalogue.
pub(super) fn run(robots: &[String], format: Format) -> anyhow::Result<ExitCode> {
    let names: Vec<String> = if robots.is_empty() {
        robot::names().map(str::to_owned).collect()
    } else {
        robots.to_vec()
    };
    let mut findings = Vec::with_capacity(names.len());
    for name in &names {
        let model = effects::load(name)?;
        if !robots.is_empty() {
            notes(false, model.assumed());
        }
        findings.push(checked(&model, &effects::load_estimated(name)?));
    }
    let passed = findings.iter().filter(|finding| finding.problems.is_empty()).count();
    let json = || {
        let robots: Vec<Value> = findings.iter().map(document).collect();
        json!({ "robots": robots, "passed": passed })
    };
    let lines = || {
        findings.iter().map(text).collect::<String>()
            + &format!("{passed} of {} sound\n", findings.len())
    };
    print(format, json, lines)?;
    Ok(if passed == findings.len() { ExitCode::SUCCESS } else { ExitCode::from(1) })
}

/// The findings on a robot, from its file and from the estimate.
fn checked(model: &Model, estimated: &Model) -> Finding {
    let mut problems = implausible(model);
    let missed = (1..=POSES).filter(|n| !inverse_matches(model, *n)).count();
    if missed > 0 {
        problems.push(format!("kinematics: {missed} of {POSES} poses do not lead back"));
    }
    let words = |of: Use| lacking(estimated, of).iter().map(Lack::to_string).collect();
    let lacks = Use::ALL.map(|of| (of, words(of))).to_vec();
    Finding { name: model.name.clone(), joints: model.dof, problems, lacks }
}

/// Whether the inverse of the `n`-th pose leads back to it. Without six joints, only a finite pose
/// is required.
fn inverse_matches(model: &Model, n: u32) -> bool {
    const BASES: [u32; 7] = [2, 3, 5, 7, 11, 13, 17];
    let q: Vec<f64> = model
        .limits
        .position
        .iter()
        .zip(BASES)
        .map(|([low, high], base)| low + radical_inverse(n, base) * (high - low))
        .collect();
    let pose = fk(model, &q);
    let Ok(q) = <[f64; 6]>::try_from(q.as_slice()) else {
        return pose.to_homogeneous().iter().all(|entry| entry.is_finite());
    };
    // A parallelogram may not allow the pose: no finding.
    if limits_ok(model, &q).is_err() {
        return true;
    }
    ik_near(model, &pose, &q).is_ok_and(|found| {
        let miss = fk(model, &found).inverse() * pose;
        miss.translation.vector.norm() < POSE_TOLERANCE && miss.rotation.angle() < POSE_TOLERANCE
    })
}

fn text(finding: &Finding) -> String {
    let verdict = if finding.problems.is_empty() { "sound" } else { "NOT SOUND" };
    let mut text = format!("{}: {verdict}, {} joints\n", finding.name, finding.joints);
    for problem in &finding.problems {
        let _ = writeln!(text, "  {problem}");
    }
    for (command, missing) in finding.lacks.iter().filter(|(_, missing)| !missing.is_empty()) {
        let _ = writeln!(text, "  {command} lacks {}", missing.join(", "));
    }
    text
}

fn document(finding: &Finding) -> Value {
    let lacks: Map<String, Value> = finding
        .lacks
        .iter()
        .map(|(command, missing)| (command.to_string(), json!(missing)))
        .collect();
    json!({
        "name": finding.name,
        "joints": finding.joints,
        "sound": finding.problems.is_empty(),
        "problems": finding.problems,
        "lacks": lacks,
    })
}
