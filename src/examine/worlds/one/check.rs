//! A check of the rigid bodies against another program: states and the nominal model's torques.

use crate::arm::{Arm, MAX, Row};
use crate::design::design;
use crate::dynamics::model;
use crate::motion::{STEP, Style, track};
use crate::rng::Rng;
use std::fmt::Write as _;

/// Fine steps between two rows of the check: 200 Hz.
const EVERY: usize = 10;

/// One row of numbers.
fn line(out: &mut String, t: f64, parts: &[&Row], count: usize) {
    let _ = write!(out, "{t}");
    for part in parts {
        for x in &part[..count] {
            let _ = write!(out, ",{x}");
        }
    }
    out.push('\n');
}

/// The names of the columns.
fn head(names: &[&str], count: usize) -> String {
    let mut out = "t".to_owned();
    for name in names {
        for j in 1..=count {
            let _ = write!(out, ",{name}{j}");
        }
    }
    out + "\n"
}

/// A nominal robot as TOML and URDF, a motion with speeds and accelerations, and the torques \[Nm\] of
/// both models on it: `(toml, urdf, motion, torques of TOML, torques of URDF)`.
#[must_use]
pub fn agreement(seed: u64, number: usize) -> [String; 5] {
    let arm: Arm = design(&mut Rng::new(seed, number, "design"), false);
    let track = track(&arm, Style::Fourier, (6.0, 1, false), &mut Rng::new(seed, number, "check"));
    let count = arm.count();
    let mut motion = head(&["q", "qd", "qdd"], count);
    let mut with = head(&["tau"], count);
    let mut without = with.clone();
    for i in (0..track.steps).step_by(EVERY) {
        let (q, v, a) = (&track.cycle.q[i], &track.cycle.v[i], &track.cycle.a[i]);
        let mut signs = [0.0; MAX];
        for j in 0..count {
            signs[j] = if v[j] == 0.0 { 0.0 } else { v[j].signum() };
        }
        let t = i as f64 * STEP;
        line(&mut motion, t, &[q, v, a], count);
        line(&mut with, t, &[&model(&arm, (q, v, a), &signs, true)], count);
        line(&mut without, t, &[&model(&arm, (q, v, a), &signs, false)], count);
    }
    [
        crate::nominal::toml(&arm, "check"),
        crate::nominal::urdf(&arm, "check"),
        motion,
        with,
        without,
    ]
}

/// What a fault alone changes, for a check of its sign and its parameters against a library.
pub struct Change {
    /// The robot's file.
    pub toml: String,
    /// Angles of the encoders, speeds and accelerations.
    pub motion: String,
    /// What the fault changes \[Nm\].
    pub change: String,
    /// The truth.
    pub truth: crate::api::Truth,
}

/// The change by the effect of the catalogue's number in one of its forms, on an everyday robot.
#[must_use]
pub fn change(seed: u64, number: usize, form: usize, size: f64) -> Change {
    use crate::everyday::Everyday;
    use crate::faults::{Context, catalogue};
    use crate::plant::{Robot, Run, level, tables};
    let arm = design(&mut Rng::new(seed, number, "design"), true);
    let track = track(&arm, Style::Fourier, (6.0, 2, false), &mut Rng::new(seed, number, "check"));
    let level = level(&arm, &track.cycle);
    let everyday = Everyday::new(&arm, &level, &mut Rng::new(seed, number, "everyday"));
    let robot = Robot { arm: &arm, everyday: &everyday, level: &level, removed: [0.0; MAX] };
    let tables = tables(&robot, &track);
    let day = everyday.day(&mut Rng::new(seed, number, "day"));
    let entry = &catalogue::TORQUES[number % catalogue::TORQUES.len()];
    let mut choice = catalogue::named(entry.id, arm.count(), &mut Rng::new(seed, number, "fault"));
    choice.form = form;
    let period = track.period();
    let ctx = Context {
        arm: &arm,
        level: &level,
        path: &track.cycle,
        period,
        duration: 2.0 * period,
        rate: 200.0,
    };
    let fault = choice.build(&ctx, size);
    let count = arm.count();
    let times: Vec<f64> = (0..track.steps / EVERY).map(|k| period + k as f64 * 0.005).collect();
    let without = Run::new(&robot, (&track, &tables), &[], &day).samples(&times);
    let with = Run::new(&robot, (&track, &tables), &[&fault], &day).samples(&times);
    let mut motion = head(&["q", "qd", "qdd"], count);
    let mut change = head(&["tau"], count);
    for (a, b) in with.iter().zip(&without) {
        let rigid = |s: &crate::plant::Sample| model(&arm, (&s.q, &s.v, &s.a), &[0.0; MAX], true);
        let (ra, rb) = (rigid(a), rigid(b));
        let mut row = [0.0; MAX];
        for j in 0..count {
            row[j] = a.tau[j] - ra[j] - b.tau[j] + rb[j];
        }
        line(&mut motion, a.t - period, &[&a.q, &a.v, &a.a], count);
        line(&mut change, a.t - period, &[&row], count);
    }
    Change { toml: crate::nominal::toml(&arm, "check"), motion, change, truth: fault.truth }
}
