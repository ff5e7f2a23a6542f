//! Easy and hard paths from a fixed seed, as runs of small programs on two robots.

use std::fmt::Write;

use joulepath::arm::dynamics::{Data, torque};
use joulepath::arm::kinematics::{fk, ik_near};
use joulepath::arm::robot::{Model, from_toml};
use joulepath::retime::energy::EnergyParts;
use joulepath::retime::motion::timeline::{Run, What};
use joulepath::retime::motion::{Options, Simulation};
use joulepath::retime::optimize::cost::Cost;
use joulepath::retime::optimize::freedom::Freedom;
use joulepath::retime::optimize::retime::Task;
use joulepath::retime::path::joint_path::{DOF, JointPath, Joints};
use nalgebra::{Isometry3, Translation3, Vector3};

use crate::support::{Random, irb1600, program, simulated};

const NONE: &str = "[9E9,9E9,9E9,9E9,9E9,9E9]";
/// The geometry of another arm with enlarged and heavier bodies of the IRB1600: the catalogue has
/// dynamics for one robot only.
const LARGE: &str = include_str!("large.toml");
/// Torque limit over the weight and dry friction on the path, for tight torques.
const TIGHT: f64 = 1.12;
/// Largest number of draws for a path.
const DRAWS: usize = 200;

/// Kind of difficulty of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// A line near the wrist singularity.
    NearSingular,
    /// Short movements with corner zones.
    Blended,
    /// Exactly or nearly repeated way points.
    Doubled,
    /// One or two joints move forth and back.
    Blocked,
    /// Little torque beyond the holding torque.
    TightTorque,
    /// One joint movement.
    EasyJoint,
    /// One line far from singularities.
    EasyLine,
    /// Two joint movements with a wide zone.
    EasyBlend,
}

pub(crate) const HARD: [Kind; 5] =
    [Kind::NearSingular, Kind::Blended, Kind::Doubled, Kind::Blocked, Kind::TightTorque];
pub(crate) const EASY: [Kind; 3] = [Kind::EasyJoint, Kind::EasyLine, Kind::EasyBlend];

/// A path on a robot.
pub(crate) struct Case {
    pub(crate) name: String,
    pub(crate) kind: Kind,
    pub(crate) model: Model,
    pub(crate) simulation: Simulation,
}

impl Case {
    /// The last run of the program.
    pub(crate) fn run(&self) -> &Run {
        let mut events = self.simulation.events.iter().rev();
        let run = events.find_map(|event| match &event.what {
            What::Run(run) => Some(&**run),
            _ => None,
        });
        run.unwrap()
    }

    /// Its path, if the robot does not stop on it.
    pub(crate) fn path(&self) -> Option<&JointPath> {
        match self.run().motions.as_slice() {
            [(_, joulepath::retime::motion::timed::TimedMotion::Path(path, _))] => Some(path),
            _ => None,
        }
    }

    /// The task of a stream for its last run.
    pub(crate) fn task<'a>(&'a self, freedom: &'a Freedom) -> Task<'a> {
        Task {
            model: &self.model,
            run: self.run(),
            energy_before: EnergyParts::default(),
            spacing_s: 0.05,
            closest_s: 0.04,
            freedom,
            cost: Cost::Electrical,
        }
    }
}

pub(crate) fn robots() -> [Model; 2] {
    [irb1600(), from_toml("large.toml", LARGE).unwrap()]
}

/// `count` paths with alternating kinds and robots.
pub(crate) fn cases(kinds: &[Kind], count: usize) -> Vec<Case> {
    let robots = robots();
    let mut random = Random(7);
    (0..count)
        .map(|i| {
            let kind = kinds[i % kinds.len()];
            let model = &robots[i / kinds.len() % robots.len()];
            let name = format!("{kind:?} {i} on {}", model.name);
            let case = (0..DRAWS).find_map(|_| draw(&mut random, kind, model, &name));
            case.unwrap_or_else(|| panic!("no path {name}"))
        })
        .collect()
}

fn uniform(random: &mut Random, lo: f64, hi: f64) -> f64 {
    lo + (hi - lo) * random.below(1 << 30) as f64 / f64::from(1 << 30)
}

/// Joint angles in the middle of the ranges.
fn joints(random: &mut Random, model: &Model) -> Joints {
    let mut q = std::array::from_fn(|j| {
        let [lo, hi] = model.limits.position[j];
        let half = 0.5 * (hi - lo).min(3.0);
        let middle = (0.5 * (lo + hi)).clamp(-0.3, 0.3);
        middle + uniform(random, -0.6, 0.6) * half
    });
    q[4] = uniform(random, 0.5, 1.2);
    q
}

fn moved(random: &mut Random, q: &Joints, size: f64) -> Joints {
    std::array::from_fn(|j| q[j] + uniform(random, -size, size))
}

fn degrees(q: &Joints) -> String {
    let all: Vec<String> = q.iter().map(|x| format!("{:.6}", x.to_degrees())).collect();
    format!("[[{}],{NONE}]", all.join(","))
}

fn target(pose: &Isometry3<f64>) -> String {
    let (p, r) = (pose.translation.vector * 1e3, pose.rotation.quaternion());
    format!(
        "[[{:.5},{:.5},{:.5}],[{:.8},{:.8},{:.8},{:.8}],[0,0,0,0],{NONE}]",
        p.x, p.y, p.z, r.w, r.i, r.j, r.k
    )
}

