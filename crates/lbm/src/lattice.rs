//! Velocity sets: D2Q9 in the plane and D3Q19 in space.
//!
//! Direction 0 is rest; directions 2k - 1 and 2k are opposite, so the first of each pair stands for
//! both. Arrays by pair are indexed by the first direction of the pair; their other entries are
//! not used.

use crate::kernel::Rows;
use crate::real::Real;
use crate::saturated::CoveredRuns;
use granular_core::{D2, D3, Dim};

mod sealed {
    pub trait Sealed {}
    impl Sealed for super::D2Q9 {}
    impl Sealed for super::D3Q19 {}
}

/// A velocity set of `Q` directions. Sealed: only [`D2Q9`] and [`D3Q19`].
pub trait Lattice<const Q: usize>:
    sealed::Sealed + Rows<Q> + CoveredRuns<Q> + Copy + Send + Sync + 'static
{
    /// The plane or space.
    type Dim: Dim;
    /// Usual name.
    const NAME: &'static str;
    /// Velocities, in cells per step.
    const VELOCITIES: [[i32; 3]; Q];
    /// Weights; sound travels at 1/sqrt(3) cells per step.
    const WEIGHTS: [f64; Q];
    /// Even moments that carry neither mass nor stress, by direction, orthogonal to each other and to
    /// mass, momentum and the deviator of stress: energy, its square, and in space two more
    /// \[Lallemand2000, DHumieres2002\]. Directions of a pair have the same value.
    const GHOSTS: &'static [[f64; Q]];

    /// Component of a vector along the first direction of each pair.
    fn along<T: Real>(vector: [T; 3]) -> [T; Q];
    /// Sum of velocity times a number per pair.
    fn first_moment<T: Real>(odd: &[T; Q]) -> [T; 3];
    /// Sum of velocity times velocity times a number per pair: xx, yy, zz, xy, xz, yz.
    fn second_moment<T: Real>(even: &[T; Q]) -> [T; 6];
    /// Ghost moments of a number per pair and at rest; those that do not exist are zero.
    fn ghost_moments<T: Real>(even: &[T; Q]) -> [T; 4];
    /// Ghost moments in equilibrium, from the density less that at rest and the flux of momentum (xx, yy, zz).
    fn ghosts_in_equilibrium<T: Real>(excess: T, flux: [T; 6]) -> [T; 4];
    /// At rest and in the first direction of each pair: the sum of the ghosts times a number each, and what
    /// carries the deviator of a stress (xx, yy, zz, xy, xz, yz).
    fn even_parts<T: Real>(ghosts: [T; 4], stress: [T; 6]) -> [T; Q];
}

/// The direction against direction `i`.
pub const fn opposite(i: usize) -> usize {
    if i == 0 { 0 } else { ((i - 1) ^ 1) + 1 }
}

/// Nine directions in the plane \[Qian1992\].
#[derive(Clone, Copy, Debug)]
pub struct D2Q9;

/// Nineteen directions in space \[Qian1992\].
#[derive(Clone, Copy, Debug)]
pub struct D3Q19;

impl Lattice<9> for D2Q9 {
    type Dim = D2;
    const NAME: &'static str = "D2Q9";
    const VELOCITIES: [[i32; 3]; 9] = [
        [0, 0, 0],
        [1, 0, 0],
        [-1, 0, 0],
        [0, 1, 0],
        [0, -1, 0],
        [1, 1, 0],
        [-1, -1, 0],
        [1, -1, 0],
        [-1, 1, 0],
    ];
    const WEIGHTS: [f64; 9] = by_length(4.0 / 9.0, 1.0 / 9.0, 1.0 / 36.0, Self::VELOCITIES);
    const GHOSTS: &'static [[f64; 9]] =
        &[by_length(-4.0, -1.0, 2.0, Self::VELOCITIES), by_length(4.0, -2.0, 1.0, Self::VELOCITIES)];

    #[inline(always)]
    fn along<T: Real>([x, y, _]: [T; 3]) -> [T; 9] {
        let o = T::of(0.0);
        [o, x, o, y, o, x + y, o, x - y, o]
    }

    #[inline(always)]
    fn first_moment<T: Real>(odd: &[T; 9]) -> [T; 3] {
        [odd[1] + odd[5] + odd[7], odd[3] + odd[5] - odd[7], T::of(0.0)]
    }

    #[inline(always)]
    fn second_moment<T: Real>(even: &[T; 9]) -> [T; 6] {
        let diagonal = even[5] + even[7];
        let o = T::of(0.0);
        [even[1] + diagonal, even[3] + diagonal, o, even[5] - even[7], o, o]
    }

    #[inline(always)]
    fn ghost_moments<T: Real>(even: &[T; 9]) -> [T; 4] {
        let (axes, diagonals, rest) = (even[1] + even[3], even[5] + even[7], T::of(4.0) * even[0]);
        let two = T::of(2.0);
        [two * diagonals - axes - rest, diagonals - two * axes + rest, T::of(0.0), T::of(0.0)]
    }

