//! Collision of cells that grains cover in part: see [`crate::immersed`].
//!
//! The kernels of the fluid are used as they are, on short strips: what the grains make of the populations is found before, and
//! taken with their weight after.

use crate::collision::{Parameters, Parts, With};
use crate::immersed::PieceCells;
use crate::kernel::Rows;
use crate::lattice::{D2Q9, D3Q19, Lattice};
use crate::real::Real;
use crate::relax::{field_of, with_field};
use granular_core::Dim;
use multiversion::multiversion;

/// Cells of a strip.
const STRIP: usize = 32;

/// Collision of a run of covered cells.
pub trait CoveredRuns<const Q: usize>: Rows<Q> {
    /// As [`Rows::collide_row`], with the weights and velocities of grains.
    #[doc(hidden)]
    #[allow(private_interfaces, private_bounds)]
    fn collide_covered<T: Real, P: Parts>(
        rows: [&mut [T]; Q],
        cells: PieceCells<'_, T>,
        field: [&[T]; 3],
        parameters: &Parameters<T>,
    );
}

/// What a grain makes of a cell.
struct Bounced<T, const Q: usize> {
    /// Populations as they leave, by the slot in which they are stored: each in that of the direction against it.
    stored: [T; Q],
    /// Momentum, half of the force included, and density.
    momentum: [T; 3],
    density: T,
}

/// Populations that bounce off a grain with a velocity: `f_-i + f_i^eq(rho, v) - f_-i^eq(rho, u)`.
#[inline(always)]
fn bounced<L: Lattice<Q>, T: Real, const Q: usize>(f: &[T; Q], own: [T; 3], force: [T; 3]) -> Bounced<T, Q> {
    let (mut excess, mut odd) = (f[0], [T::of(0.0); Q]);
    for i in (1..Q).step_by(2) {
        excess += f[i] + f[i + 1];
        odd[i] = f[i] - f[i + 1];
    }
    let density = T::of(1.0) + excess;
    let inverse = T::of(1.0) / density;
    let mut momentum = L::first_moment(&odd);
    let (mut sum, mut difference) = ([T::of(0.0); 3], [T::of(0.0); 3]);
    for axis in 0..3 {
        momentum[axis] += T::of(0.5) * force[axis];
        let velocity = momentum[axis] * inverse;
        // Once the factors of the equilibrium.
        sum[axis] = T::of(3.0) * density * (own[axis] + velocity);
        difference[axis] = T::of(1.5) * (own[axis] - velocity);
    }
    let work = T::of(1.0 / 3.0) * (sum[0] * difference[0] + sum[1] * difference[1] + sum[2] * difference[2]);
    let (flow, dynamic) = (L::along(sum), L::along(difference));
    let mut stored = *f;
    stored[0] = f[0] - T::of(L::WEIGHTS[0]) * work;
    for i in (1..Q).step_by(2) {
        let weight = T::of(L::WEIGHTS[i]);
        let (even, odd) = (weight * (dynamic[i] * flow[i] - work), weight * flow[i]);
        stored[i] = f[i] + (even - odd);
        stored[i + 1] = f[i + 1] + (even + odd);
    }
    Bounced { stored, momentum, density }
}

macro_rules! covered {
    ($lattice:ident, $q:literal, $bounce:ident, $blend:ident, $($row:ident $i:literal),+) => {
        #[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx512bw+fma", "x86_64+avx2+fma"))]
        #[allow(clippy::too_many_arguments)]
        fn $bounce<T: Real, P: Parts>(
            $($row: &[T],)+
            cells: &mut PieceCells<'_, T>,
            field: [&[T]; 3],
            parameters: &Parameters<T>,
            scratch: &mut [[T; STRIP]; $q],
        ) {
            let count = [$($row.len()),+, STRIP].into_iter().min().unwrap_or(0);
            $(let $row = &$row[..count];)+
            let PieceCells { velocity, momentum, density, .. } = cells;
            let axes = <$lattice as Lattice<$q>>::Dim::N;
            let velocity: [&[T]; 3] = std::array::from_fn(|axis| if axis < axes { &velocity[axis][..count] } else { &[] });
            let [x, y, z] = momentum.each_mut();
            let (x, y, density) = (&mut x[..count], &mut y[..count], &mut density[..count]);
            let z = if axes > 2 { &mut z[..count] } else { &mut [][..] };
            let field = field_of::<$lattice, T, P, $q>(field, 0..count);
            for k in 0..count {
                let force = with_field::<$lattice, T, P, $q>(parameters, field, k).force;
                let own = std::array::from_fn(|axis| if axis < axes { velocity[axis][k] } else { T::of(0.0) });
                let cell = bounced::<$lattice, T, $q>(&[$($row[k]),+], own, force);
                $(scratch[$i][k] = cell.stored[$i];)+
                (x[k], y[k], density[k]) = (cell.momentum[0], cell.momentum[1], cell.density);
                if axes > 2 {
                    z[k] = cell.momentum[2];
                }
            }
        }

        #[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx512bw+fma", "x86_64+avx2+fma"))]
        #[allow(clippy::too_many_arguments)]
        fn $blend<T: Real>($($row: &mut [T],)+ weight: &[T], scratch: &[[T; STRIP]; $q]) {
            let count = weight.len().min(STRIP);
            let weight = &weight[..count];
            $(
                let (row, stored) = (&mut $row[..count], &scratch[$i][..count]);
                for k in 0..count {
                    row[k] = (T::of(1.0) - weight[k]) * row[k] + weight[k] * stored[k];
                }
            )+
        }

        impl CoveredRuns<$q> for $lattice {
            #[allow(private_interfaces, private_bounds)]
            fn collide_covered<T: Real, P: Parts>(
                rows: [&mut [T]; $q],
                mut cells: PieceCells<'_, T>,
                field: [&[T]; 3],
                parameters: &Parameters<T>,
            ) {
                let [$($row),+] = rows;
                let count = cells.weight.len();
                let mut scratch = [[T::default(); STRIP]; $q];
                for start in (0..count).step_by(STRIP) {
                    let end = (start + STRIP).min(count);
                    $(let $row = &mut $row[start..end];)+
                    let mut strip = cells.part(start..end);
                    let field = field.map(|values| values.get(start..end).unwrap_or(&[]));
                    if P::FIELD {
                        $bounce::<T, With<false, true, false, true>>($($row,)+ &mut strip, field, parameters, &mut scratch);
                    } else {
                        $bounce::<T, With<false, true, false, false>>($($row,)+ &mut strip, field, parameters, &mut scratch);
                    }
                    // A strip that is full is solid alone.
                    let weight = strip.weight;
                    if weight.iter().any(|weight| *weight < T::of(1.0)) {
                        Self::collide_row::<T, P>([$(&mut *$row),+], field, parameters);
                    }
                    $blend::<T>($($row,)+ weight, &scratch);
                }
            }
        }
    };
}

covered!(D2Q9, 9, bounce_d2q9, blend_d2q9, r0 0, r1 1, r2 2, r3 3, r4 4, r5 5, r6 6, r7 7, r8 8);
covered!(
    D3Q19, 19, bounce_d3q19, blend_d3q19, r0 0, r1 1, r2 2, r3 3, r4 4, r5 5, r6 6, r7 7, r8 8, r9 9, r10 10,
    r11 11, r12 12, r13 13, r14 14, r15 15, r16 16, r17 17, r18 18
);
