//! What is in the way at an inlet, sorted by place, so that a box that is full costs no more than one that is not.

use super::Inlet;
use granular_core::{Dim, Linear, Vector};

/// Most cells that a box is cut into.
const MOST_CELLS: f64 = 4096.0;

/// Centre and radius of a grain \[m\].
pub(super) type Ball<D> = (<D as Dim>::Vec, f64);

/// Grains in the box of an inlet and around it, in cells no smaller than the largest diameter.
pub(super) struct Room<D: Dim> {
    low: D::Vec,
    edge: f64,
    cells: [usize; 3],
    members: Vec<Vec<Ball<D>>>,
}

impl<D: Dim> Room<D> {
    /// The box of an inlet with the grains that reach into it.
    pub(super) fn of(inlet: &Inlet<D>, near: Vec<Ball<D>>) -> Self {
        let radii = inlet.radii.iter().copied().chain(near.iter().map(|(_, radius)| *radius));
        // A smaller number would not grow below.
        let mut edge = (2.0 * radii.fold(0.0, f64::max)).max(f64::MIN_POSITIVE);
        let counts = |edge: f64| -> [f64; 3] {
            std::array::from_fn(|axis| match axis < D::N {
                true => ((inlet.high - inlet.low).component(axis) / edge).floor().max(1.0),
                false => 1.0,
            })
        };
        while counts(edge).iter().product::<f64>() > MOST_CELLS {
            edge *= 1.25;
        }
        let cells = counts(edge).map(|count| count as usize);
        let members = vec![Vec::new(); cells.iter().product()];
        let mut room = Self { low: inlet.low, edge, cells, members };
        near.into_iter().for_each(|(at, radius)| room.add(at, radius));
        room
    }

    /// The cell of a place along each axis. What lies outside belongs to the cells at the border, which separates no
    /// neighbours.
    fn cell(&self, at: D::Vec) -> [usize; 3] {
        std::array::from_fn(|axis| match axis < D::N {
            true => (((at - self.low).component(axis) / self.edge) as usize).min(self.cells[axis] - 1),
            false => 0,
        })
    }

    fn number(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.cells[1] + y) * self.cells[0] + x
    }

    /// Takes in a grain.
    pub(super) fn add(&mut self, at: D::Vec, radius: f64) {
        let cell = self.number(self.cell(at));
        self.members[cell].push((at, radius));
    }

    /// Whether a grain at a place would overlap none.
    pub(super) fn has_place(&self, at: D::Vec, radius: f64) -> bool {
        let centre = self.cell(at);
        let range =
            |axis: usize| centre[axis].saturating_sub(1)..=(centre[axis] + 1).min(self.cells[axis] - 1);
        let free =
            |&(other, reach): &Ball<D>| (at - other).length_squared() >= (radius + reach) * (radius + reach);
        range(2).all(|z| {
            range(1).all(|y| range(0).all(|x| self.members[self.number([x, y, z])].iter().all(free)))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::MaterialId;
    use granular_core::glam::{DVec2, DVec3};
    use granular_core::{D2, D3};

    fn inlet<D: Dim>(high: D::Vec, radii: Vec<f64>) -> Inlet<D> {
        let (low, velocity) = (D::Vec::ZERO, D::Vec::ZERO);
        let (name, material) = ("in".to_owned(), MaterialId::of_index(0));
        Inlet { name, low, high, rate: 1.0, number: 1, radii, velocity, material, seed: 1, runs: true }
    }

    #[test]
    fn a_room_finds_what_brute_force_finds() {
        // Numbers between 0 and 1 without a pattern that cells could share.
        let share = |k: usize, of: f64| (k as f64 * of).fract();
        let size = DVec3::new(1.0, 0.7, 0.4);
        let radius = |k: usize| 0.01 + 0.04 * share(k, 0.381_966);
        let place = |k: usize| {
            size * DVec3::new(share(k, 0.754_877), share(k, 0.569_840), share(k, 0.430_160)) * 1.1 - 0.05
        };
        let near: Vec<Ball<D3>> = (0..80).map(|k| (place(k), radius(k))).collect();
        let room = Room::<D3>::of(&inlet::<D3>(size, vec![0.03]), near.clone());
        let (mut free, tried) = (0, 1000);
        for k in 80..80 + tried {
            let (at, radius) = (place(k), radius(k));
            let expected = near.iter().all(|(other, reach)| (at - *other).length() >= radius + reach);
            assert_eq!(room.has_place(at, radius), expected);
            free += usize::from(expected);
        }
        assert!(free > tried / 10 && free < 9 * tried / 10, "{free}");
    }

    #[test]
    fn boxes_of_any_size_have_few_cells() {
        for width in [1e-3, 1.0, 1e300, 1.7e308] {
            let high = DVec2::new(width, 2e-3);
            for radius in [0.5e-3, 5e-324] {
                let room = Room::<D2>::of(&inlet::<D2>(high, vec![radius]), Vec::new());
                assert!(room.members.len() as f64 <= MOST_CELLS && room.has_place(0.5 * high, radius));
            }
        }
    }
}
