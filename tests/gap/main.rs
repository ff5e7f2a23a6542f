//! Diagnosis of simulated gaps; the effects have the functional forms of the library.

#![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

mod everyday;
#[path = "../support/excited.rs"]
mod excited;
mod next;
mod power;
mod simulated;
mod since_baseline;

use joulepath::arm::dynamics::{JOINT, RIGID, base_parameters, link_parameters};
use joulepath::arm::effects::{ALL, Effect, find as effect, with_body};
use joulepath::arm::robot::{Given, Model};
use joulepath::gap::{
    Diagnosis, Fitted, Improved, Logs, PARAMETERS, Place, Quantity, Record, Settings, Trust,
    Tunables, Verdict, attribution, common_factor, diagnose, diagnose_logs, predicted, shapes,
};
use joulepath::learn::identify::Samples;

use nalgebra::DVector;

use excited::{irb1600, normal};
use simulated::{Robot, perturbed};

/// Largest deviation of a parameter, in standard deviations.
const WITHIN: f64 = 4.0;
/// Relative tolerance of the base parameters of a physically possible body.
const SAME_TORQUES: f64 = 1e-2;
/// Interval of the rows \[s\], and relative tolerance of a force.
const ROW: f64 = 0.01;
const FORCE_TOLERANCE: f64 = 0.05;
/// Tolerance of a coupling.
const COUPLING_TOLERANCE: f64 = 0.005;
/// Least reduction of the gap by an effect that is found.
const SHRINKS: f64 = 0.5;

/// Mass, first and second moments of a load at the flange \[kg, kg m, kg m²\].
const LOAD: [f64; 10] = [1.5, 0.0, 0.0, 0.15, 0.02, 0.02, 0.005, 0.0, 0.0, 0.0];

fn diagnosed(nominal: &Model, robot: &Robot<'_>) -> Diagnosis {
    diagnosed_by(nominal, robot, ALL.iter().collect())
}

fn diagnosed_by(nominal: &Model, robot: &Robot<'_>, effects: Vec<&'static Effect>) -> Diagnosis {
    diagnosed_with(
        nominal,
        robot,
        &Settings { trust: Trust::Commissioned, effects, tunables: Tunables::DEFAULT },
    )
}

fn diagnosed_with(nominal: &Model, robot: &Robot<'_>, settings: &Settings) -> Diagnosis {
    let samples = [1, 2, 3].map(|seed| robot.samples(seed));
    let records = |which: &[usize]| -> Vec<Record<'_>> {
        which.iter().flat_map(|k| Record::all(nominal, &samples[*k])).collect()
    };
    diagnose(nominal, records(&[0, 1]), &records(&[2]), settings)
}

/// Names of the effects with their joints, from 1.
fn named(found: &Diagnosis) -> Vec<(&'static str, Vec<usize>)> {
    let joints = |joints: &[usize]| joints.iter().map(|joint| joint + 1).collect();
    found.effects.iter().map(|asserted| (asserted.effect.id, joints(&asserted.joints))).collect()
}

#[test]
fn healthy_robots_have_no_effect() {
    let nominal = irb1600();
    let truth = perturbed(&nominal, 3);
    let found = diagnosed(&nominal, &Robot { model: &truth, effects: &[], noise: 0.005 });
    assert!(named(&found).is_empty(), "{:?}", named(&found));
    assert!(matches!(found.verdict, Verdict::ParametersOnly | Verdict::NoGap));
    // The improved model contains corrected parameters.
    assert!(found.shrink.total.value > SHRINKS, "{:?}", found.shrink);
}

