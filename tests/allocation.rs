//! The algorithms of the dynamics do not allocate.

mod arms;

use std::hint::black_box;

use allocation_counter::measure;
use arms::{load, robots};
use joulepath::arm::dynamics::{
    Data, Regressor, crba, forward_dynamics, regressor, rnea, rnea_derivatives, torque,
};

#[test]
fn algorithms_allocate_nothing() {
    let state = [[0.3, 0.5, -0.4, 0.8, 0.9, -0.2, 0.1]; 3];
    let (mut data, mut scratch, load) = (Data::new(), Regressor::new(), load());
    for model in robots() {
        let [q, qd, qdd] = state.each_ref().map(|values| &values[..model.dof]);
        let counted = measure(|| {
            black_box(rnea(&model, &mut data, &load, q, qd, qdd));
            black_box(rnea_derivatives(&model, &mut data, &load, q, qd, qdd));
            black_box(crba(&model, &mut data, &load, q));
            black_box(forward_dynamics(&model, &mut data, &load, q, qd, qdd));
            black_box(torque(&model, &mut data, &load, q, qd, qdd));
            regressor(&model, &mut scratch, q, qd, qdd);
        });
        assert_eq!(counted.count_total, 0, "{}", model.name);
    }
    assert!(measure(|| drop(black_box(vec![1.0]))).count_total > 0, "the counter counts");
}
