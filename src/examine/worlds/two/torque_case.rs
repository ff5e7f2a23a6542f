//! Cases of torques: healthy, other parameters, one or two effects, outside.

use serde_json::json;

use crate::api::{Case, Kind};
use crate::everyday::Day;
use crate::fault::{Action, Fault, Ground};
use crate::logger::{Style, csv};
use crate::motion::Motion;
use crate::rng::Rng;
use crate::setup::{Plan, Setup, levels, plan, plant, setup};
use crate::sim::{Plant, Record, Run, run};
use crate::{body_faults, drive_faults, friction_faults, model_file, outside, truth};

/// Files and options of a case, while they are collected.
#[derive(Default)]
pub struct Files {
    /// Names and contents.
    pub list: Vec<(String, String)>,
    /// Names by option: log, heldout, baseline.
    pub names: [Vec<String>; 3],
}

impl Files {
    /// Adds a log; `role` 0 log, 1 held-out, 2 baseline.
    pub fn add(&mut self, role: usize, name: String, text: String) {
        if let Some(names) = self.names.get_mut(role) {
            names.push(name.clone());
        }
        self.list.push((name, text));
    }
}

/// Ids of all effects of torques that are drawn as a fault.
pub fn ids() -> Vec<&'static str> {
    let all = friction_faults::IDS.iter().chain(&drive_faults::IDS).chain(&body_faults::IDS);
    all.copied().collect()
}

/// Draws an effect, of a given id where there is one.
fn draw_effect(ground: &Ground, forced: Option<&str>, rng: &mut Rng) -> Fault {
    let drawn = rng.pick(&ids(), "payload");
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
    matches!(fault.action, Action::Flex(_) | Action::Encoder(_) | Action::Bristle(_) | Action::Wrist(_))
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
pub fn simulate(
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

/// The robot file.
pub fn robot_file(setup: &Setup, files: &mut Files) -> &'static str {
    let name = format!("{:?}-{:.1}kg", setup.nominal.build, setup.nominal.size.payload).to_lowercase();
    let (file, text) = if setup.toml {
        ("nominal.toml", model_file::toml(&setup.nominal, &name))
    } else {
        ("nominal.urdf", model_file::urdf(&setup.nominal, &name))
    };
    files.list.push((file.to_owned(), text));
    file
}

/// The options of the diagnosis.
pub fn options(
    setup: &Setup,
    file: &str,
    plan: &Plan,
    files: &Files,
    rng: &mut Rng,
) -> serde_json::Value {
    let [log, heldout, baseline] = &files.names;
    let mut options = json!({
        "robot": file,
        "trust": setup.spread.name,
        "log": log,
        "heldout": heldout,
        "baseline": baseline,
    });
    if plan.cycles > 1 && rng.chance(0.5) {
        options["period"] = json!(plan.period);
    }
    options
}

/// Makes a case of torques; `forced`: the id of its first effect.
pub fn case(seed: u64, number: usize, kind: Kind, forced: Option<&str>) -> Case {
    let stream = |purpose: &str| Rng::new(seed, number, purpose);
    let setup = setup(false, false, false, &mut stream("robot"));
    let plan = plan(&setup, false, &mut stream("plan"));
    let (scale, rows) = levels(&setup, &plan);
    let plant = plant(&setup, &scale, &rows, &mut stream("plant"));
    let n = setup.nominal.arm.n();
    let style = Style::draw(n, &scale.torque, &setup.nominal.torque, plan.rate, &mut stream("style"));
    let ground = Ground {
        robot: &setup.robot,
        scale: &scale,
        spread: setup.spread,
        period: plan.period,
        length: plan.period * plan.cycles as f64,
        rate: plan.rate,
    };
    let mut faults = draw_faults(kind, &ground, forced, &mut stream("fault"));
    let mut files = Files::default();
    let file = robot_file(&setup, &mut files);
    let mut records = Vec::new();
    let (mut days, mut noise) = (stream("days"), stream("noise"));
    for (k, motion) in plan.motions.iter().enumerate() {
        let record = simulate(&plant, &faults, motion, (&plan, plan.cycles), &mut days);
        files.add(0, format!("log-{}.csv", k + 1), csv(&style, &record, true, &[], &mut noise));
        records.push(record);
    }
    let held = simulate(&plant, &faults, &plan.heldout, (&plan, plan.heldout_cycles), &mut days);
    files.add(1, "heldout.csv".to_owned(), csv(&style, &held, true, &[], &mut noise));
    for k in 0..plan.baselines {
        if let Some(motion) = plan.motions.get(k % plan.motions.len().max(1)) {
            let record = simulate(&plant, &[], motion, (&plan, plan.cycles), &mut days);
            let text = csv(&style, &record, true, &[], &mut noise);
            files.add(2, format!("baseline-{}.csv", k + 1), text);
        }
    }
    let told =
        truth::information(&plant, &setup.spread, (&records, plan.period), &setup.in_file, &style);
    for (fault, nats) in faults.iter_mut().zip(told) {
        fault.truth.nats = nats;
    }
    Case {
        options: options(&setup, file, &plan, &files, &mut stream("options")),
        files: files.list,
        kind,
        effects: faults.into_iter().map(|fault| fault.truth).collect(),
        place: truth::place(n, &records),
        lines: Vec::new(),
        heldout: truth::levels(&plant, &setup.in_file, &held),
    }
}