/// Effects that the baseline already contains are no changes; new effects are.
#[test]
fn only_changes_against_the_baseline_are_reported() {
    let nominal = irb1600();
    let truth = perturbed(&nominal, 3);
    let [spring, friction] = ["gravity_spring", "stribeck"].map(|id| effect(id).unwrap());
    let both: [(&Effect, usize, &[f64]); 2] =
        [(spring, 1, &[600.0, 100.0]), (friction, 1, &[8.0, 0.1])];
    let logged = |effects, seed| Robot { model: &truth, effects, noise: 0.005 }.samples(seed);
    let before = logged(&both[..1], 4);
    let settings = Settings {
        trust: Trust::Commissioned,
        effects: ALL.iter().collect(),
        tunables: Tunables::DEFAULT,
    };
    for (effects, reported) in [(&both[..1], vec![]), (&both[..], vec![("stribeck", vec![2])])] {
        let now = [1, 2, 3].map(|seed| logged(effects, seed));
        let [train, held, before] = [&[&now[0], &now[1]][..], &[&now[2]], &[&before]];
        let found = diagnose_logs(&nominal, Logs { train, held, before }, &settings, &|_| {});
        assert_eq!(named(&found), reported);
        let known: Vec<&str> = found.before.iter().map(|of| of.effect.id).collect();
        assert_eq!(known, ["gravity_spring"]);
        // The model contains both effects.
        assert!(found.shrink.total.value > SHRINKS, "{:?}", found.shrink);
        let held = &Record::all(&nominal, &now[2])[0];
        let predictions = predicted(held, &found.improved.applied);
        let left = |joint: usize| -> f64 {
            let squares = held.measured[joint].iter().zip(&predictions[joint]);
            let squares = squares.map(|(measured, predicted)| (measured - predicted).powi(2));
            (squares.sum::<f64>() / held.motion.rows() as f64).sqrt()
                / held.motion.scale(joint).torque[1]
        };
        assert!((0..nominal.dof).all(|joint| left(joint) < 0.01));
    }
}

#[test]
fn offsets_are_found_with_their_size() {
    let nominal = irb1600();
    let truth = perturbed(&nominal, 3);
    let offset = effect("torque_offset").unwrap();
    let expected = 0.6;
    let robot = Robot { model: &truth, effects: &[(offset, 4, &[expected])], noise: 0.005 };
    let found = diagnosed(&nominal, &robot);
    assert_eq!(named(&found), [("torque_offset", vec![5])]);
    let samples = robot.samples(1);
    let record = Record::all(&nominal, &samples);
    let found_offset = &found.effects[0].parameters[0];
    // Assumed standard deviation of the nominal model's own offset, as a share of the torque.
    let believed = 0.002 * record[0].motion.scale(4).torque[1];
    assert!(
        (found_offset.value - expected).abs() < WITHIN * found_offset.sd.hypot(believed),
        "{found_offset:?} {expected}"
    );
    // The library may be incomplete, which limits the probability.
    assert!((0.5..=0.95).contains(&found.effects[0].probability(true)));
    assert!(found.shrink.total.value > SHRINKS, "{:?}", found.shrink);
}

