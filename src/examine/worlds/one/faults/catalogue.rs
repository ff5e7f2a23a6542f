//! Which faults there are, at which joints they make sense, and how one of a wanted size is drawn.

use super::{
    Builder, Context, Fault, Order, bodies, forces, friction, gears, outside, readings, springs,
};
use crate::examine::worlds::random::Rng;

/// Where an effect acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::examine::worlds::one) enum Place {
    /// At one to three joints.
    Joints,
    /// At one to three joints, not at the first: gravity does not show there.
    Weighed,
    /// At one to three links, not at the first: only one of its parameters shows.
    Bodies,
    Single,
    /// At axis 2 or 3: balancers carry weight.
    Balanced,
    /// At one to three joints but axes 2 and 3: hoses turn with axis 1 and the wrist.
    Dressed,
    /// At one to three joints, sometimes at all.
    Gains,
    /// On the whole robot.
    Robot,
    /// Six axes only, whole robot.
    Wrist,
}

/// An effect.
pub(in crate::examine::worlds::one) struct Entry {
    /// Its id.
    pub(in crate::examine::worlds::one) id: &'static str,
    /// Number of forms.
    pub(in crate::examine::worlds::one) forms: usize,
    /// Where it acts.
    pub(in crate::examine::worlds::one) place: Place,
    /// How it is built.
    pub(in crate::examine::worlds::one) build: Builder,
}

const fn entry(id: &'static str, forms: usize, place: Place, build: Builder) -> Entry {
    Entry { id, forms, place, build }
}

/// Effects of torques.
pub(in crate::examine::worlds::one) static TORQUES: [Entry; 30] = [
    entry("payload", 3, Place::Robot, bodies::payload),
    entry("link_parameters", 3, Place::Bodies, bodies::links),
    entry("rotor_inertia", 2, Place::Joints, gears::rotor),
    entry("gravity_spring", 3, Place::Balanced, springs::gravity),
    entry("base_tilt", 3, Place::Robot, bodies::tilt),
    entry("encoder_offset", 3, Place::Weighed, bodies::encoder),
    entry("cable", 3, Place::Dressed, springs::cable),
    entry("friction_level", 3, Place::Joints, friction::level),
    entry("torque_offset", 3, Place::Joints, springs::offset),
    entry("stribeck", 3, Place::Joints, friction::stribeck),
    entry("nonlinear_viscous", 3, Place::Joints, friction::viscous),
    entry("viscous_asymmetry", 2, Place::Joints, friction::viscous_asymmetry),
    entry("load_friction", 3, Place::Joints, friction::load),
    entry("gear_efficiency", 2, Place::Joints, friction::efficiency),
    entry("warm_up", 3, Place::Joints, friction::warm_up),
    entry("position_friction", 3, Place::Joints, friction::position),
    entry("presliding", 3, Place::Joints, friction::presliding),
    entry("backlash", 3, Place::Joints, gears::backlash),
    entry("elasticity", 3, Place::Joints, gears::elasticity),
    entry("ripple", 3, Place::Joints, gears::ripple),
    entry("wrist_coupling", 2, Place::Wrist, gears::wrist),
    entry("brake_drag", 3, Place::Joints, friction::brake),
    entry("torque_constant", 3, Place::Gains, readings::constant),
    entry("current_saturation", 3, Place::Joints, readings::saturation),
    entry("flux_weakening", 3, Place::Joints, readings::weakening),
    entry("time_delay", 2, Place::Robot, readings::delay),
    entry("filter_lag", 3, Place::Robot, readings::filter),
    entry("current_sign", 2, Place::Single, readings::sign),
    entry("contact", 3, Place::Robot, forces::contact),
    entry("apparent_torque", 2, Place::Joints, forces::apparent),
];

/// Faults outside the library.
static OUTSIDE: Entry = entry("outside", outside::COUNT, Place::Joints, outside::outside);

