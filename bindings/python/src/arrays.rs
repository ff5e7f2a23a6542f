//! Arrays of states: the last axis has one number per joint, the others are those of a batch.

use numpy::ndarray::{ArrayViewD, CowArray, IxDyn};
use numpy::{AllowTypeChange, PyArrayLikeDyn};
use pyo3::PyResult;

use super::error::JoulepathError;

/// An array or list of numbers of any type, layout and number of axes.
pub(crate) type Numbers<'py> = PyArrayLikeDyn<'py, f64, AllowTypeChange>;

/// Arrays of one shape (…, n) in C order.
pub(crate) struct States<'a, const N: usize> {
    /// The shape of each.
    pub(crate) shape: Vec<usize>,
    arrays: [CowArray<'a, f64, IxDyn>; N],
}

impl<'a, const N: usize> States<'a, N> {
    /// The arrays of these names, which need `n` numbers on the last axis.
    pub(crate) fn new(arrays: [(&str, ArrayViewD<'a, f64>); N], n: usize) -> PyResult<Self> {
        let shape = arrays[0].1.shape().to_vec();
        for (name, array) in &arrays {
            let own = array.shape();
            if own.last() != Some(&n) {
                let message =
                    format!("{name} has the shape {own:?}: its last axis needs {n} numbers, one per joint");
                return Err(JoulepathError::new_err(message));
            }
            if own != shape {
                let message =
                    format!("{name} has the shape {own:?}, but {} has {shape:?}", arrays[0].0);
                return Err(JoulepathError::new_err(message));
            }
        }
        let standard = |(_, array): (&str, ArrayViewD<'a, f64>)| match array.is_standard_layout() {
            true => CowArray::from(array),
            false => CowArray::from(array.as_standard_layout().into_owned()),
        };
        Ok(States { shape, arrays: arrays.map(standard) })
    }

    /// The numbers of each array, one state after the other.
    pub(crate) fn slices(&self) -> [&[f64]; N] {
        // The layout is standard, so there is a slice.
        std::array::from_fn(|i| self.arrays[i].as_slice().unwrap_or_default())
    }
}