/// The shares add up to the reduction of the residuals, and the effect has that of its joint.
#[test]
fn shares_of_the_gap_add_up() {
    let nominal = irb1600();
    let truth = perturbed(&nominal, 3);
    let stribeck = effect("stribeck").unwrap();
    let robot = Robot { model: &truth, effects: &[(stribeck, 1, &[25.0, 0.15])], noise: 0.005 };
    let found = diagnosed(&nominal, &robot);
    let ids: Vec<&'static str> = found.effects.iter().map(|asserted| asserted.effect.id).collect();
    assert_eq!(ids, ["stribeck"]);
    let samples = robot.samples(3);
    let records = Record::all(&nominal, &samples);
    let shared = attribution(&records, &nominal, [&found.refit, &found.improved], &ids);
    assert_eq!(shared.players, ["stribeck", PARAMETERS]);
    // Squared residuals of both models by joint, while the joint moves.
    let squares = |model: &Model| -> Vec<f64> {
        let predictions = predicted(&records[0], model);
        let residual = |joint: usize| {
            let (mut missed, mut size) = (0.0, 0.0);
            for (row, predicted) in predictions[joint].iter().enumerate() {
                if records[0].moves(joint, row) {
                    let measured = records[0].measured[joint][row];
                    missed += (measured - predicted).powi(2);
                    size += measured * measured;
                }
            }
            missed / size
        };
        (0..nominal.dof).map(residual).collect()
    };
    let [before, after] = [&nominal, &found.improved.applied].map(squares);
    for joint in 0..nominal.dof {
        let (gap, taken) = shared.of_joint(joint);
        let (gap_of_pieces, sum) = shared
            .cells
            .iter()
            .filter(|cell| cell.joint == joint && cell.quantity == Quantity::Speed)
            .fold((0.0, 0.0), |(a, b), of| (a + of.gap, b + of.taken.iter().sum::<f64>()));
        assert!((gap - gap_of_pieces).abs() < 1e-9);
        assert!((taken.iter().sum::<f64>() - sum).abs() < 1e-9);
        let share = gap / shared.of_joint(0).0 * before[0];
        assert!((share / before[joint] - 1.0).abs() < 1e-6, "{share} {}", before[joint]);
        let left = (gap - sum) / gap * before[joint];
        assert!((left / after[joint] - 1.0).abs() < 1e-3, "{left} {}", after[joint]);
    }
    let most = |player: usize| -> usize {
        let taken = |joint: &usize| shared.of_joint(*joint).1[player];
        (0..nominal.dof).max_by(|a, b| taken(a).total_cmp(&taken(b))).unwrap()
    };
    assert_eq!(most(0), 1);
    let shapes = shapes(&records, &found.improved, &found.effects[0]);
    assert_eq!(shapes.len(), 1);
    assert_eq!((shapes[0].joint, shapes[0].profile.quantity), (1, Quantity::Speed));
    assert!(shapes[0].profile.points.iter().all(|[_, _, half]| half.is_finite()));
}

#[test]
fn a_flipped_current_sign_is_found() {
    let nominal = irb1600();
    let truth = perturbed(&nominal, 4);
    let sign = effect("current_sign").unwrap();
    let robot = Robot { model: &truth, effects: &[(sign, 2, &[1.0])], noise: 0.005 };
    let found = diagnosed(&nominal, &robot);
    assert_eq!(named(&found), [("current_sign", vec![3])]);
    assert!(found.shrink.total.value > SHRINKS, "{:?}", found.shrink);
}

/// The windows are off the coarse grid, whose best window leads to another optimum.
#[test]
fn contacts_are_found_with_force_and_time_window() {
    let nominal = irb1600();
    let truth = perturbed(&nominal, 5);
    let contact = effect("contact").unwrap();
    for rise in [0.35, 0.0] {
        let coordinates = [30.0, -40.0, 12.0, rise, 2.636, 3.792, 10.0];
        let robot = Robot { model: &truth, effects: &[(contact, 0, &coordinates)], noise: 5e-4 };
        let found = diagnosed(&nominal, &robot);
        assert_eq!(named(&found), [("contact", vec![])], "{rise} {:?}", found.reasons);
        let value = |name: &str| {
            found.effects[0].parameters.iter().find(|of| of.name == name).unwrap().value
        };
        let force = (30.0_f64.powi(2) + 40.0_f64.powi(2) + 12.0_f64.powi(2)).sqrt();
        assert!(
            (value("force") / force - 1.0).abs() < FORCE_TOLERANCE,
            "{rise} {}",
            value("force")
        );
        for (name, expected) in [("t_start_s", 2.636), ("t_end_s", 3.792)] {
            assert!((value(name) - expected).abs() < ROW, "{rise} {name} {}", value(name));
        }
    }
}

/// Backlash depends on the actual load, not on that of a model with wrong masses.
#[test]
fn backlash_is_found_despite_wrong_masses() {
    let nominal = irb1600();
    let mut truth = perturbed(&nominal, 5);
    for (link, factor) in truth.links.iter_mut().zip([1.0, 1.4, 0.6, 1.5, 0.5, 1.5]) {
        link.mass *= factor;
    }
    let effects = [(effect("backlash").unwrap(), 2, [0.005, 0.0, 1e5].as_slice())];
    let robot = Robot { model: &truth, effects: &effects, noise: 0.003 };
    let settings =
        Settings { trust: Trust::Cad, effects: ALL.iter().collect(), tunables: Tunables::DEFAULT };
    let found = diagnosed_with(&nominal, &robot, &settings);
    assert_eq!(named(&found), [("backlash", vec![3])], "{:?}", found.reasons);
}