/// A fault that is drawn but not yet built.
#[derive(Clone)]
pub(in crate::examine::worlds::one) struct Choice {
    /// Effect.
    pub(in crate::examine::worlds::one) entry: &'static Entry,
    /// Joints, from 0.
    pub(in crate::examine::worlds::one) joints: Vec<usize>,
    /// Number of the form.
    pub(in crate::examine::worlds::one) form: usize,
    /// Its random stream.
    pub(in crate::examine::worlds::one) rng: Rng,
}

fn joints(place: Place, count: usize, rng: &mut Rng) -> Vec<usize> {
    match place {
        Place::Robot | Place::Wrist => return Vec::new(),
        Place::Gains if rng.chance(0.15) => return (0..count).collect(),
        _ => {}
    }
    let many = if matches!(place, Place::Single | Place::Balanced) {
        1
    } else {
        1 + rng.weighted(&[0.6, 0.25, 0.15])
    };
    let first = usize::from(matches!(place, Place::Weighed | Place::Bodies));
    // The last axis seldom carries weight.
    let end = if place == Place::Weighed { count - 1 } else { count };
    let mut out: Vec<usize> = Vec::new();
    while out.len() < many {
        let j = first + rng.below(end - first);
        let carries = j == 1 || j == 2;
        let suits = match place {
            Place::Balanced => carries,
            Place::Dressed => !carries,
            _ => true,
        };
        if suits && !out.contains(&j) {
            out.push(j);
        }
    }
    out.sort_unstable();
    out
}

fn choice(entry: &'static Entry, count: usize, rng: &mut Rng) -> Choice {
    let joints = joints(entry.place, count, rng);
    let form = rng.below(entry.forms);
    let mut own = rng.clone();
    own.bits();
    rng.bits();
    rng.bits();
    Choice { entry, joints, form, rng: own }
}

/// A random effect of torques.
pub(in crate::examine::worlds::one) fn torque(count: usize, rng: &mut Rng) -> Choice {
    loop {
        let entry = &TORQUES[rng.below(TORQUES.len())];
        if entry.place != Place::Wrist || count == 6 {
            return choice(entry, count, rng);
        }
    }
}

/// The effect of an id at random joints.
pub(in crate::examine::worlds::one) fn named(id: &str, count: usize, rng: &mut Rng) -> Choice {
    let entry = TORQUES.iter().find(|e| e.id == id).unwrap_or(&TORQUES[0]);
    choice(entry, count, rng)
}

/// A random fault outside the library.
pub(in crate::examine::worlds::one) fn outer(count: usize, rng: &mut Rng) -> Choice {
    choice(&OUTSIDE, count, rng)
}

/// Whether two effects may act together: not if they cannot be told apart, or one hides the other.
pub(in crate::examine::worlds::one) fn apart(a: &Choice, b: &Choice) -> bool {
    const GROUPS: [&[&str]; 6] = [
        &["payload", "link_parameters", "torque_constant", "rotor_inertia", "apparent_torque"],
        &["gravity_spring", "cable", "torque_offset"],
        &["friction_level", "brake_drag", "warm_up", "nonlinear_viscous"],
        &["load_friction", "gear_efficiency"],
        &["time_delay", "filter_lag"],
        &["current_sign", "current_saturation", "flux_weakening", "torque_constant"],
    ];
    let (a, b) = (a.entry.id, b.entry.id);
    a != b && !GROUPS.iter().any(|group| group.contains(&a) && group.contains(&b))
}

impl Choice {
    /// The fault with a size.
    pub(in crate::examine::worlds::one) fn build(&self, ctx: &Context, size: f64) -> Fault {
        let order = Order { joints: &self.joints, form: self.form, size };
        (self.entry.build)(ctx, &order, &mut self.rng.clone())
    }

    /// Whether it acts in a window of time within each period.
    pub(in crate::examine::worlds::one) fn timed(&self) -> bool {
        matches!(self.entry.id, "contact" | "brake_drag")
    }
}
