//! Cases of torques: healthy, other parameters, one or two effects, outside.

use super::everyday::Day;
use super::fault::{Action, Fault, Ground};
use super::logger::{Style, csv};
use super::motion::Motion;
use super::plant::{Plant, Record, Run};
use super::setup::{Plan, levels, plan, plant, setup};
use super::sim::run;
use super::{body_faults, drive_faults, friction_faults, outside, truth};
use crate::examine::worlds::api::{Case, Kind, largest, options};
use crate::examine::worlds::random::Rng;

/// Ids of all effects of torques that are drawn as a fault.
fn ids() -> Vec<&'static str> {
    let all = friction_faults::IDS.iter().chain(&drive_faults::IDS).chain(&body_faults::IDS);
    all.copied().collect()
}

/// Draws an effect, of a given id where there is one.
fn draw_effect(ground: &Ground, forced: Option<&str>, rng: &mut Rng) -> Fault {
    let drawn = rng.pick(&ids());
    let mut id = forced.unwrap_or(drawn);
    if id == "wrist_coupling" && ground.n() != 6 {
        id = "payload";
    }
    if friction_faults::IDS.contains(&id) {
        friction_faults::draw(id, ground, rng)
    } else if drive_faults::IDS.contains(&id) {
        drive_faults::draw(id, ground, rng)
    } else {
        body_faults::draw(id, ground, rng)
    }
}

/// Faults that need the structure of the simulation for themselves.
fn structural(fault: &Fault) -> bool {
    matches!(
        fault.action,
        Action::Flex(_) | Action::Encoder(_) | Action::Bristle(_) | Action::Wrist(_)
    )
}

/// Whether it is the coupling of the wrist: no other friction of the last joints is then drawn.
fn wrist(fault: &Fault) -> bool {
    matches!(fault.action, Action::Wrist(_))
}

fn draw_faults(kind: Kind, ground: &Ground, forced: Option<&str>, rng: &mut Rng) -> Vec<Fault> {
    match kind {
        Kind::ParametersOnly => vec![body_faults::draw("link_parameters", ground, rng)],
        Kind::One => vec![draw_effect(ground, forced, rng)],
        Kind::Outside => vec![outside::draw(ground, rng)],
        Kind::Two => {
            let first = draw_effect(ground, forced, rng);
            let mut second = draw_effect(ground, None, rng);
            while second.truth.id == first.truth.id
                || structural(&second)
                || first.truth.equivalents.contains(&second.truth.id)
                || wrist(&first) && second.truth.joints.iter().any(|i| i + 1 >= ground.n())
            {
                second = draw_effect(ground, None, rng);
            }
            vec![first, second]
        }
        _ => Vec::new(),
    }
}

/// One run of the plant.
pub(super) fn simulate(
    plant: &Plant,
    faults: &[Fault],
    motion: &Motion,
    plan: (&Plan, usize),
    rng: &mut Rng,
) -> Record {
    let (plan, cycles) = plan;
    let day = Day::draw(plant.robot.arm.n(), cycles, rng);
    let flexible = faults.iter().any(|fault| matches!(fault.action, Action::Flex(_)));
    let dt = if flexible { plan.dt.min(5e-4) } else { plan.dt };
    let set = Run { motion, cycles, dt, rate: plan.rate, transient: plan.transient, day };
    run(plant, faults, &set, rng)
}

/// The period that is told \[s\].
pub(super) fn told(plan: &Plan, rng: &mut Rng) -> Option<f64> {
    (plan.cycles > 1 && rng.chance(0.5)).then_some(plan.period)
}

/// Makes a case of torques; `forced`: the id of its first effect.
pub(super) fn case(seed: u64, number: usize, kind: Kind, forced: Option<&str>) -> Case {
    let stream = |purpose: &str| Rng::stream(seed, number, purpose);
    let setup = setup(false, false, false, &mut stream("robot"));
    let plan = plan(&setup, false, &mut stream("plan"));
    let (scale, rows) = levels(&setup, &plan);
    let plant = plant(&setup, &scale, &rows, &mut stream("plant"));
    let n = setup.nominal.arm.n();
    let style =
        Style::draw(n, &scale.torque, &setup.nominal.torque, plan.rate, &mut stream("style"));
    let ground = Ground {
        robot: &setup.robot,
        scale: &scale,
        spread: setup.spread,
        period: plan.period,
        length: plan.period * plan.cycles as f64,
        rate: plan.rate,
    };
    let mut faults = draw_faults(kind, &ground, forced, &mut stream("fault"));
    let mut files = vec![setup.file()];
    let mut records = Vec::new();
    let (mut days, mut noise) = (stream("days"), stream("noise"));
    for (k, motion) in plan.motions.iter().enumerate() {
        let record = simulate(&plant, &faults, motion, (&plan, plan.cycles), &mut days);
        files.push((format!("log-{}.csv", k + 1), csv(&style, &record, true, &[], &mut noise)));
        records.push(record);
    }
    let held = simulate(&plant, &faults, &plan.heldout, (&plan, plan.heldout_cycles), &mut days);
    files.push(("heldout.csv".to_owned(), csv(&style, &held, true, &[], &mut noise)));
    for k in 0..plan.baselines {
        if let Some(motion) = plan.motions.get(k % plan.motions.len().max(1)) {
            let record = simulate(&plant, &[], motion, (&plan, plan.cycles), &mut days);
            let text = csv(&style, &record, true, &[], &mut noise);
            files.push((format!("baseline-{}.csv", k + 1), text));
        }
    }
    let nats =
        truth::information(&plant, &setup.spread, (&records, plan.period), &setup.in_file, &style);
    for (fault, nats) in faults.iter_mut().zip(nats) {
        fault.truth.nats = nats;
    }
    let told = told(&plan, &mut stream("options"));
    let options = options(&files[0].0, setup.spread.trust, told);
    Case {
        effects: faults.into_iter().map(|fault| fault.truth).collect(),
        place: largest(&truth::squares(n, &records)),
        heldout: truth::levels(&plant, &setup.in_file, &held),
        ..Case::new(files, options, kind)
    }
}