    #[inline(always)]
    fn ghosts_in_equilibrium<T: Real>(excess: T, [xx, yy, ..]: [T; 6]) -> [T; 4] {
        let moving = T::of(3.0) * (xx + yy) - excess;
        [moving - excess, -moving, T::of(0.0), T::of(0.0)]
    }

    #[inline(always)]
    fn even_parts<T: Real>([energy, square, ..]: [T; 4], [xx, yy, _, xy, ..]: [T; 6]) -> [T; 9] {
        let (two, quarter, o) = (T::of(2.0), T::of(0.25), T::of(0.0));
        let (axis, diagonal) = (-energy - two * square, two * energy + square);
        let rest = T::of(4.0) * (square - energy);
        let (across, mixed) = (quarter * (xx - yy), quarter * xy);
        [rest, axis + across, o, axis - across, o, diagonal + mixed, o, diagonal - mixed, o]
    }
}

impl Lattice<19> for D3Q19 {
    type Dim = D3;
    const NAME: &'static str = "D3Q19";
    const VELOCITIES: [[i32; 3]; 19] = [
        [0, 0, 0],
        [1, 0, 0],
        [-1, 0, 0],
        [0, 1, 0],
        [0, -1, 0],
        [0, 0, 1],
        [0, 0, -1],
        [1, 1, 0],
        [-1, -1, 0],
        [1, -1, 0],
        [-1, 1, 0],
        [1, 0, 1],
        [-1, 0, -1],
        [1, 0, -1],
        [-1, 0, 1],
        [0, 1, 1],
        [0, -1, -1],
        [0, 1, -1],
        [0, -1, 1],
    ];
    const WEIGHTS: [f64; 19] = by_length(1.0 / 3.0, 1.0 / 18.0, 1.0 / 36.0, Self::VELOCITIES);
    const GHOSTS: &'static [[f64; 19]] = &[
        by_length(-30.0, -11.0, 8.0, Self::VELOCITIES),
        by_length(12.0, -4.0, 1.0, Self::VELOCITIES),
        // pi_xx and pi_ww of d'Humieres et al.
        [0.0, -4.0, -4.0, 2.0, 2.0, 2.0, 2.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, -2.0, -2.0, -2.0, -2.0],
        [0.0, 0.0, 0.0, -2.0, -2.0, 2.0, 2.0, 1.0, 1.0, 1.0, 1.0, -1.0, -1.0, -1.0, -1.0, 0.0, 0.0, 0.0, 0.0],
    ];

    #[inline(always)]
    fn along<T: Real>([x, y, z]: [T; 3]) -> [T; 19] {
        let o = T::of(0.0);
        [o, x, o, y, o, z, o, x + y, o, x - y, o, x + z, o, x - z, o, y + z, o, y - z, o]
    }

    #[inline(always)]
    fn first_moment<T: Real>(d: &[T; 19]) -> [T; 3] {
        [
            d[1] + (d[7] + d[9]) + (d[11] + d[13]),
            d[3] + (d[7] - d[9]) + (d[15] + d[17]),
            d[5] + (d[11] - d[13]) + (d[15] - d[17]),
        ]
    }

    #[inline(always)]
    fn second_moment<T: Real>(e: &[T; 19]) -> [T; 6] {
        let (xy, xz, yz) = (e[7] + e[9], e[11] + e[13], e[15] + e[17]);
        [e[1] + xy + xz, e[3] + xy + yz, e[5] + xz + yz, e[7] - e[9], e[11] - e[13], e[15] - e[17]]
    }

    #[inline(always)]
    fn ghost_moments<T: Real>(e: &[T; 19]) -> [T; 4] {
        let (xy, xz, yz) = (e[7] + e[9], e[11] + e[13], e[15] + e[17]);
        let (across, axes, diagonals) = (e[3] + e[5], e[1] + e[3] + e[5], xy + xz + yz);
        let (two, four) = (T::of(2.0), T::of(4.0));
        [
            T::of(8.0) * diagonals - T::of(11.0) * axes - T::of(30.0) * e[0],
            diagonals - four * axes + T::of(12.0) * e[0],
            two * (across - yz) - four * e[1] + (xy + xz),
            two * (e[5] - e[3]) + (xy - xz),
        ]
    }

    #[inline(always)]
    fn ghosts_in_equilibrium<T: Real>(excess: T, [xx, yy, zz, ..]: [T; 6]) -> [T; 4] {
        let half = T::of(0.5);
        let (across, difference) = (yy + zz, yy - zz);
        let trace = xx + across;
        [
            T::of(19.0) * trace - T::of(11.0) * excess,
            T::of(3.0) * excess - T::of(5.5) * trace,
            half * across - xx,
            -(half * difference),
        ]
    }

    #[inline(always)]
    fn even_parts<T: Real>([energy, square, along, across]: [T; 4], stress: [T; 6]) -> [T; 19] {
        let (two, four, quarter, o) = (T::of(2.0), T::of(4.0), T::of(0.25), T::of(0.0));
        let [xx, yy, zz, ..] = stress;
        let [.., xy, xz, yz] = stress.map(|component| quarter * component);
        // On the axes, and on the diagonals, the parts along x and across it.
        let (x, w) = (T::of(1.0 / 36.0) * (two * xx - yy - zz), T::of(1.0 / 12.0) * (yy - zz));
        let rest = T::of(12.0) * square - T::of(30.0) * energy;
        let axis = -(T::of(11.0) * energy + four * square);
        let diagonal = T::of(8.0) * energy + square;
        let (on_x, on_w) = (x - two * along, w - two * across);
        let (off_x, off_w) = (x + along, w + across);
        let (pxy, pxz, pyz) =
            (diagonal + (off_x + off_w), diagonal + (off_x - off_w), diagonal - two * off_x);
        [
            rest,
            axis + two * on_x,
            o,
            axis - (on_x - on_w),
            o,
            axis - (on_x + on_w),
            o,
            pxy + xy,
            o,
            pxy - xy,
            o,
            pxz + xz,
            o,
            pxz - xz,
            o,
            pyz + yz,
            o,
            pyz - yz,
            o,
        ]
    }
}