/// At reversals of motor 6 the rows are so accurate that only the right coupling explains them.
#[test]
fn a_wrist_coupling_is_found_accurately() {
    let nominal = irb1600();
    let truth = perturbed(&nominal, 5);
    let effects = [(effect("wrist_coupling").unwrap(), 5, [-0.254, 0.0, 0.0, 0.0].as_slice())];
    let found = diagnosed(&nominal, &Robot { model: &truth, effects: &effects, noise: 5e-4 });
    assert_eq!(named(&found), [("wrist_coupling", vec![5, 6])], "{:?}", found.reasons);
    let coupling = found.effects[0].parameters[0].value;
    assert!((coupling + 0.254).abs() < COUPLING_TOLERANCE, "{coupling}");
}

/// A load on the opposite side of axis 5 also reverses the sign of its torques.
#[test]
fn a_heavy_load_is_not_mistaken_for_a_flipped_sign() {
    let mut nominal = irb1600();
    nominal.links[5].com.z = -0.15;
    let truth = perturbed(&nominal, 3);
    let mut load = LOAD;
    for x in &mut load {
        *x *= 5.0;
    }
    let effects = [(effect("payload").unwrap(), 5, load.as_slice())];
    let found = diagnosed(&nominal, &Robot { model: &truth, effects: &effects, noise: 0.002 });
    assert_eq!(named(&found), [("payload", vec![])], "{:?}", found.reasons);
    let mass = &found.effects[0].parameters[0];
    assert!((mass.value - load[0]).abs() < WITHIN * mass.sd, "{mass:?}");
}

/// A load at the flange tilts with the base.
#[test]
fn a_tilted_base_is_found_under_a_heavy_load() {
    let nominal = irb1600();
    let mut truth = perturbed(&nominal, 5);
    let load = LOAD.map(|x| 4.0 * x);
    truth.links[5] = with_body(&truth.links[5], &nominal.kinematics.flange, &load);
    let effects = [(effect("base_tilt").unwrap(), 0, [0.1, -0.06].as_slice())];
    let found = diagnosed(&nominal, &Robot { model: &truth, effects: &effects, noise: 5e-4 });
    let mut named = named(&found);
    named.sort_unstable();
    assert_eq!(named, [("base_tilt", vec![]), ("payload", vec![])], "{:?}", found.reasons);
}

/// Saturation may grow with a lower power than the cube of the torque.
#[test]
fn current_saturation_is_distinguished_from_load_friction() {
    let nominal = irb1600();
    let truth = perturbed(&nominal, 5);
    let saturation = effect("current_saturation").unwrap();
    let effects = [(saturation, 2, [0.3, 1.0].as_slice())];
    let found = diagnosed(&nominal, &Robot { model: &truth, effects: &effects, noise: 0.002 });
    assert_eq!(named(&found), [("current_saturation", vec![3])]);
    let exponent = &found.effects[0].parameters[1];
    assert!((exponent.value - 1.0).abs() < WITHIN * exponent.sd, "{exponent:?}");
}

/// Each joint has a small breakaway step of its friction.
#[test]
fn a_small_breakaway_friction_is_not_reported() {
    let nominal = irb1600();
    let truth = perturbed(&nominal, 3);
    let stribeck = effect("stribeck").unwrap();
    let named_with = |share: f64| {
        let stiction = share * truth.friction.coulomb[1];
        let coordinates = [stiction, 0.1];
        let effects = [(stribeck, 1, coordinates.as_slice())];
        let robot = Robot { model: &truth, effects: &effects, noise: 2e-4 };
        named(&diagnosed(&nominal, &robot))
    };
    // Three times the dry friction is more than 1 % of the torque.
    assert_eq!(named_with(3.0), [("stribeck", vec![2])]);
    assert!(named_with(0.07).is_empty());
}

