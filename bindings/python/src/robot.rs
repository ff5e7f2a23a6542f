//! Robots: kinematics and dynamics of one state or of many.

use std::path::PathBuf;

use joulepath::dynamics::{self, Data, Regressor};
use joulepath::kinematics;
use joulepath::nalgebra::{Isometry3, Matrix3, Matrix4, Rotation3, Translation3, UnitQuaternion, Vector3};
use joulepath::robot::{self, Model};
use numpy::{PyArrayDyn, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use super::arrays::{Numbers, States};
use super::error::{JoulepathError, RobotError};

/// Numbers of a body in a regressor: mass, first moments, moments of inertia.
const BODY: usize = 10;

/// Names of the robots of the catalogue.
#[pyfunction]
pub(crate) fn robots() -> Vec<String> {
    robot::names().map(str::to_owned).collect()
}

/// Tool and payload as one body, in the frame of the flange.
///
/// mass in kg, com (3,) in m, inertia (3, 3) about the centre of mass in kg m².
#[pyclass(frozen, module = "joulepath")]
pub(crate) struct Load(dynamics::Load);

#[pymethods]
impl Load {
    #[new]
    #[pyo3(signature = (mass, com = [0.0; 3], inertia = [[0.0; 3]; 3]))]
    fn new(mass: f64, com: [f64; 3], inertia: [[f64; 3]; 3]) -> PyResult<Load> {
        let all = com.iter().chain(inertia.as_flattened());
        if !(mass >= 0.0 && mass.is_finite() && all.clone().all(|x| x.is_finite())) {
            return Err(JoulepathError::new_err(
                "a load has a mass of 0 kg or more, and finite numbers",
            ));
        }
        let inertia = Matrix3::from_fn(|i, j| inertia[i][j]);
        Ok(Load(dynamics::Load { mass, com: Vector3::from(com), inertia }))
    }

    fn __repr__(&self) -> String {
        let com: Vec<String> = self.0.com.iter().map(ToString::to_string).collect();
        format!("Load(mass={}, com=[{}])", self.0.mass, com.join(", "))
    }
}

/// A robot: a name of the catalogue, or the path of a TOML or URDF file.
#[pyclass(frozen, module = "joulepath")]
pub(crate) struct Robot {
    model: Model,
    source: String,
}

impl Robot {
    /// Computes `width` numbers for each state of arrays of one shape.
    fn each<'py, const N: usize>(
        &self,
        py: Python<'py>,
        arrays: [(&str, &Numbers<'py>); N],
        own: &[usize],
        compute: impl Fn([&[f64]; N], &mut [f64]) + Send + Sync,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let n = self.model.dof;
        let views = arrays.map(|(name, array)| (name, array.as_array()));
        let states = States::new(views, n)?;
        let mut shape = states.shape.clone();
        shape.pop();
        shape.extend(own);
        let width: usize = own.iter().product();
        let out = PyArrayDyn::<f64>::zeros(py, shape, false);
        {
            let mut out = out.readwrite();
            let out = out.as_slice_mut()?;
            let slices = states.slices();
            py.detach(|| {
                for (k, out) in out.chunks_exact_mut(width).enumerate() {
                    compute(slices.map(|all| &all[k * n..(k + 1) * n]), out);
                }
            });
        }
        Ok(out)
    }
}

#[pymethods]
impl Robot {
    #[new]
    fn new(name_or_path: PathBuf) -> PyResult<Robot> {
        let source = name_or_path.to_string_lossy().into_owned();
        let model = robot::load(&source).map_err(|it| RobotError::new_err(it.to_string()))?;
        Ok(Robot { model, source })
    }

    /// Its name.
    #[getter]
    fn name(&self) -> &str {
        &self.model.name
    }

    /// Number of joints.
    #[getter]
    fn dof(&self) -> usize {
        self.model.dof
    }

    /// Torques (…, n) in Nm of the motions q, qd, qdd (…, n) in rad, rad/s, rad/s²: rigid bodies and
    /// reflected rotors, without friction.
    #[pyo3(signature = (q, qd, qdd, load = None))]
    fn rnea<'py>(
        &self,
        py: Python<'py>,
        q: Numbers<'py>,
        qd: Numbers<'py>,
        qdd: Numbers<'py>,
        load: Option<&Load>,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let load = load.map_or_else(dynamics::Load::none, |load| load.0.clone());
        let arrays = [("q", &q), ("qd", &qd), ("qdd", &qdd)];
        self.each(py, arrays, &[self.model.dof], |[q, qd, qdd], out| {
            let mut data = Data::new();
            let tau = dynamics::rnea(&self.model, &mut data, &load, q, qd, qdd);
            out.copy_from_slice(&tau[..out.len()]);
        })
    }

    /// The regressor (…, n, 10 n) of the rigid bodies: torques in Nm per unit of mass, first moments and
    /// moments of inertia of each link.
    fn regressor<'py>(
        &self,
        py: Python<'py>,
        q: Numbers<'py>,
        qd: Numbers<'py>,
        qdd: Numbers<'py>,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let n = self.model.dof;
        let arrays = [("q", &q), ("qd", &qd), ("qdd", &qdd)];
        self.each(py, arrays, &[n, BODY * n], |[q, qd, qdd], out| {
            let mut regressor = Regressor::new();
            dynamics::regressor(&self.model, &mut regressor, q, qd, qdd);
            for (row, out) in regressor.rows.iter().zip(out.chunks_exact_mut(BODY * n)) {
                for (link, out) in row.iter().zip(out.chunks_exact_mut(BODY)) {
                    out.copy_from_slice(link);
                }
            }
        })
    }

    /// Poses (…, 4, 4) of the flange in the base frame, in m, at q (…, n) in rad.
    fn fk<'py>(
        &self,
        py: Python<'py>,
        q: Numbers<'py>,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.each(py, [("q", &q)], &[4, 4], |[q], out| {
            let pose = kinematics::fk(&self.model, q).to_homogeneous();
            // Matrices are stored by columns.
            out.copy_from_slice(pose.transpose().as_slice());
        })
    }

    /// All joint angles (k, 6) in rad at which the flange has a pose (4, 4) within the limits; the one
    /// nearest to `near` (6,) first, if it is given.
    #[pyo3(signature = (pose, near = None))]
    fn ik<'py>(
        &self,
        py: Python<'py>,
        pose: PyReadonlyArray2<'py, f64>,
        near: Option<PyReadonlyArray1<'py, f64>>,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let pose = pose_of(&pose)?;
        let near = near.map(|near| near.as_array().to_vec());
        let found = py.detach(|| kinematics::ik_all(&self.model, &pose));
        let mut found = found.map_err(|error| JoulepathError::new_err(error.to_string()))?;
        if let Some(near) = near {
            let Ok(near) = <[f64; 6]>::try_from(near) else {
                return Err(JoulepathError::new_err("near needs 6 angles in rad"));
            };
            let distance = |q: &[f64; 6]| -> f64 {
                q.iter().zip(near).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
            };
            found.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
        }
        let out = PyArrayDyn::<f64>::zeros(py, vec![found.len(), 6], false);
        out.readwrite().as_slice_mut()?.copy_from_slice(found.as_flattened());
        Ok(out)
    }

    fn __repr__(&self) -> String {
        format!("Robot('{}')", self.source)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> (Bound<'py, PyAny>, (String,)) {
        (slf.get_type().into_any(), (slf.get().source.clone(),))
    }
}

/// A pose from its matrix.
fn pose_of(pose: &PyReadonlyArray2<'_, f64>) -> PyResult<Isometry3<f64>> {
    /// Largest deviation of a rotation from an orthogonal matrix.
    const ORTHOGONAL: f64 = 1e-6;
    let wrong = |why: &str| Err(JoulepathError::new_err(format!("a pose is a (4, 4) matrix: {why}")));
    let pose = pose.as_array();
    if pose.shape() != [4, 4] {
        return wrong(&format!("this one is {:?}", pose.shape()));
    }
    let matrix = Matrix4::from_fn(|i, j| pose[[i, j]]);
    let rotation: Matrix3<f64> = matrix.fixed_view::<3, 3>(0, 0).into_owned();
    let off = (rotation * rotation.transpose() - Matrix3::identity()).amax();
    if !(off <= ORTHOGONAL && rotation.determinant() > 0.0) {
        return wrong("the upper left part is no rotation");
    }
    let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(rotation));
    let place = Translation3::new(matrix[(0, 3)], matrix[(1, 3)], matrix[(2, 3)]);
    Ok(Isometry3::from_parts(place, turn))
}