/// A number per direction that depends on its length alone.
const fn by_length<const Q: usize>(
    rest: f64,
    axis: f64,
    diagonal: f64,
    velocities: [[i32; 3]; Q],
) -> [f64; Q] {
    let mut values = [0.0; Q];
    let mut i = 0;
    while i < Q {
        let [x, y, z] = velocities[i];
        values[i] = match x * x + y * y + z * z {
            0 => rest,
            1 => axis,
            _ => diagonal,
        };
        i += 1;
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    fn agree<L: Lattice<Q>, const Q: usize>() {
        let values: [f64; Q] = std::array::from_fn(|i| ((7 * i + 3) % 11) as f64);
        let moments = L::ghost_moments(&values);
        for k in 0..4 {
            let ghost = L::GHOSTS.get(k).copied().unwrap_or([0.0; Q]);
            // Each pair counts once.
            let pairs: f64 = (1..Q).step_by(2).map(|i| ghost[i] * values[i]).sum();
            assert_eq!(moments[k], ghost[0] * values[0] + pairs, "{} {k}", L::NAME);
            let unit = std::array::from_fn(|other| f64::from(u8::from(other == k)));
            if k < L::GHOSTS.len() {
                let parts = L::even_parts(unit, [0.0; 6]);
                assert!((0..Q).filter(|i| *i == 0 || i % 2 == 1).all(|i| parts[i] == ghost[i]), "{parts:?}");
            }
        }
    }

    /// Sums of pairs from a number per direction.
    fn pairs<const Q: usize>(f: [f64; Q]) -> [f64; Q] {
        std::array::from_fn(|i| if i % 2 == 1 { f[i] + f[i + 1] } else { f[i] })
    }

    fn equilibrium<L: Lattice<Q>, const Q: usize>() {
        let velocity = [0.02, -0.05, if L::Dim::N == 3 { 0.03 } else { 0.0 }];
        let even = pairs(crate::open::equilibrium::<L, Q>(0.25, velocity));
        let [x, y, z] = velocity.map(|c| 1.25 * c * c);
        let expected = L::ghosts_in_equilibrium(0.25, [x, y, z, 0.0, 0.0, 0.0]);
        for (found, expected) in L::ghost_moments(&even).into_iter().zip(expected) {
            assert!((found - expected).abs() < 1e-14, "{} {found} {expected}", L::NAME);
        }
    }

    fn deviator<L: Lattice<Q>, const Q: usize>() {
        let stress =
            if L::Dim::N == 3 { [0.3, -0.2, 0.7, 0.4, -0.5, 0.6] } else { [0.3, -0.2, 0.0, 0.4, 0.0, 0.0] };
        let parts = L::even_parts([0.0; 4], stress);
        let even = std::array::from_fn(|i| if i % 2 == 1 { 2.0 * parts[i] } else { parts[i] });
        let trace = stress[..3].iter().sum::<f64>() / L::Dim::N as f64;
        for (i, found) in L::second_moment(&even).into_iter().enumerate() {
            let expected = if i < L::Dim::N { stress[i] - trace } else { stress[i] };
            assert!((found - expected).abs() < 1e-14, "{} {i} {found} {expected}", L::NAME);
        }
        assert!(L::ghost_moments(&even).into_iter().all(|moment| moment.abs() < 1e-14), "{}", L::NAME);
    }

    #[test]
    fn moments_in_equilibrium_and_parts_of_the_stress_are_those_of_the_populations() {
        equilibrium::<D2Q9, 9>();
        equilibrium::<D3Q19, 19>();
        deviator::<D2Q9, 9>();
        deviator::<D3Q19, 19>();
    }

    #[test]
    fn ghosts_are_computed_as_they_are_defined() {
        agree::<D2Q9, 9>();
        agree::<D3Q19, 19>();
    }
}
