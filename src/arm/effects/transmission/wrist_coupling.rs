//! A wrist coupling that differs from the stated one.

use crate::arm::robot::Model;

use crate::arm::effects::effect::{
    Acts, Channel, Coordinate, Effect, Form, Nature, Role, Scope, Subject, free, linear, shaped,
};

pub(in crate::arm::effects) const WRIST_COUPLING: Effect = Effect {
    id: "wrist_coupling",
    channel: Channel::Torque,
    scope: Scope::Robot,
    subject: Subject::Drive,
    nature: Nature::Law,
    acts: Acts::Always,
    variable: None,
    title: "Coupling of the wrist",
    law: "motor 6 turns with q̇₆ + coupling·q̇₅",
    source: "E. Villani/thanhndv212, figaroh examples: identification of the TX40",
    parameters: &[
        free("coupling", "1", "change of the turns of motor 6 per turn of axis 5"),
        free("coulomb", "Nm", "change of Coulomb friction of motor 6")
            .beside(|model, _| Some(model.friction.coulomb[model.dof - 1])),
        free("viscous", "Nm s/rad", "the same, viscous")
            .beside(|model, _| Some(model.friction.viscous[model.dof - 1])),
        free("inertia", "kg m2", "change of the inertia of rotor 6, at the joint")
            .beside(|model, _| model.motors.as_ref().map(|of| of.reflected_inertia(model.dof - 1))),
    ],
    coordinates: &[
        // Torques jump at reversals of the motor, so they have no derivative.
        Coordinate { role: Role::Choice(|_| TRIED.to_vec()), usual: shaped },
        linear(|of| 0.3 * of.coulomb),
        linear(|of| 0.3 * of.viscous),
        linear(|of| 0.2 * of.rotor),
    ],
    published: None,
    joints: |dof| if dof == 6 { vec![5] } else { Vec::new() },
    brings: &["friction_level", "torque_offset"],
    confused: &[
        "friction_level",
        "rotor_inertia",
        "load_friction",
        "stribeck",
        "nonlinear_viscous",
        "brake_drag",
    ],
    inspect: "bearings between the shafts of axes 5 and 6",
    experiment: ["--variant wrist", "axis 5 alone, 5 and 6 against each other"],
    form: Form::Model(change),
};

/// Initially tried changes of the coupling.
const TRIED: [f64; 8] = [-1.0, -0.75, -0.5, -0.25, 0.25, 0.5, 0.75, 1.0];

fn change(model: &mut Model, _: usize, values: &[f64]) {
    model.wrist.coupling += values[0];
    model.friction.coulomb[5] += values[1];
    model.friction.viscous[5] += values[2];
    if let Some(motors) = &mut model.motors {
        motors.rotor_inertia[5] += values[3] / (motors.ratio[5] * motors.ratio[5]);
    }
}
