//! Torques of a log, logged or computed from currents.
//!
//! Phase currents give a space vector; its component along the rotor's torque axis is the current
//! except for the sign. Sign and scale follow from physics: friction dissipates power, and the
//! torques carry the weight.

use std::fmt::Write;

use crate::arm::dynamics::{Data, Load, rnea};
use crate::arm::robot::{MAX_DOF, Model};
use crate::learn::log::{Channel, Log, derivatives, signed, vectors};

use super::error::IdentifyError;

/// Number of rows that determine sign and scale.
const ROWS: usize = 3000;
/// Least correlation with the model that determines the sign.
const DECIDES: f64 = 0.3;
/// Standard deviation of the logarithm of a factor from gravity.
const DEVIATION: f64 = 0.02;
/// Factor within which measured and modelled torques count as alike.
const ALIKE: f64 = 3.0;
/// Largest logarithmic distance from a known factor.
const UNKNOWN: f64 = 0.12;

/// A frequent wrong factor of phase currents, its logarithmic prior and its description.
type Factor = (f64, f64, &'static str);

/// Torques of each joint and their source.
#[derive(Clone, Debug, PartialEq)]
pub struct Torques {
    /// By joint \[Nm\].
    pub tau: Vec<Vec<f64>>,
    /// Description of the source.
    pub origin: String,
    /// Notes for the user.
    pub notes: Vec<String>,
}

/// The torques of a log.
///
/// # Errors
/// The log has no torques, or the model lacks data for the currents.
pub fn torques(model: &Model, log: &Log) -> Result<Torques, IdentifyError> {
    let n = model.dof;
    let has = |channel: Channel| log.column(channel).is_some();
    if let Some(columns) = log.of_joints(Channel::Torque) {
        if has(Channel::Torque(n)) {
            return Err(IdentifyError::Joints { column: format!("tau{}", n + 1), joints: n });
        }
        let tau = columns.into_iter().map(<[f64]>::to_vec).collect();
        return Ok(Torques { tau, origin: "logged".into(), notes: Vec::new() });
    }
    if let Some(columns) = log.of_joints(Channel::Current) {
        let factors = per_ampere(model)?;
        let tau = columns.iter().zip(&factors).map(|(i, k)| i.iter().map(|i| i * k).collect());
        let origin = "motor currents (A rms) x torque constant x gear ratio".into();
        return Ok(Torques { tau: tau.collect(), origin, notes: Vec::new() });
    }
    let phase = |phase: usize| -> Option<Vec<&[f64]>> {
        (0..n).map(|joint| log.column(Channel::PhaseCurrent(joint, phase))).collect()
    };
    if let (Some(a), Some(b), Some(c)) = (phase(0), phase(1), phase(2)) {
        return of_phases(model, log, [a, b, c]);
    }
    let missing = |name: &str, channel: fn(usize) -> Channel| {
        let first = (0..n).find(|joint| !has(channel(*joint)));
        first.filter(|joint| *joint > 0).map(|joint| format!("{name}{}", joint + 1))
    };
    let column = missing("tau", Channel::Torque)
        .or_else(|| missing("i", Channel::Current))
        .or_else(|| missing("ia", |joint| Channel::PhaseCurrent(joint, 0)))
        .or_else(|| missing("ib", |joint| Channel::PhaseCurrent(joint, 1)))
        .or_else(|| missing("ic", |joint| Channel::PhaseCurrent(joint, 2)));
    Err(match column {
        Some(column) => IdentifyError::Column { column, joints: n },
        None => IdentifyError::NoTorque(n),
    })
}

/// Torque at the joint for a current of 1 A rms \[Nm/A\].
///
/// # Errors
/// The model has no torque constants.
pub fn per_ampere(model: &Model) -> Result<Vec<f64>, IdentifyError> {
    let motors = model.motors.as_ref();
    let constants = motors.and_then(|motors| motors.torque_constant.as_ref());
    match (motors, constants) {
        (Some(motors), Some(constants)) => {
            Ok(constants.iter().zip(&motors.ratio).map(|(k, n)| k * n).collect())
        }
        _ => Err(IdentifyError::NoConstants(model.name.clone())),
    }
}

fn of_phases(
    model: &Model,
    log: &Log,
    [a, b, c]: [Vec<&[f64]>; 3],
) -> Result<Torques, IdentifyError> {
    let n = model.dof;
    let per_ampere = per_ampere(model)?;
    let ratio = model.motors.as_ref().map_or(&[][..], |motors| &motors.ratio);
    let rough = Rough::new(model, log);
    let mut tau = Vec::with_capacity(n);
    let mut notes = Vec::new();
    for joint in 0..n {
        let all = vectors(a[joint], b[joint], c[joint]);
        let angle = motor_angle(model, log, joint, ratio[joint]);
        // Converts amplitude to rms: the torque constant is per A rms.
        let scale = per_ampere[joint] * std::f64::consts::FRAC_1_SQRT_2;
        let mut current = if let Some(found) = signed(&all, &angle) {
            let order = if found.pole_pairs < 0 { ", phases in reverse order" } else { "" };
            notes.push(format!(
                "joint {}: {} pole pairs{order}, {:.1} % of the current vector stands still \
                     from the rotor",
                joint + 1,
                found.pole_pairs.abs(),
                100.0 * found.coherence
            ));
            found.current
        } else {
            let lengths = all.re.iter().zip(&all.im).map(|(x, y)| x.hypot(*y));
            let lengths: Vec<f64> = lengths.collect();
            let Some(signs) = rough.signs(joint) else {
                return Err(IdentifyError::Sign(joint + 1));
            };
            notes.push(format!(
                "joint {}: the current vector does not turn with the rotor; its sign is that \
                     of the rough model, change by change",
                joint + 1
            ));
            by_segments(&lengths, &signs)
        };
        for value in &mut current {
            *value *= scale;
        }
        if rough.is_reversed(joint, &current) {
            for value in &mut current {
                *value = -*value;
            }
        }
        tau.push(current);
    }
    let (factor, said) = rough.factor(&tau);
    notes.push(said);
    for value in tau.iter_mut().flatten() {
        *value *= factor;
    }
    let mut origin = String::from("phase currents x 2/3 / sqrt(2) x torque constant x gear ratio");
    if factor != 1.0 {
        let _ = write!(origin, " x {factor:.4}");
    }
    Ok(Torques { tau, origin, notes })
}

/// Angle of a joint's motor \[rad\].
#[must_use]
pub(super) fn motor_angle(model: &Model, log: &Log, joint: usize, ratio: f64) -> Vec<f64> {
    let column = |joint: usize| log.column(Channel::Position(joint)).unwrap_or_default();
    let coupling = if joint == 5 { model.wrist.coupling } else { 0.0 };
    if coupling == 0.0 {
        return column(joint).iter().map(|q| ratio * q).collect();
    }
    column(5).iter().zip(column(4)).map(|(q6, q5)| ratio * (q6 + coupling * q5)).collect()
}

/// Joints, from 0, with motor torques: smaller than the others by their gear ratios.
#[must_use]
pub(super) fn motor_side(model: &Model, log: &Log, tau: &[Vec<f64>]) -> Vec<usize> {
    let (Some(motors), true) = (&model.motors, model.has_dynamics()) else { return Vec::new() };
    let rough = Rough::new(model, log);
    let Some([_, whole]) = &rough.tau else { return Vec::new() };
    let share = |joint: usize| {
        let measured = rough.at(&tau[joint]);
        let (own, both) =
            (product(&whole[joint], &whole[joint]), product(&whole[joint], &measured));
        let related = both * both > DECIDES * own * product(&measured, &measured);
        (own > 0.0 && related).then(|| both / own)
    };
    let shares: Vec<Option<f64>> = (0..model.dof).map(share).collect();
    let near = |share: f64| (1.0 / ALIKE..ALIKE).contains(&share);
    if 2 * shares.iter().flatten().filter(|share| near(**share)).count() < model.dof {
        return Vec::new();
    }
    let is_motor = |joint: &usize| {
        let ratio = motors.ratio[*joint];
        ratio > ALIKE * ALIKE && shares[*joint].is_some_and(|share| near(share * ratio))
    };
    (0..model.dof).filter(is_motor).collect()
}

fn product(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(a, b)| a * b).sum()
}

