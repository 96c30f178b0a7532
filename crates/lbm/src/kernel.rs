//! The loop over a row of cells, compiled for several instruction sets; the program takes the widest
//! that the processor has. All give the same bits: no operation is fused or reordered. (Fused products and
//! sums were tried: 5 % faster with one relaxation time in the plane, 4 % slower in space.)
//!
//! A cell with a closure waits for two divisions and two roots, one after the other. Loops over a strip that
//! stays in the nearest cache compute what waits, so that many cells wait together, and a last one collides:
//! a fifth faster. Without a closure the second read of populations costs more than waiting.

use crate::collision::{Parameters, Parts};
use crate::lattice::{D2Q9, D3Q19};
use crate::real::Real;
use crate::relax::{State, collide, field_of, rates, state, with_field};
use multiversion::multiversion;

/// Length of a strip in cache lines, and the most cells that are.
const STRIP_LINES: usize = 32;
const LONGEST_STRIP: usize = STRIP_LINES * 16;

/// Collision of a row of cells.
pub trait Rows<const Q: usize> {
    /// Collides the cells of a row: population `i` comes from `rows[i]`, and what leaves along `i`
    /// goes to the row of the direction against it. All rows are equally long. `field` has the force of each cell
    /// along each axis of the lattice, if there is one.
    #[doc(hidden)]
    #[allow(private_interfaces, private_bounds)]
    fn collide_row<T: Real, P: Parts>(rows: [&mut [T]; Q], field: [&[T]; 3], parameters: &Parameters<T>);
}

/// One function argument per direction: only then does the compiler know that rows do not overlap.
macro_rules! rows {
    ($lattice:ident, $q:literal, $function:ident, $($row:ident $against:literal),+) => {
        #[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx512bw+fma", "x86_64+avx2+fma"))]
        #[allow(clippy::too_many_arguments)]
        fn $function<T: Real, P: Parts>($($row: &mut [T],)+ field: [&[T]; 3], parameters: &Parameters<T>) {
            let cells = [$($row.len()),+].into_iter().min().unwrap_or(0);
            $(let $row = &mut $row[..cells];)+
            if !P::CLOSURE {
                let field = field_of::<$lattice, T, P, $q>(field, 0..cells);
                for x in 0..cells {
                    let here = with_field::<$lattice, T, P, $q>(parameters, field, x);
                    let parameters = if P::FIELD { &here } else { parameters };
                    let f = [$($row[x]),+];
                    let state = state::<$lattice, T, P, $q>(&f, parameters);
                    let rates = rates::<T, P>(state, parameters);
                    let after = collide::<$lattice, T, P, $q>(&f, state, rates, parameters);
                    $($row[x] = after[$against];)+
                }
                return;
            }
            let mut numbers = [[T::default(); LONGEST_STRIP]; 4];
            let mut start = 0;
            while start < cells {
                let end = (start + STRIP_LINES * T::LINE).min(cells);
                let [excess, inverse, even, odd] = numbers.each_mut().map(|values| &mut values[..end - start]);
                $(let $row = &mut $row[start..end];)+
                let field = field_of::<$lattice, T, P, $q>(field, start..end);
                for x in 0..end - start {
                    let here = with_field::<$lattice, T, P, $q>(parameters, field, x);
                    let parameters = if P::FIELD { &here } else { parameters };
                    let state = state::<$lattice, T, P, $q>(&[$($row[x]),+], parameters);
                    (excess[x], inverse[x], even[x]) = (state.excess, state.inverse, state.squared);
                }
                for x in 0..end - start {
                    let state = State { excess: excess[x], inverse: inverse[x], squared: even[x] };
                    [even[x], odd[x]] = rates::<T, P>(state, parameters);
                }
                for x in 0..end - start {
                    let here = with_field::<$lattice, T, P, $q>(parameters, field, x);
                    let parameters = if P::FIELD { &here } else { parameters };
                    let state = State { excess: excess[x], inverse: inverse[x], squared: T::of(0.0) };
                    let f = [$($row[x]),+];
                    let after = collide::<$lattice, T, P, $q>(&f, state, [even[x], odd[x]], parameters);
                    $($row[x] = after[$against];)+
                }
                start = end;
            }
        }

        impl Rows<$q> for $lattice {
            #[allow(private_interfaces, private_bounds)]
            fn collide_row<T: Real, P: Parts>(
                rows: [&mut [T]; $q],
                field: [&[T]; 3],
                parameters: &Parameters<T>,
            ) {
                let [$($row),+] = rows;
                $function::<T, P>($($row,)+ field, parameters);
            }
        }
    };
}

rows!(D2Q9, 9, collide_row_d2q9, r0 0, r1 2, r2 1, r3 4, r4 3, r5 6, r6 5, r7 8, r8 7);
rows!(
    D3Q19, 19, collide_row_d3q19, r0 0, r1 2, r2 1, r3 4, r4 3, r5 6, r6 5, r7 8, r8 7, r9 10, r10 9, r11 12,
    r12 11, r13 14, r14 13, r15 16, r16 15, r17 18, r18 17
);
