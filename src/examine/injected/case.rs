//! A case: parts of a real log, and the effect that is added to two of them.

use std::fmt::Write as _;

use rayon::prelude::*;

use super::arm::Arm;
use super::catalogue::{EFFECTS, Entry};
use super::cut::Cut;
use super::error::InjectError;
use super::law::{Law, shares};
use super::motion::{Joints, rms};
use super::visible::nats;
use crate::arm::robot::{MAX_DOF, to_toml};
use crate::examine::blind::random::Random;
use crate::examine::blind::{Case, HeldOut, Kind, Label, TrueParameter, Truth};

/// One of this many successive cases is healthy.
const GROUP: usize = 5;
/// Least and largest rms torque of an effect over the measured one, at its largest joint.
const SHARES: [f64; 2] = [0.03, 0.15];
/// Accepted difference from the drawn share.
const NEAR: f64 = 0.005;
/// Steps of the search for a size.
const STEPS: usize = 40;
/// Least nats of an effect: twice as many as the grades ask for.
const VISIBLE_NATS: f64 = 20.0;
/// Cuts that are tried for an effect, and laws at a joint.
const CUTS: usize = 4;
const TRIES: usize = 4;

/// Cases of some robots.
pub struct Cases {
    arms: Vec<Arm>,
    seed: u64,
    /// The effects that can be seen, and the numbers of the robots that show them.
    seen: Vec<(Entry, Vec<usize>)>,
}

impl Cases {
    /// The cases of a seed.
    ///
    /// # Errors
    /// No robot, a log without three parts that move all joints, or no visible effect.
    pub fn new(arms: Vec<Arm>, seed: u64) -> Result<Cases, InjectError> {
        if arms.is_empty() {
            return Err(InjectError::NoLogs);
        }
        for arm in &arms {
            cut(arm, &mut Random::new(seed, 0, "cut"))?;
        }
        let shows = |entry: &Entry| {
            let shows = |k: &usize| {
                drawn(&arms[*k], entry, &mut Random::new(seed, *k as u64, entry.id)).is_some()
            };
            (*entry, (0..arms.len()).filter(shows).collect::<Vec<usize>>())
        };
        let mut seen: Vec<(Entry, Vec<usize>)> = EFFECTS.par_iter().map(shows).collect();
        seen.retain(|(_, robots)| !robots.is_empty());
        if seen.is_empty() { Err(InjectError::Invisible) } else { Ok(Cases { arms, seed, seen }) }
    }

    /// The case with a number, from 1: one in five is healthy, the others have one effect each. No
    /// effect is in another case before all effects that can be seen are in one.
    ///
    /// # Errors
    /// No visible effect in the case's parts of the logs.
    pub fn case(&self, number: usize) -> Result<Case, InjectError> {
        let stream = |purpose: &str| Random::new(self.seed, number as u64, purpose);
        let (group, within) = ((number - 1) / GROUP, (number - 1) % GROUP);
        let healthy = Random::new(self.seed, group as u64, "healthy").below(GROUP);
        if within == healthy {
            let arm = &self.arms[group % self.arms.len()];
            return Ok(sealed(arm, &cut(arm, &mut stream("cut"))?, None, &stream("salt"), number));
        }
        let place = (GROUP - 1) * group + within - usize::from(within > healthy);
        let mut random = stream("effect");
        for (entry, robot) in self.order(place) {
            let arm = &self.arms[robot];
            if let Some((cut, found)) = drawn(arm, &entry, &mut random) {
                return Ok(sealed(arm, &cut, Some(found), &stream("salt"), number));
            }
        }
        Err(InjectError::Invisible)
    }