/// Torques of the model at a subset of the rows.
struct Rough {
    rows: Vec<usize>,
    /// Rates by joint.
    qd: Vec<Vec<f64>>,
    /// By joint, the torques of the rigid bodies, and those with friction; `None` without dynamics.
    tau: Option<[Vec<Vec<f64>>; 2]>,
    all: usize,
}

impl Rough {
    fn new(model: &Model, log: &Log) -> Rough {
        let n = model.dof;
        let t = log.time();
        let every = t.len().div_ceil(ROWS).max(1);
        let rows: Vec<usize> = (0..t.len()).step_by(every).collect();
        let of = |x: &[f64]| rows.iter().map(|i| x[*i]).collect::<Vec<f64>>();
        let thin = of(t);
        let column = |joint: usize| log.column(Channel::Position(joint)).unwrap_or_default();
        let q: Vec<Vec<f64>> = (0..n).map(|joint| of(column(joint))).collect();
        let rates: Vec<Vec<[f64; 2]>> = q
            .iter()
            .map(|q| derivatives(&thin, q).into_iter().map(Option::unwrap_or_default).collect())
            .collect();
        let order = |k: usize| -> Vec<Vec<f64>> {
            rates.iter().map(|of| of.iter().map(|at| at[k]).collect()).collect()
        };
        let (qd, qdd) = (order(0), order(1));
        let tau = model.has_dynamics().then(|| {
            let mut data = Data::new();
            let [mut rigid, mut whole] = [vec![Vec::new(); n], vec![Vec::new(); n]];
            for row in 0..rows.len() {
                let at = |series: &[Vec<f64>]| series.iter().map(|x| x[row]).collect::<Vec<f64>>();
                let torque: [f64; MAX_DOF] =
                    rnea(model, &mut data, &Load::none(), &at(&q), &at(&qd), &at(&qdd));
                let friction = crate::arm::dynamics::friction(model, &at(&qd), &torque);
                for joint in 0..n {
                    rigid[joint].push(torque[joint]);
                    whole[joint].push(torque[joint] + friction[joint]);
                }
            }
            [rigid, whole]
        });
        Rough { rows, qd, tau, all: t.len() }
    }

