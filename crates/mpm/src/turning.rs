//! Objective updates: how a stress turns with its material in a step.

use granular_core::{Dim, SymmetricTensor};

/// Turns a stress by the spin of a step: half of the curl of the displacement \[rad\].
pub(crate) trait Turning: Copy + Send + Sync + 'static {
    fn turned<D: Dim>(stress: SymmetricTensor, spin: [f64; 3]) -> SymmetricTensor;
}

/// The rotation `(1 - W/2)^-1 (1 + W/2)`, which is exact as a rotation and of second order in its angle \[HughesWinget1980\].
#[derive(Clone, Copy, Debug)]
pub(crate) struct ByRotation;

impl Turning for ByRotation {
    #[inline(always)]
    fn turned<D: Dim>(s: SymmetricTensor, spin: [f64; 3]) -> SymmetricTensor {
        if D::N == 2 {
            // Tangent of half the angle.
            let half = 0.5 * spin[2];
            let whole = 1.0 / (1.0 + half * half);
            let (cosine, sine) = ((1.0 - half * half) * whole, 2.0 * half * whole);
            let (cc, ss, cs) = (cosine * cosine, sine * sine, cosine * sine);
            let cross = 2.0 * cs * s.xy;
            return SymmetricTensor {
                xx: cc * s.xx + ss * s.yy - cross,
                yy: ss * s.xx + cc * s.yy + cross,
                xy: (cc - ss) * s.xy + cs * (s.xx - s.yy),
                ..s
            };
        }
        rotate(s, rotation(spin.map(|component| 0.5 * component)))
    }
}

/// Cayley's rotation about `b`, whose length is the tangent of half the angle: `1 + 2 (B + B^2) / (1 + b^2)`.
#[inline(always)]
fn rotation([x, y, z]: [f64; 3]) -> [[f64; 3]; 3] {
    let scale = 2.0 / (1.0 + x * x + y * y + z * z);
    [
        [1.0 - scale * (y * y + z * z), scale * (x * y - z), scale * (x * z + y)],
        [scale * (x * y + z), 1.0 - scale * (x * x + z * z), scale * (y * z - x)],
        [scale * (x * z - y), scale * (y * z + x), 1.0 - scale * (x * x + y * y)],
    ]
}

/// `Q s Q^T`.
#[inline(always)]
fn rotate(s: SymmetricTensor, q: [[f64; 3]; 3]) -> SymmetricTensor {
    let half = |row: usize| {
        let [a, b, c] = q[row];
        [a * s.xx + b * s.xy + c * s.xz, a * s.xy + b * s.yy + c * s.yz, a * s.xz + b * s.yz + c * s.zz]
    };
    let half = [half(0), half(1), half(2)];
    let component = |row: usize, column: usize| {
        half[row][0] * q[column][0] + half[row][1] * q[column][1] + half[row][2] * q[column][2]
    };
    SymmetricTensor {
        xx: component(0, 0),
        yy: component(1, 1),
        zz: component(2, 2),
        xy: component(0, 1),
        yz: component(1, 2),
        xz: component(0, 2),
    }
}

/// The rate of Jaumann to first order, `s + W s - s W`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ByRate;

impl Turning for ByRate {
    #[inline(always)]
    fn turned<D: Dim>(s: SymmetricTensor, [x, y, z]: [f64; 3]) -> SymmetricTensor {
        if D::N == 2 {
            let cross = 2.0 * z * s.xy;
            return SymmetricTensor { xx: s.xx - cross, yy: s.yy + cross, xy: s.xy + z * (s.xx - s.yy), ..s };
        }
        SymmetricTensor {
            xx: s.xx + 2.0 * (y * s.xz - z * s.xy),
            yy: s.yy + 2.0 * (z * s.xy - x * s.yz),
            zz: s.zz + 2.0 * (x * s.yz - y * s.xz),
            xy: s.xy + z * (s.xx - s.yy) + y * s.yz - x * s.xz,
            yz: s.yz + x * (s.yy - s.zz) + z * s.xz - y * s.xy,
            xz: s.xz + y * (s.zz - s.xx) + x * s.xy - z * s.yz,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use granular_core::{D2, D3};

    const STRESS: SymmetricTensor =
        SymmetricTensor { xx: 3.0, yy: -1.0, zz: 0.5, xy: 0.7, yz: -0.4, xz: 1.1 };

    fn distance(a: SymmetricTensor, b: SymmetricTensor) -> f64 {
        (a - b).contract(a - b).sqrt()
    }

    /// A rotation about z by an angle, in the plane and in space.
    fn about_z(s: SymmetricTensor, angle: f64) -> SymmetricTensor {
        let (sine, cosine) = angle.sin_cos();
        rotate(s, [[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    }

    #[test]
    fn rotations_are_exact_and_of_the_angle_that_the_spin_means() {
        let flat = SymmetricTensor { yz: 0.0, xz: 0.0, ..STRESS };
        let spin: f64 = 0.3;
        let angle = 2.0 * (0.5 * spin).atan();
        assert!(distance(ByRotation::turned::<D2>(flat, [0.0, 0.0, spin]), about_z(flat, angle)) < 1e-14);
        assert!(distance(ByRotation::turned::<D3>(STRESS, [0.0, 0.0, spin]), about_z(STRESS, angle)) < 1e-14);
        let turned = ByRotation::turned::<D3>(STRESS, [0.2, -0.5, 0.4]);
        assert!((turned.trace() - STRESS.trace()).abs() < 1e-14);
        assert!((turned.contract(turned) - STRESS.contract(STRESS)).abs() < 1e-13);
    }

    #[test]
    fn both_agree_to_first_order() {
        for k in 0..3 {
            let mut spin = [0.0; 3];
            spin[k] = 1e-5;
            let gap = distance(ByRotation::turned::<D3>(STRESS, spin), ByRate::turned::<D3>(STRESS, spin));
            assert!(gap < 1e-9 && gap > 0.0, "{gap}");
        }
        let spin = [0.0, 0.0, 1e-5];
        let flat = SymmetricTensor { yz: 0.0, xz: 0.0, ..STRESS };
        assert!(distance(ByRate::turned::<D2>(flat, spin), ByRate::turned::<D3>(flat, spin)) < 1e-15);
    }
}