    /// Effects and robots for the effect case with this number, from 0, in the order in which they
    /// are tried: each round of all effects has its own order, and each effect the robot that has
    /// had fewest cases.
    fn order(&self, place: usize) -> Vec<(Entry, usize)> {
        let rounds = place / self.seen.len() + 2;
        let mut all: Vec<&(Entry, Vec<usize>)> = Vec::new();
        for round in 0..rounds {
            let mut order: Vec<&(Entry, Vec<usize>)> = self.seen.iter().collect();
            Random::new(self.seed, round as u64, "order").shuffle(&mut order);
            all.extend(order);
        }
        let mut cases = vec![0_usize; self.arms.len()];
        let mut tried = Vec::new();
        for (at, (entry, robots)) in all.iter().enumerate().take(place + self.seen.len()) {
            let mut robots = robots.clone();
            robots.sort_by_key(|robot| cases[*robot]);
            cases[robots[0]] += 1;
            if at >= place {
                tried.extend(robots.into_iter().map(|robot| (*entry, robot)));
            }
        }
        tried
    }
}

fn cut(arm: &Arm, random: &mut Random) -> Result<Cut, InjectError> {
    let short = || InjectError::Short { robot: arm.model.name.clone() };
    Cut::drawn(arm, random).ok_or_else(short)
}

/// What an effect adds to a log.
struct Added {
    truth: Truth,
    /// At each row \[Nm\].
    torques: Vec<Joints>,
}

/// A cut of the log and an effect that can be seen in it; `None` if there is none among several.
fn drawn(arm: &Arm, entry: &Entry, random: &mut Random) -> Option<(Cut, Added)> {
    (0..CUTS).find_map(|_| {
        let cut = Cut::drawn(arm, random)?;
        let found = visible(arm, &cut, entry, random)?;
        Some((cut, found))
    })
}

/// An effect at a joint where it can be seen; `None` if there is no such joint.
fn visible(arm: &Arm, cut: &Cut, entry: &Entry, random: &mut Random) -> Option<Added> {
    let mut joints: Vec<usize> = (0..arm.dof()).collect();
    random.shuffle(&mut joints);
    let rows: Vec<usize> = cut.log.iter().flatten().copied().collect();
    for joint in joints {
        for _ in 0..TRIES {
            let asked = random.unit();
            let Some(law) = (entry.draw)(arm, joint, random) else { continue };
            let Some((size, torques)) = sized(arm, &rows, &law, asked) else { continue };
            let nats = nats(arm, &cut.log, &torques);
            if nats < VISIBLE_NATS {
                continue;
            }
            let mut truth = Truth { nats, ..law.truth(size) };
            let of_joints = shares(arm, &rows, &torques).into_iter().zip(1..);
            truth.parameters.extend(of_joints.map(|(share, joint)| TrueParameter {
                name: "rms_share".into(),
                joint: Some(joint),
                value: share,
                graded: false,
            }));
            return Some(Added { truth, torques });
        }
    }
    None
}

/// A usual size of an effect and its torques; `None` if no usual size has a share within the bounds.
/// The place `asked` is from 0, the least possible share at the joints of the effect, to 1.
fn sized(arm: &Arm, rows: &[usize], law: &Law<'_>, asked: f64) -> Option<(f64, Vec<Joints>)> {
    let share = |size: f64| law.share(&shares(arm, rows, &law.torques(size)));
    let [least, most] = law.sizes.map(share);
    let (least, most) = (least.max(SHARES[0]), most.min(SHARES[1]));
    if least >= most {
        return None;
    }
    let asked = least * (most / least).powf(asked);
    let [mut low, mut high] = law.sizes.map(f64::ln);
    for _ in 0..STEPS {
        let middle = f64::midpoint(low, high);
        let found = share(middle.exp());
        if (found / asked - 1.0).abs() <= NEAR {
            (low, high) = (middle, middle);
            break;
        }
        if found < asked { low = middle } else { high = middle }
    }
    let size = f64::midpoint(low, high).exp();
    let torques = law.torques(size);
    let found = shares(arm, rows, &torques);
    let largest = found.iter().copied().fold(0.0, f64::max);
    (law.share(&found) >= SHARES[0] && largest <= SHARES[1] * (1.0 + NEAR))
        .then_some((size, torques))
}

