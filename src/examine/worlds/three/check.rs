//! Writes nominal models and motions with this world's torques, to compare with another program.

use crate::arm::CAD;
use crate::body::{Bodies, BodyLaw};
use crate::build::nominal;
use crate::drive::{Rotors, Run, World, logged};
use crate::everyday::{Day, Everyday};
use crate::fault::{EFFECTS, Fault, Place};
use crate::model_file;
use crate::motion::{Style, track};
use crate::rng::Rng;
use crate::spatial::{Body, V3};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;

/// Run with `WORLD_CHECK=FOLDER cargo test`: without it nothing is written.
#[test]
fn nominal_torques() -> std::io::Result<()> {
    let Ok(folder) = std::env::var("WORLD_CHECK") else { return Ok(()) };
    fs::create_dir_all(&folder)?;
    for number in 1..=20 {
        let mut rng = Rng::new(7, number, "check");
        let arm = nominal(&mut rng, number, false);
        let real = arm.real(&CAD, &mut rng);
        assert!(real.bodies.iter().all(|body| body.second_moments().symmetric_eigenvalues().min() > 0.0));
        let motion = track(Style::Fourier, &arm, 5.0, &mut rng);
        let count = arm.axes();
        let mut out = "t".to_owned();
        for group in ["q", "qd", "qdd", "tau", "plain"] {
            for i in 1..=count {
                let _ = write!(out, ",{group}{i}");
            }
        }
        out.push('\n');
        for (k, at) in motion.points.iter().enumerate().step_by(10) {
            let _ = write!(out, "{}", k as f64 * crate::motion::STEP);
            for row in [at.q, at.v, at.a, arm.model(at, true), arm.model(at, false)] {
                for value in row.iter().take(count) {
                    let _ = write!(out, ",{value}");
                }
            }
            out.push('\n');
        }
        fs::write(format!("{folder}/{number}.csv"), out)?;
        fs::write(format!("{folder}/{number}.toml"), model_file::toml(&arm).1)?;
        fs::write(format!("{folder}/{number}.urdf"), model_file::urdf(&arm).1)?;
    }
    Ok(())
}

/// Torques of laws whose conventions another program can confirm: tilt, contact, payload, coupling.
#[test]
fn conventions() -> std::io::Result<()> {
    let Ok(folder) = std::env::var("WORLD_CHECK") else { return Ok(()) };
    fs::create_dir_all(&folder)?;
    let mut rng = Rng::new(7, 1, "check");
    let arm = nominal(&mut rng, 1, true);
    let motion = track(Style::Fourier, &arm, 5.0, &mut rng);
    let body = Body { mass: 5.0, com: V3::new(0.1, 0.02, 0.03), inertia: nalgebra::Matrix3::zeros() };
    let window = [0.0, 5.0];
    let laws = [
        ("tilt", BodyLaw::Tilt { angle: 0.1, direction: 0.5, soft: 0.0 }),
        ("contact", BodyLaw::Contact { force: 50.0, azimuth: 0.4, elevation: 0.3, window, lopsided: false }),
        ("payload", BodyLaw::Payload { body }),
        ("offset", BodyLaw::Offset { joint: 1, offset: 0.1, wave: 0.0, order: 1.0, phase: 0.0 }),
    ];
    let toml = model_file::toml(&arm).1;
    let effects = [
        ("tilt", "[effects.base_tilt]\nangle = 0.1\ndirection = 0.5\n"),
        (
            "contact",
            "[effects.contact]\nforce = 50.0\nt_start_s = 0.0\nt_end_s = 5.0\nperiod_s = 0.0\nazimuth = 0.4\n\
             elevation = 0.3\nrise = 0.5\n",
        ),
        ("payload", ""),
        ("offset", "[effects.encoder_offset]\noffset = [0.0, 0.1, 0.0, 0.0, 0.0, 0.0]\n"),
        ("coupling", "[effects.wrist_coupling]\ncoupling = 0.5\n"),
    ];
    for (name, text) in effects {
        fs::write(format!("{folder}/convention-{name}.toml"), format!("{toml}\n{text}"))?;
    }
    let mut rows = Vec::new();
    for (name, law) in laws {
        let laws = [law];
        let bodies = Bodies::new(&arm, &laws);
        rows.push((name, bodies.torques(&bodies.motion(&motion))));
    }
    // Coupling: motor 6 turns with q6 + 0.5 q5.
    let coupled = motion.points.iter().map(|at| {
        let mut torques = arm.rigid(at);
        let rate = at.v[5] + 0.5 * at.v[4];
        let motor =
            arm.rotor[5] * (at.a[5] + 0.5 * at.a[4]) + arm.coulomb[5] * rate.signum() + arm.viscous[5] * rate;
        let own = arm.rotor[5] * at.a[5] + arm.coulomb[5] * at.v[5].signum() + arm.viscous[5] * at.v[5];
        torques[5] += motor - own;
        torques[4] += 0.5 * motor;
        torques
    });
    rows.push(("coupling", coupled.collect()));
    for (name, torques) in rows {
        let mut out = "t,q1,q2,q3,q4,q5,q6,qd1,qd2,qd3,qd4,qd5,qd6,qdd1,qdd2,qdd3,qdd4,qdd5,qdd6,tau1,tau2,tau3,tau4,tau5,tau6\n".to_owned();
        for (k, (at, torque)) in motion.points.iter().zip(torques).enumerate().step_by(10) {
            let _ = write!(out, "{}", k as f64 * crate::motion::STEP);
            let mut all = torque;
            for (i, value) in all.iter_mut().enumerate() {
                *value +=
                    arm.rotor[i] * at.a[i] + arm.coulomb[i] * at.v[i].signum() + arm.viscous[i] * at.v[i];
            }
            for row in [at.q, at.v, at.a, all] {
                for value in row.iter().take(6) {
                    let _ = write!(out, ",{value}");
                }
            }
            out.push('\n');
        }
        fs::write(format!("{folder}/convention-{name}.csv"), out)?;
    }
    Ok(())
}