fn step(random: &mut Random, size: f64) -> Translation3<f64> {
    let mut one = || uniform(random, -1.0, 1.0);
    Translation3::from(Vector3::new(one(), one(), one()).normalize() * size)
}

const ZONES: [&str; 5] = ["z1", "z5", "z10", "z20", "z50"];
const SPEEDS: [&str; 4] = ["v500", "v1000", "v2000", "v7000"];

fn draw(random: &mut Random, kind: Kind, model: &Model, name: &str) -> Option<Case> {
    let mut start = joints(random, model);
    let mut body = String::new();
    let speed = SPEEDS[random.below(SPEEDS.len())];
    let absolute = |body: &mut String, q: &Joints, zone: &str| {
        let _ = writeln!(body, "MoveAbsJ {},{speed},{zone},tool0;", degrees(q));
    };
    match kind {
        Kind::NearSingular => {
            start[4] = uniform(random, 0.04, 0.15) * if random.below(2) == 0 { 1.0 } else { -1.0 };
            let middle = fk(model, &start);
            let length = uniform(random, 0.05, 0.2);
            let way = step(random, length);
            let begin = ik_near(model, &(way.inverse() * middle), &start).ok()?;
            start = begin;
            let _ = writeln!(body, "MoveL {},{speed},fine,tool0;", target(&(way * middle)));
        }
        Kind::Blended => {
            let mut q = start;
            let legs = 3 + random.below(3);
            for leg in 0..legs {
                q = moved(random, &q, 0.25);
                let zone = if leg + 1 == legs { "fine" } else { ZONES[random.below(ZONES.len())] };
                let word = if random.below(2) == 0 { "MoveJ" } else { "MoveL" };
                let _ = writeln!(body, "{word} {},{speed},{zone},tool0;", target(&fk(model, &q)));
            }
        }
        Kind::Doubled => {
            let mut q = start;
            for leg in 0..3 {
                q = moved(random, &q, 0.3);
                let apart = if random.below(2) == 0 { 0.0 } else { 2e-5 };
                let nearly = moved(random, &q, apart);
                let zone = ZONES[random.below(ZONES.len())];
                absolute(&mut body, &q, zone);
                absolute(&mut body, &nearly, if leg == 2 { "fine" } else { zone });
            }
        }
        Kind::Blocked => {
            let mut q = start;
            let (a, b) = (random.below(DOF), random.below(DOF));
            q[a] += uniform(random, 0.1, 0.5);
            absolute(&mut body, &q, ZONES[random.below(ZONES.len())]);
            q[b] -= uniform(random, 0.1, 0.5);
            absolute(&mut body, &q, ZONES[random.below(ZONES.len())]);
            q[a] -= uniform(random, 0.05, 0.2);
            absolute(&mut body, &q, "fine");
        }
        Kind::TightTorque | Kind::EasyJoint => {
            let size = uniform(random, 0.3, 1.0);
            absolute(&mut body, &moved(random, &start, size), "fine");
        }
        Kind::EasyLine => {
            let length = uniform(random, 0.15, 0.4);
            let way = step(random, length);
            let _ =
                writeln!(body, "MoveL {},{speed},fine,tool0;", target(&(way * fk(model, &start))));
        }
        Kind::EasyBlend => {
            let q = moved(random, &start, 0.5);
            absolute(&mut body, &q, "z50");
            absolute(&mut body, &moved(random, &q, 0.5), "fine");
        }
    }
    let text = format!(
        "MODULE M\nPROC main()\nConfL\\Off;\nConfJ\\Off;\nMoveAbsJ {},v1000,fine,tool0;\n\
         {body}ENDPROC\nENDMODULE\n",
        degrees(&start)
    );
    let mut model = model.clone();
    let simulation = simulated(&model, &program(text), &Options::default());
    let name = name.to_owned();
    let case = Case { name, kind, model: model.clone(), simulation };
    let usable = case.run().problem.is_none() && case.simulation.unresolved.is_empty();
    if !usable || case.path().is_none() {
        return None;
    }
    if kind == Kind::EasyLine {
        let smooth = |q1: &Joints| q1.iter().all(|rate| rate.abs() < 8.0);
        let path = case.path()?;
        let steps = (0..=50).map(|i| path.eval(path.length() * f64::from(i) / 50.0));
        if !steps.into_iter().all(|point| smooth(&point.q1)) {
            return None;
        }
    }
    if kind == Kind::TightTorque {
        tighten(&mut model, case.path()?, case.run());
    }
    Some(Case { model, ..case })
}

/// Reduces the torque limits to slightly more than weight and dry friction on the path.
fn tighten(model: &mut Model, path: &JointPath, run: &Run) {
    let mut data = Data::new();
    let mut most = [0.0_f64; DOF];
    for i in 0..=200 {
        let q = path.eval(path.length() * f64::from(i) / 200.0).q;
        let rest = [0.0; DOF];
        let weight = torque(model, &mut data, &run.load, &q, &rest, &rest).rigid;
        for j in 0..DOF {
            most[j] = most[j].max(weight[j].abs() + model.friction.coulomb[j]);
        }
    }
    if let Some(limits) = &mut model.limits.torque {
        for (limit, most) in limits.iter_mut().zip(most) {
            *limit = limit.min(TIGHT * most);
        }
    }
}
