//! Neighbours of balls of very different sizes.
//!
//! In one grid whose cells hold the largest balls, each small one would meet thousands of others: at a ratio of sizes of
//! 100 a cell of the plane has room for 10 000. So balls are parted by size into levels, each with a grid of its own, and
//! a ball looks in every level as far as it and the largest ball of that level reach \[Krijgsman2014\].

use super::{CellGrid, Neighbours};
use crate::dim::Dim;

/// Sizes of one level span this factor.
const SPAN: f64 = 2.0;
/// Levels from the largest number to the smallest. The ratio of two numbers may overflow, the number of levels may not.
const MOST_LEVELS: f64 = 2100.0;

/// Sorts balls by size and place, and visits neighbours.
#[derive(Clone, Debug, Default)]
pub struct SizeLevels<D: Dim> {
    /// The largest first.
    levels: Vec<Level<D>>,
    skin: f64,
}

#[derive(Clone, Debug, Default)]
struct Level<D: Dim> {
    grid: CellGrid<D>,
    positions: Vec<D::Vec>,
    members: Vec<u32>,
    /// Radius of its largest ball \[m\]; zero when it has none.
    largest: f64,
}

impl<D: Dim> SizeLevels<D> {
    /// Largest over smallest radius above which levels are worth their cost.
    pub const WIDE: f64 = 6.0;

    /// Whether balls from the smallest to the largest of these radii \[m\] should be parted into levels.
    pub fn suits(smallest: f64, largest: f64) -> bool {
        largest > Self::WIDE * smallest
    }

    /// Sorts balls with these centres and positive radii \[m\], so that those with surfaces nearer than `skin` \[m\] are
    /// found.
    pub fn fill(&mut self, positions: &[D::Vec], radii: &[f64], skin: f64) {
        let (smallest, largest) =
            radii.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), &r| (a.min(r), b.max(r)));
        self.skin = skin;
        let level_of = |radius: f64| ((largest / radius).ln() / SPAN.ln()).min(MOST_LEVELS) as usize;
        let count = if radii.is_empty() { 0 } else { level_of(smallest) + 1 };
        self.levels.resize_with(count, Level::default);
        for level in &mut self.levels {
            level.positions.clear();
            level.members.clear();
            level.largest = 0.0;
        }
        for ((&position, &radius), index) in positions.iter().zip(radii).zip(0..) {
            let level = &mut self.levels[level_of(radius).min(count - 1)];
            level.positions.push(position);
            level.members.push(index);
            level.largest = level.largest.max(radius);
        }
        for level in &mut self.levels {
            level.grid.fill(&level.positions, 2.0 * level.largest + skin);
        }
    }
}

impl<D: Dim> Neighbours<D> for SizeLevels<D> {
    #[inline(always)]
    fn visit_near(&self, position: D::Vec, radius: f64, mut visit: impl FnMut(u32)) {
        for level in self.levels.iter().filter(|level| !level.members.is_empty()) {
            let reach = radius + level.largest + self.skin;
            level.grid.visit_within(position, reach, |member| visit(level.members[member as usize]));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dim::{D2, D3, Linear};
    use glam::{DVec2, DVec3};
    use proptest::prelude::*;

    /// Pairs by levels and by brute force.
    fn pairs<D: Dim>(positions: &[D::Vec], radii: &[f64], skin: f64) -> [Vec<(u32, u32)>; 2] {
        let near =
            |i: usize, j: usize| j < i && (positions[i] - positions[j]).length() < radii[i] + radii[j] + skin;
        let mut levels = SizeLevels::<D>::default();
        // A second fill must not remember the first.
        levels.fill(&positions[..positions.len() / 2], &radii[..radii.len() / 2], 0.5 * skin);
        levels.fill(positions, radii, skin);
        let mut found = Vec::new();
        for (i, (&position, &radius)) in positions.iter().zip(radii).enumerate() {
            levels.visit_near(position, radius, |j| {
                if near(i, j as usize) {
                    found.push((i as u32, j));
                }
            });
        }
        found.sort_unstable();
        let all = (0..radii.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
        let expected = all.filter(|&(i, j)| near(i, j)).map(|(i, j)| (i as u32, j as u32)).collect();
        [found, expected]
    }

    proptest! {
        #[test]
        fn levels_find_the_pairs_of_brute_force_in_the_plane(
            balls in prop::collection::vec((-3.0..3.0, -1.0..2.0f64, -3.0..0.0f64), 0..200), skin in 0.001..0.1f64
        ) {
            let mut positions: Vec<DVec2> = balls.iter().map(|ball| DVec2::new(ball.0, ball.1)).collect();
            let mut radii: Vec<f64> = balls.iter().map(|ball| 0.5 * 10.0_f64.powf(ball.2)).collect();
            positions.push(DVec2::new(1e9, -1e9));
            radii.push(0.01);
            let [found, expected] = pairs::<D2>(&positions, &radii, skin);
            prop_assert_eq!(found, expected);
        }

        #[test]
        fn levels_find_the_pairs_of_brute_force_in_space(
            balls in prop::collection::vec((-1.0..1.0, -1.0..1.0, -1.0..1.0f64, -2.0..0.0f64), 0..150)
        ) {
            let positions: Vec<DVec3> = balls.iter().map(|ball| DVec3::new(ball.0, ball.1, ball.2)).collect();
            let radii: Vec<f64> = balls.iter().map(|ball| 0.3 * 10.0_f64.powf(ball.3)).collect();
            let [found, expected] = pairs::<D3>(&positions, &radii, 0.02);
            prop_assert_eq!(found, expected);
        }
    }

    #[test]
    fn any_ratio_of_sizes_has_levels() {
        for (small, large) in [(5e-324, 1e-3), (5e-324, 1e150), (1e-300, 1e8)] {
            let positions = [DVec2::ZERO, DVec2::new(0.5 * large, 0.0)];
            let [found, expected] = pairs::<D2>(&positions, &[large, small], 0.0);
            assert_eq!(found, expected);
            assert_eq!(found, [(1, 0)]);
        }
    }

    #[test]
    fn small_balls_beside_a_large_one_meet_their_neighbours_only() {
        let mut positions: Vec<DVec2> =
            (0..10_000).map(|i| DVec2::new((i % 100) as f64, (i / 100) as f64)).collect();
        let mut radii = vec![0.5; positions.len()];
        positions.push(DVec2::new(50.0, 150.5));
        radii.push(50.0);
        let mut levels = SizeLevels::<D2>::default();
        levels.fill(&positions, &radii, 0.1);
        let mut visited = 0;
        for (&position, &radius) in positions.iter().zip(&radii) {
            levels.visit_near(position, radius, |_| visited += 1);
        }
        assert!(visited < 30 * positions.len(), "{visited} visits");
    }
}