#[test]
fn two_effects_are_found() {
    let nominal = irb1600();
    let truth = perturbed(&nominal, 6);
    let [payload, stribeck] = ["payload", "stribeck"].map(|id| effect(id).unwrap());
    let effects = [(payload, 0, LOAD.as_slice()), (stribeck, 1, [25.0, 0.1].as_slice())];
    let found = diagnosed(&nominal, &Robot { model: &truth, effects: &effects, noise: 0.003 });
    let mut reported = named(&found);
    reported.sort();
    assert_eq!(reported, [("payload", vec![]), ("stribeck", vec![2])]);
}

/// A strong load, or a strong friction of another joint, does not hide a weak effect.
#[test]
fn weak_effects_are_found_beside_strong_ones() {
    let nominal = irb1600();
    let truth = perturbed(&nominal, 6);
    let [payload, stribeck, spot] =
        ["payload", "stribeck", "position_friction"].map(|id| effect(id).unwrap());
    let load = LOAD.map(|of| 4.0 * of);
    let weak = (stribeck, 1, [25.0, 0.1].as_slice());
    for strong in [(payload, 0, load.as_slice()), (spot, 0, [40.0, 10.0].as_slice())] {
        let robot = Robot { model: &truth, effects: &[strong, weak], noise: 0.0005 };
        let found = diagnosed(&nominal, &robot);
        assert!(named(&found).contains(&("stribeck", vec![2])), "{:?}", named(&found));
    }
}

/// A permanently dragging brake is Coulomb friction.
#[test]
fn a_permanently_dragging_brake_is_in_one_class_with_friction() {
    let nominal = irb1600();
    let truth = perturbed(&nominal, 5);
    let effects = [(effect("brake_drag").unwrap(), 0, [30.0, 0.0, 0.0, 0.0].as_slice())];
    let robot = Robot { model: &truth, effects: &effects, noise: 0.003 };
    let found = diagnosed_by(
        &nominal,
        &robot,
        ["brake_drag", "warm_up", "friction_level"].map(|id| effect(id).unwrap()).to_vec(),
    );
    let class = &found.effects[0].class;
    assert!(["brake_drag", "friction_level"].iter().all(|id| class.contains(id)), "{class:?}");
}

/// With a heavy load the torques hardly resemble those of the robot without it.
#[test]
fn a_heavy_load_is_not_mistaken_for_another_robot() {
    let nominal = irb1600();
    let truth = perturbed(&nominal, 6);
    let [mass, x, y, z] = [15.0, -0.4, 0.4, 0.4];
    let moments = [y * y + z * z, x * x + z * z, x * x + y * y, -x * y, -x * z, -y * z];
    let body: Vec<f64> = [1.0, x, y, z].iter().chain(&moments).map(|of| mass * of).collect();
    let effects: [(&Effect, usize, &[f64]); 1] = [(effect("payload").unwrap(), 0, &body)];
    let robot = Robot { model: &truth, effects: &effects, noise: 0.003 };
    let samples = robot.samples(1);
    let record = &Record::all(&nominal, &samples)[0];
    let foreign = |joint: &usize| {
        let (measured, modelled) = (&record.measured[*joint], &record.motion.torque[*joint]);
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        product(measured, modelled)
            < 0.5 * (product(measured, measured) * product(modelled, modelled)).sqrt()
    };
    assert!(2 * (0..nominal.dof).filter(foreign).count() >= nominal.dof);
    let found = diagnosed(&nominal, &robot);
    assert_eq!(named(&found), [("payload", vec![])], "{:?}", found.reasons);
}

/// Friction and rotor inertia can decrease at most to zero; the coupling remains.
#[test]
fn friction_and_rotor_inertia_of_a_wrist_do_not_become_negative() {
    let nominal = irb1600();
    let change = vec![-0.4, -1e3, -1e3, -1e3];
    let fitted = Fitted {
        effect: effect("wrist_coupling").unwrap(),
        joint: None,
        coordinates: change.clone(),
        parameters: change,
        deviations: vec![0.1; 4],
        significance: None,
    };
    let none = DVector::zeros(0);
    let improved = Improved::new(&nominal, [&none, &none], [&[], &[fitted]]).applied;
    assert!((improved.wrist.coupling - nominal.wrist.coupling + 0.4).abs() < 1e-12);
    assert_eq!([improved.friction.coulomb[5], improved.friction.viscous[5]], [0.0; 2]);
    assert!(improved.motors.unwrap().rotor_inertia[5].abs() < 1e-12);
}

