//! Random faults that are in no library.

use super::body::BodyLaw;
use super::draw_body::gripped;
use super::fault::{Act, Fault, Place};
use super::friction::window;
use super::law::{Memory, MotorLaw, Seen};
use super::signal::{SignalForm, SignalLaw};
use crate::examine::worlds::model::V3;
use crate::examine::worlds::random::{Rng, hashed};

/// Length of the slots of a rattle \[s\]: wide band for every sampling rate.
const RATTLE: f64 = 0.008;

/// A law with one size.
fn law(size: f64, law: impl Fn(&Seen, f64, &mut Memory) -> f64 + 'static) -> MotorLaw {
    let told = |[a, _]: [f64; 2]| vec![("size", a, false)];
    MotorLaw::new([size, 0.0], told, move |x, [a, _], memory| law(x, a, memory))
}

/// A fault that is in no library; its size is a usual one, to be scaled.
pub(super) fn draw(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let joint = rng.below(arm.axes());
    let others: Vec<usize> = (0..arm.axes()).filter(|k| *k != joint).collect();
    let other = rng.pick(&others);
    let (coulomb, usual) = (arm.coulomb[joint], arm.usual[joint]);
    let friction = |law: MotorLaw| Act::Friction(joint, law);
    let report = |law: MotorLaw| Act::Report(joint, law);
    let phase = arm.middle[other] + 0.5 * arm.span[other] * rng.between(-1.0, 1.0);
    let one = vec![joint];
    let mut within = None;
    let (name, joints, act, bounds) = match rng.below(12) {
        0 => {
            let act = friction(law(0.8 * coulomb, move |x, a, _| {
                a * (0.5 + 0.5 * (3.0 * (x.now.q[other] - phase).cos()).tanh()) * x.sign
            }));
            ("friction over another joint's angle", one, act, [0.1, 6.0])
        }
        1 => {
            // The level falls as the fault grows; the corner has the order 8.
            let level = 2.0 * usual;
            let act = report(law(1.0, move |x, e, _| {
                x.torque / (1.0 + (x.torque * e / level).powi(8)).powf(0.125)
            }));
            ("clipped output", one, act, [0.5, 4.0])
        }
        2 => {
            let (centre, seed) = (arm.middle[joint], rng.bits());
            let act = report(law(0.15 * usual, move |x, e, _| {
                let here = (4.0 * ((x.q - centre).cos() - 1.0)).exp();
                let noise = hashed(seed, (x.now.time / RATTLE) as u64);
                x.torque + e * here * noise * (x.w / 0.02).tanh().abs()
            }));
            ("rattle over a part of the angles", one, act, [0.2, 6.0])
        }
        3 => {
            let (frequency, damping) = (rng.between(4.0, 14.0), rng.between(0.03, 0.1));
            let form = SignalForm::Mode { frequency, damping };
            let law = SignalLaw { size: 0.2, only: Some(joint), form };
            ("flexible mode of the structure", one, Act::Signal(law), [0.1, 8.0])
        }
        4 => {
            let link = rng.whole(1, 3);
            let rail =
                V3::from_fn(|_, _| rng.spread(1.0)).try_normalize(1e-6).unwrap_or_else(V3::x);
            let rail = rail * (0.3 * arm.payload.powf(0.27));
            let (mass, from) = (0.3 * arm.payload, arm.bodies[link].com);
            let law = BodyLaw::Sliding { link, mass, from, rail };
            ("mass that slides", vec![link], Act::Body(law), [0.1, 8.0])
        }
        5 => {
            let (slot, seed) = (rng.log_between(0.3, 3.0), rng.bits());
            let act = friction(law(0.8 * coulomb, move |x, a, _| {
                if hashed(seed, (x.now.time / slot) as u64) > 0.0 { a * x.sign } else { 0.0 }
            }));
            ("friction that switches at random", one, act, [0.1, 6.0])
        }
        6 => {
            let reference = 0.5 * arm.acceleration[joint];
            let act = friction(law(0.4 * usual, move |x, a, _| {
                a * (x.a / reference).clamp(-1.6, 1.6).powi(3)
            }));
            ("torque of the acceleration cubed", one, act, [0.1, 4.0])
        }
        7 => {
            let [from, to] = window(place, rng);
            let act = Act::Body(BodyLaw::Gripped { body: gripped(place, 0.3, rng), from, to });
            within = Some([from, to]);
            ("payload in a part of the period", Vec::new(), act, [0.05, 4.0])
        }
        8 => {
            let act = Act::Coupling { from: 1, into: 2, ratio: -rng.between(0.3, 1.0) };
            ("parallelogram: motor 3 turns with axis 2", vec![1, 2], act, [0.2, 2.0])
        }
        9 => {
            // Hollow wrists: the tube of axis 5 turns with axis 4, and the drive does not know it.
            let act = Act::Coupling { from: 3, into: 4, ratio: rng.sign() * rng.between(0.3, 1.0) };
            ("motor 5 turns with axis 4", vec![3, 4], act, [0.2, 2.0])
        }
        10 => {
            let squared = 0.09 * arm.speed[joint] * arm.speed[other];
            let act = friction(law(0.1 * usual, move |x, a, _| a * x.w * x.now.v[other] / squared));
            ("gyroscopic torque of a spinning tool", one, act, [0.1, 10.0])
        }
        _ => {
            let ratio = usual / arm.usual[other].max(1e-6);
            let act = report(law(0.1 * ratio, move |x, e, _| x.torque + e * x.now.load[other]));
            ("crosstalk of current sensors", one, act, [0.1, 6.0])
        }
    };
    Fault { window: within, ..Fault::new("outside", name, &joints, vec![act], bounds) }
}