/// The case of an effect, or a healthy one.
fn sealed(arm: &Arm, cut: &Cut, added: Option<Added>, salt: &Random, number: usize) -> Case {
    let name = format!("case-{number:04}");
    let nothing = vec![[0.0; MAX_DOF]; arm.tau.len()];
    let torques = added.as_ref().map_or(&nothing, |added| &added.torques);
    let mut files = vec![("nominal.toml".to_owned(), to_toml(&arm.model))];
    for (part, blocks, torques) in [
        ("log", &cut.log, torques),
        ("heldout", &cut.heldout, torques),
        ("baseline", &cut.baseline, &nothing),
    ] {
        for (k, rows) in blocks.iter().enumerate() {
            files.push((format!("{part}-{}.csv", k + 1), csv(arm, rows, torques)));
        }
    }
    files.push(("case.json".into(), "{\"trust\":\"commissioned\"}\n".into()));
    let rows: Vec<usize> = cut.log.iter().flatten().copied().collect();
    let (place, share) = largest_share(&shares(arm, &rows, torques));
    let label = Label {
        case: name.clone(),
        kind: if added.is_some() { Kind::One } else { Kind::Healthy },
        trust: "commissioned".into(),
        place,
        share,
        lines: Vec::new(),
        heldout: held_out(arm, &cut.heldout, torques),
        effects: added.into_iter().map(|added| added.truth).collect(),
    };
    let mut draws = salt.clone();
    let salt = format!("{:016x}{:016x}", draws.bits(), draws.bits());
    Case { name, files, label, salt }
}

/// The log of some rows with added torques.
fn csv(arm: &Arm, rows: &[usize], torques: &[Joints]) -> String {
    let n = arm.dof();
    let mut text = String::from("t");
    let quantities: &[&str] = if arm.rates.is_some() { &["q", "qd", "tau"] } else { &["q", "tau"] };
    for name in quantities {
        for joint in 1..=n {
            let _ = write!(text, ",{name}{joint}");
        }
    }
    text.push('\n');
    for &row in rows {
        let tau: Joints = std::array::from_fn(|joint| arm.tau[row][joint] + torques[row][joint]);
        let rates = arm.rates.as_ref().map(|rates| &rates[row]);
        let _ = write!(text, "{}", arm.motion.t[row]);
        for values in [Some(&arm.motion.q[row]), rates].into_iter().flatten() {
            values[..n].iter().for_each(|value| {
                let _ = write!(text, ",{value}");
            });
        }
        for tau in &tau[..n] {
            let _ = write!(text, ",{tau:.6}");
        }
        text.push('\n');
    }
    text
}

/// The joint, from 1, with the largest square of its share, and the part that it has of the sum.
fn largest_share(shares: &[f64]) -> (Option<usize>, Option<f64>) {
    let sum: f64 = shares.iter().map(|share| share * share).sum();
    let largest = shares.iter().zip(1..).max_by(|a, b| a.0.total_cmp(b.0));
    match largest {
        Some((share, joint)) if sum > 0.0 => (Some(joint), Some(share * share / sum)),
        _ => (None, None),
    }
}

/// Rms torques of the held-out part.
fn held_out(arm: &Arm, blocks: &[Vec<usize>], torques: &[Joints]) -> Vec<HeldOut> {
    let of = |joint: usize, value: &dyn Fn(usize) -> f64| {
        let rows = blocks.iter().flatten().copied();
        rms(rows.filter(|row| !arm.rests(*row, joint)).map(value))
    };
    (0..arm.dof())
        .map(|j| HeldOut {
            joint: j + 1,
            torque: of(j, &|row| arm.tau[row][j] + torques[row][j]),
            model: of(j, &|row| arm.residual[row][j] + torques[row][j]),
            effects: of(j, &|row| torques[row][j]),
            left: of(j, &|row| arm.residual[row][j]),
        })
        .collect()
}