/// Masses and first moments of loads at the flange add up; centres of mass do not.
#[test]
fn a_diagnosed_load_is_added_to_the_listed_one() {
    let payload = effect("payload").unwrap();
    let fitted = Fitted {
        effect: payload,
        joint: None,
        coordinates: LOAD.to_vec(),
        parameters: payload.parameters_of(&LOAD),
        deviations: vec![0.1; LOAD.len()],
        significance: None,
    };
    let none = DVector::zeros(0);
    let loaded = |model: &Model| {
        Improved::new(model, [&none, &none], [&[], std::slice::from_ref(&fitted)]).written
    };
    let twice = loaded(&loaded(&irb1600()));
    for (name, expected) in [("mass", 2.0 * LOAD[0]), ("com_z", LOAD[3] / LOAD[0])] {
        let (_, given) = twice.effects[0].values.iter().find(|(of, _)| of == name).unwrap();
        let Given::Robot(value) = given else { panic!("{given:?}") };
        assert!((value - expected).abs() < 1e-12, "{name} {value}");
    }
}

#[test]
fn wrong_torque_constants_are_found_at_one_joint_and_at_all() {
    let nominal = irb1600();
    let truth = perturbed(&nominal, 5);
    let constant = effect("torque_constant").unwrap();
    let effects: Vec<(&Effect, usize, &[f64])> =
        (0..nominal.dof).map(|joint| (constant, joint, &[0.2][..])).collect();
    let found = diagnosed(&nominal, &Robot { model: &truth, effects: &effects, noise: 0.003 });
    let mut joints = named(&found)[0].1.clone();
    joints.sort_unstable();
    assert_eq!((found.effects[0].effect.id, joints), ("torque_constant", (1..=6).collect()));
    let found =
        diagnosed(&nominal, &Robot { model: &truth, effects: &effects[1..2], noise: 0.003 });
    assert_eq!(named(&found), [("torque_constant", vec![2])]);
}

/// The residual of a force's form has a window, too.
#[test]
fn a_force_beside_friction_is_not_mistaken_for_a_brake() {
    let nominal = irb1600();
    let truth = perturbed(&nominal, 5);
    let [contact, friction] = ["contact", "position_friction"].map(|id| effect(id).unwrap());
    let effects = [
        (contact, 0, [60.0, 0.0, 20.0, 0.0, 2.0, 4.0, 10.0].as_slice()),
        (friction, 4, [1.0, 6.0, 8.0, 10.0].as_slice()),
    ];
    let found = diagnosed(&nominal, &Robot { model: &truth, effects: &effects, noise: 0.003 });
    let mut all = named(&found);
    all.sort_unstable();
    let failed: Vec<_> = found.trail.iter().filter(|entry| !entry.passed).collect();
    assert_eq!(all, [("contact", vec![]), ("position_friction", vec![5])], "{failed:?}");
}

#[test]
fn impossible_bodies_are_replaced_by_possible_ones_with_the_same_torques() {
    let nominal = irb1600();
    let n = nominal.dof;
    let count = (RIGID + JOINT) * n;
    let mut wanted = vec![0.0; count];
    for (link, of) in nominal.links.iter().enumerate() {
        wanted[RIGID * link..RIGID * (link + 1)].copy_from_slice(&link_parameters(of));
    }
    let sizes = DVector::from_fn(count, |k, _| 0.1 * wanted[k].abs() + 1e-3);
    // A moment of link 5 becomes negative, as far as its neighbours can compensate it.
    let at = RIGID * 4 + 4;
    let mut change = DVector::zeros(count);
    change[at] = -1.2 * wanted[at];
    let found = Improved::new(&nominal, [&change, &sizes], [&[], &[]]).written;
    assert!(found.links.iter().all(|link| link.mass > 0.0 && link.is_consistent()));
    assert_ne!(found.links, nominal.links);
    wanted[at] *= -0.2;
    let mut kept = wanted.clone();
    for (link, of) in found.links.iter().enumerate() {
        kept[RIGID * link..RIGID * (link + 1)].copy_from_slice(&link_parameters(of));
    }
    let base = base_parameters(&nominal);
    let (wanted, kept) = (base.of_parameters(&wanted), base.of_parameters(&kept));
    let size: f64 = wanted.iter().map(|x| x * x).sum::<f64>().sqrt();
    let off: f64 = wanted.iter().zip(&kept).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
    assert!(off < SAME_TORQUES * size, "{off} of {size}");
}

