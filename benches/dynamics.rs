//! Time per call of the dynamics and of the kinematics with six joints.
//! `benches/peers/pinocchio/run` compares it with Pinocchio.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use joulepath::arm::dynamics::{
    Data, Load, Regressor, crba, forward_dynamics, regressor, rnea, rnea_derivatives,
};
use joulepath::arm::kinematics::{Tcp, fk, ik_all, jacobian};
use joulepath::arm::robot::find;
use nalgebra::{Isometry3, Matrix3, Vector3};

const Q: [f64; 6] = [0.3, 0.5, -0.4, 0.8, 0.9, -0.2];
const QD: [f64; 6] = [1.0, -0.5, 0.7, 2.0, -1.0, 3.0];
const QDD: [f64; 6] = [5.0, 4.0, -6.0, 10.0, 20.0, -30.0];

fn robot_algorithms(c: &mut Criterion) {
    let Ok(model) = find("IRB1600-10/1.45") else { return };
    let mut data = Data::new();
    let load =
        Load { mass: 8.0, com: Vector3::new(0.0, 0.0, 0.1), inertia: Matrix3::identity() * 0.1 };
    let none = Load::none();
    let tool = Isometry3::translation(0.0, 0.0, 0.2);
    let pose = fk(&model, &Q);

    c.bench_function("rnea", |b| {
        b.iter(|| rnea(&model, &mut data, &none, black_box(&Q), black_box(&QD), black_box(&QDD)));
    });
    c.bench_function("rnea with a load", |b| {
        b.iter(|| rnea(&model, &mut data, &load, black_box(&Q), black_box(&QD), black_box(&QDD)));
    });
    c.bench_function("rnea derivatives", |b| {
        b.iter(|| {
            let (q, qd, qdd) = (black_box(&Q), black_box(&QD), black_box(&QDD));
            rnea_derivatives(&model, &mut data, &none, q, qd, qdd)
        });
    });
    c.bench_function("crba", |b| b.iter(|| crba(&model, &mut data, &none, black_box(&Q))));
    c.bench_function("forward dynamics", |b| {
        b.iter(|| forward_dynamics(&model, &mut data, &none, black_box(&Q), &QD, black_box(&QDD)));
    });
    let mut scratch = Regressor::new();
    c.bench_function("regressor", |b| {
        b.iter(|| {
            regressor(&model, &mut scratch, black_box(&Q), black_box(&QD), black_box(&QDD));
            black_box(&mut scratch);
        });
    });
    c.bench_function("fk", |b| b.iter(|| fk(&model, black_box(&Q))));
    c.bench_function("ik_all", |b| b.iter(|| ik_all(&model, black_box(&pose))));
    c.bench_function("jacobian", |b| b.iter(|| jacobian(&model, black_box(&Q), &tool)));
    c.bench_function("jacobian_dot", |b| {
        b.iter(|| Tcp::Held(tool).jacobian_dot(&model, black_box(&Q), black_box(&QD)));
    });
}

criterion_group!(benches, robot_algorithms);
criterion_main!(benches);