    fn at(&self, values: &[f64]) -> Vec<f64> {
        self.rows.iter().map(|i| values[*i]).collect()
    }

    /// Whether a joint's torque has the wrong sign: by its correlation with the model's or, if that
    /// is small, because friction would produce power.
    fn is_reversed(&self, joint: usize, tau: &[f64]) -> bool {
        let tau = self.at(tau);
        if let Some([_, whole]) = &self.tau {
            let expected = &whole[joint];
            let both = product(&tau, expected);
            let correlation =
                both / (product(&tau, &tau) * product(expected, expected)).sqrt().max(1e-300);
            if correlation.abs() > DECIDES {
                return correlation < 0.0;
            }
        }
        product(&tau, &self.qd[joint]) < 0.0
    }

    /// Sign of the model's torque at each row of the log.
    fn signs(&self, joint: usize) -> Option<Vec<f64>> {
        let [_, whole] = self.tau.as_ref()?;
        let mut signs = vec![0.0; self.all];
        for (k, pair) in self.rows.iter().enumerate() {
            let end = self.rows.get(k + 1).copied().unwrap_or(self.all);
            signs[*pair..end].fill(whole[joint][k]);
        }
        Some(signs)
    }

    /// The missing scale factor from gravity, and a sentence on it.
    fn factor(&self, tau: &[Vec<f64>]) -> (f64, String) {
        let Some([rigid, _]) = &self.tau else {
            return (1.0, "scale of the currents: no model to compare with gravity".into());
        };
        let (mut sum, mut weights) = (0.0, 0.0);
        let mut each = Vec::new();
        for (joint, expected) in rigid.iter().enumerate() {
            let measured = self.at(&tau[joint]);
            let Some((slope, sd)) = slope(&measured, expected, &self.qd[joint]) else { continue };
            if slope > 0.0 && slope > 5.0 * sd {
                let weight = expected.iter().map(|x| x * x).sum::<f64>();
                sum += weight * slope.ln();
                weights += weight;
                each.push((weight, slope));
            }
        }
        if weights == 0.0 {
            return (1.0, "scale of the currents: the motion has no gravity to tell it".into());
        }
        let needed = (-sum / weights).exp();
        let strongest = each.iter().map(|(weight, _)| *weight).fold(0.0, f64::max);
        let agree = each
            .iter()
            .filter(|(weight, _)| *weight > 0.1 * strongest)
            .all(|(_, slope)| (slope * needed).ln().abs() < 2.0 * UNKNOWN);
        let root = std::f64::consts::SQRT_2;
        let clarke: [Factor; 5] = [
            (1.0, 0.0, "none"),
            (2.0 / 3.0, -1.0, "2/3"),
            (1.5, -1.0, "1.5"),
            (1.5_f64.sqrt(), -1.0, "sqrt(3/2)"),
            (1.5_f64.sqrt().recip(), -1.0, "sqrt(2/3)"),
        ];
        let of_root = clarke.map(|(factor, prior, what)| (root * factor, 2.0 * prior, what));
        let all = clarke.iter().map(|f| (f, false)).chain(of_root.iter().map(|f| (f, true)));
        let score = |(f, p, _): &Factor| p - 0.5 * ((needed / f).ln() / DEVIATION).powi(2);
        let best = all.max_by(|a, b| score(a.0).total_cmp(&score(b.0)));
        let Some(((factor, _, what), peak)) = best else { return (1.0, String::new()) };
        if !agree || (needed / factor).ln().abs() > UNKNOWN {
            return (
                1.0,
                format!(
                    "scale of the currents: gravity asks for {needed:.3}, which is no known \
                     factor; left as it is"
                ),
            );
        }
        // Other known factors, with the error of the file's masses that each implies.
        let known = clarke.iter().chain(&of_root).map(|(other, ..)| *other);
        let others: Vec<String> = known
            .filter(|other| (other / factor).ln().abs() > f64::EPSILON)
            .filter(|other| (needed / other).ln().abs() < UNKNOWN)
            .map(|other| {
                let masses = 100.0 * ((needed / other).ln().abs()).exp_m1();
                format!("{other:.4} with masses {masses:.0} % off")
            })
            .collect();
        let doubt = if others.is_empty() {
            String::new()
        } else {
            format!(
                "; not surely: it would be {}; a known payload, or the factor of the recorder, \
                 tells",
                others.join(", ")
            )
        };
        let per = if peak { ", torque constant per A of amplitude" } else { "" };
        (
            *factor,
            format!(
                "scale of the currents: gravity asks for {needed:.3}; taken as {factor:.4} \
                 (factor of the space vector: {what}{per}){doubt}"
            ),
        )
    }
}