/// For torques of other joints and for resting joints no effect is asserted.
#[test]
fn unrelated_torques_and_resting_joints_have_no_effect() {
    let nominal = irb1600();
    let robot = Robot { model: &nominal, effects: &[], noise: 0.005 };
    let diagnosed = |change: &dyn Fn(&mut Samples)| {
        let samples = [1, 2].map(|seed| {
            let mut samples = robot.samples(seed);
            change(&mut samples);
            samples
        });
        let [train, held] = samples.each_ref().map(|of| Record::all(&nominal, of));
        let settings = Settings {
            trust: Trust::Commissioned,
            effects: ALL.iter().collect(),
            tunables: Tunables::DEFAULT,
        };
        diagnose(&nominal, train, &held, &settings)
    };
    let other = diagnosed(&|samples| {
        for block in &mut samples.blocks {
            block.tau.rotate_left(2);
        }
        if let Some(repetitions) = &mut samples.repetitions {
            repetitions.rotate_left(2);
        }
    });
    assert_eq!((other.verdict, named(&other)), (Verdict::Unknown, Vec::new()));
    // Torques without relation to the motion have smooth parts, but not those of a robot.
    let noise = diagnosed(&|samples| {
        let mut random = fastrand::Rng::with_seed(9);
        let noise: Vec<f64> = (0..1000).map(|_| 20.0 * normal(&mut random)).collect();
        for block in &mut samples.blocks {
            for of_joint in &mut block.tau {
                of_joint.iter_mut().zip(&noise).for_each(|(tau, noise)| *tau = *noise);
            }
        }
    });
    assert_eq!((noise.verdict, named(&noise)), (Verdict::Unknown, Vec::new()));
    // Unexplained residuals are still located.
    let push = diagnosed(&|samples| {
        for block in &mut samples.blocks {
            for (tau, q) in block.tau[1].iter_mut().zip(&block.q[4]) {
                *tau += 60.0 * (2.0 * q + 0.5).sin();
            }
        }
    });
    assert_eq!((push.verdict, named(&push)), (Verdict::Unknown, Vec::new()));
    let whole = |joint: usize| {
        let is_whole = |of: &&Place| of.joint == Some(joint) && of.regime == "all";
        push.places.iter().find(is_whole).unwrap().share
    };
    assert!(whole(1) > 0.5, "{}", whole(1));
    let still = diagnosed(&|samples| {
        for block in &mut samples.blocks {
            for joint in 0..4 {
                block.q[joint].fill(0.1);
                block.qd[joint].fill(0.0);
                block.qdd[joint].fill(0.0);
            }
        }
    });
    assert_eq!((still.verdict, named(&still)), (Verdict::NotExcited, Vec::new()));
}

#[test]
fn another_torque_unit_is_recognised_as_a_factor() {
    let nominal = irb1600();
    let truth = perturbed(&nominal, 3);
    let robot = Robot { model: &truth, effects: &[], noise: 0.005 };
    let mut samples = robot.samples(1);
    let factor =
        |samples: &Samples| common_factor(&Record::all(&nominal, samples), Trust::Commissioned);
    assert_eq!(factor(&samples), None);
    let times = 0.4;
    for block in &mut samples.blocks {
        block.tau.iter_mut().flatten().for_each(|tau| *tau *= times);
    }
    let found = factor(&samples).unwrap();
    assert!((found / times - 1.0).abs() < 0.05, "{found}");
}