/// The table of an effect for a robot file: lists by joint, or single values.
fn table(fault: &Fault, axes: usize) -> String {
    let mut lists: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    let mut out = format!("\n[effects.{}]\n", fault.id);
    for parameter in fault.parameters(None) {
        match parameter.joint {
            Some(joint) if fault.id != "contact" => {
                let list = lists.entry(parameter.name).or_insert_with(|| vec![0.0; axes]);
                list[joint - 1] = parameter.value;
            }
            _ => {
                let _ = writeln!(out, "{} = {:?}", parameter.name, parameter.value);
            }
        }
    }
    for (name, list) in lists {
        let _ = writeln!(out, "{name} = {list:?}");
    }
    out
}

/// What each fault changes, beside a robot file with the library's effect of the same parameters:
/// signs and sizes of graded parameters must agree.
#[test]
fn laws() -> std::io::Result<()> {
    let Ok(folder) = std::env::var("WORLD_CHECK") else { return Ok(()) };
    fs::create_dir_all(&folder)?;
    let mut rng = Rng::new(11, 1, "laws");
    let arm = nominal(&mut rng, 1, true);
    let mut everyday = Everyday::new(&arm, &mut rng);
    everyday.lag = 1e-5;
    let world = World { nominal: arm.clone(), real: arm.clone(), everyday, rotors: Rotors::InModel };
    let track = track(Style::Fourier, &arm, 10.0, &mut rng);
    let day = Day::new(&mut rng);
    let run = Run { track, entry: None, cycles: 2, day, stream: Rng::new(11, 1, "cycles") };
    let clean = logged(&world, &run, &[]);
    let place = Place { arm: &arm, period: 10.0, length: 20.0, rate: 250.0 };
    for id in EFFECTS {
        for draw in 0..4 {
            let Some(fault) = Fault::draw(id, &place, &mut rng) else { continue };
            let changed = logged(&world, &run, std::slice::from_ref(&fault));
            let name = format!("{folder}/law-{id}-{draw}");
            let mut out = format!("# {}\n", fault.form.replace(',', ";")).replace('#', "t,q1,q2,q3,q4,q5,q6,qd1,qd2,qd3,qd4,qd5,qd6,qdd1,qdd2,qdd3,qdd4,qdd5,qdd6,d1,d2,d3,d4,d5,d6,");
            for (k, (with, without)) in changed.iter().zip(&clean).enumerate().take(5000) {
                let at = &run.track.points[k];
                let _ = write!(out, "{}", k as f64 * crate::motion::STEP);
                let mut delta = [0.0; crate::spatial::MAX];
                for (i, delta) in delta.iter_mut().enumerate() {
                    *delta = with[i] - without[i];
                }
                for row in [at.q, at.v, at.a, delta] {
                    for value in row.iter().take(6) {
                        let _ = write!(out, ",{value}");
                    }
                }
                out.push_str(",0\n");
            }
            fs::write(format!("{name}.csv"), out)?;
            fs::write(format!("{name}.toml"), model_file::toml(&arm).1 + &table(&fault, 6))?;
        }
    }
    fs::write(format!("{folder}/law.toml"), model_file::toml(&arm).1)
}

/// The smooth error alone, share of the joint's torque: between 0.1 and 4 %, its median below 1.5 %.
#[test]
fn smooth_error() {
    let mut shares = Vec::new();
    for number in 1..=40 {
        let mut rng = Rng::new(5, number, "smooth");
        let arm = nominal(&mut rng, number, false);
        let everyday = Everyday::new(&arm, &mut rng);
        let track = track(Style::Fourier, &arm, 8.0, &mut rng);
        for (i, habit) in everyday.joints.iter().enumerate() {
            let (mut error, mut torque) = (0.0, 0.0);
            for at in track.points.iter().step_by(20) {
                let load = arm.rigid(at)[i];
                error += habit.smooth(i, at, &arm, load).powi(2);
                torque += arm.model(at, true)[i].powi(2);
            }
            shares.push((error / torque).sqrt());
        }
    }
    shares.sort_by(f64::total_cmp);
    let at = |share: f64| shares[(share * shares.len() as f64) as usize];
    println!("smooth error: 5 % {:.4}, median {:.4}, 95 % {:.4}", at(0.05), at(0.5), at(0.95));
    assert!(at(0.5) < 0.015 && at(0.05) > 0.001 && at(0.95) < 0.04);
}
