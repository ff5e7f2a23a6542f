//! Streams on difficult paths: near singularities, blended, with repeated way points, with resting
//! joints, with tight torques; and on as many easy paths. An independent evaluation of the spline
//! checks the limits densely.

#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

mod cases;
mod played;
#[path = "../support/mod.rs"]
mod support;

use cases::{Case, EASY, HARD, Kind, cases};
use joulepath::retime::optimize::freedom::{Bound, Freedom};
use joulepath::retime::optimize::reason::Reason;
use joulepath::retime::optimize::retime::{Goal, retime};
use rayon::prelude::*;

/// Number of paths of each sort.
const COUNT: usize = 160;
/// Accepted ratio to a limit between the points of a stream.
const EXCESS: f64 = 1.001;

fn is_true(case: &Case, reason: &Reason) -> bool {
    match reason {
        Reason::NoSaving | Reason::TooShort(_) => true,
        Reason::NoStream(why) => !why.is_empty() && HARD.contains(&case.kind),
        _ => false,
    }
}

#[test]
fn streams_keep_all_limits_or_the_refusal_has_a_reason() {
    let all: Vec<Case> = cases(&HARD, COUNT).into_iter().chain(cases(&EASY, COUNT)).collect();
    let freedom = Freedom { joints: Bound::Robot, ..Freedom::default() };
    let results: Vec<(String, bool)> = all
        .par_iter()
        .flat_map(|case| {
            let task = case.task(&freedom);
            let fastest = retime(&task, Goal::Fastest);
            let least = fastest.as_ref().map_or(case.run().duration(), |found| found.duration_s);
            let thrifty = retime(&task, Goal::Exactly(1.1 * least));
            [("fastest", fastest), ("thrifty", thrifty)].map(|(what, outcome)| match outcome {
                Ok(retiming) => {
                    let (worst, which) = played::worst(case, &retiming.stream);
                    (format!("{what} {}: {worst:.5} of {which}", case.name), worst <= EXCESS)
                }
                Err(reason) => {
                    (format!("{what} {}: {reason:?}", case.name), is_true(case, &reason))
                }
            })
        })
        .collect();
    let wrong: Vec<&str> = results.iter().filter(|r| !r.1).map(|r| r.0.as_str()).collect();
    let left: Vec<&str> =
        results.iter().map(|r| r.0.as_str()).filter(|r| !r.contains(" of ")).collect();
    assert!(wrong.is_empty(), "{} wrong:\n{}", wrong.len(), wrong.join("\n"));
    assert!(left.len() * 20 <= results.len(), "{} left:\n{}", left.len(), left.join("\n"));
    assert!(!all.is_empty() && all.iter().any(|case| case.kind == Kind::TightTorque));
}