/// Regression coefficient of `measured` on `expected`, with friction and an offset as further
/// regressors, and its standard deviation.
fn slope(measured: &[f64], expected: &[f64], qd: &[f64]) -> Option<(f64, f64)> {
    let largest = qd.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let mut normal = nalgebra::Matrix4::<f64>::zeros();
    let mut right = nalgebra::Vector4::<f64>::zeros();
    let (mut squares, mut count) = (0.0, 0.0);
    for ((y, x), rate) in measured.iter().zip(expected).zip(qd) {
        if rate.abs() <= 0.02 * largest {
            continue;
        }
        let row = nalgebra::Vector4::new(*x, rate.signum(), *rate, 1.0);
        normal += row * row.transpose();
        right += row * *y;
        squares += y * y;
        count += 1.0;
    }
    let inverse = normal.try_inverse()?;
    let solution = inverse * right;
    let left = (squares - solution.dot(&right)).max(0.0) / (count - 4.0_f64).max(1.0);
    Some((solution[0], (left * inverse[(0, 0)]).sqrt()))
}

/// The lengths with the sign of a rough torque; the sign changes only where the length is small.
fn by_segments(lengths: &[f64], rough: &[f64]) -> Vec<f64> {
    let mean = lengths.iter().sum::<f64>() / lengths.len().max(1) as f64;
    let mut out = Vec::with_capacity(lengths.len());
    let mut begin = 0;
    for i in 1..=lengths.len() {
        let minimum = i < lengths.len().saturating_sub(1)
            && lengths[i] <= lengths[i - 1]
            && lengths[i] <= lengths[i + 1]
            && lengths[i] < 0.2 * mean;
        if minimum || i == lengths.len() {
            let vote: f64 = (begin..i).map(|k| lengths[k] * rough[k]).sum();
            let sign = if vote < 0.0 { -1.0 } else { 1.0 };
            out.extend(lengths[begin..i].iter().map(|length| sign * length));
            begin = i;
        }
    }
    out
}
