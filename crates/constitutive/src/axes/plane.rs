//! Principal values in plane strain: the value across the plane is one of them.

use super::{Order, Principal};
use granular_core::SymmetricTensor;

/// Axes of principal values of a tensor without components xz and yz.
#[derive(Clone, Copy, Debug)]
pub struct Directions {
    order: Order,
    half_difference: f64,
    shear: f64,
}

#[inline(always)]
pub(super) fn principal(tensor: SymmetricTensor) -> Principal<Directions> {
    let mean = 0.5 * (tensor.xx + tensor.yy);
    let half_difference = 0.5 * (tensor.xx - tensor.yy);
    let shear = tensor.xy;
    let radius = (half_difference * half_difference + shear * shear).sqrt();
    let (values, order) = Order::of(mean, radius, tensor.zz);
    Principal { values, directions: Directions { order, half_difference, shear } }
}

impl Directions {
    #[inline(always)]
    pub(super) fn with_values(&self, values: [f64; 3]) -> SymmetricTensor {
        let (mean, scale, normal) = self.order.undo(values);
        let half_difference = scale * self.half_difference;
        SymmetricTensor {
            xx: mean + half_difference,
            yy: mean - half_difference,
            zz: normal,
            xy: scale * self.shear,
            ..SymmetricTensor::ZERO
        }
    }
}
