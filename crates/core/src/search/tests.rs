use super::*;
use crate::{D2, D3};
use glam::{DVec2, DVec3};
use proptest::prelude::*;

fn pairs_by_grid<D: Dim>(positions: &[D::Vec], reach: f64) -> Vec<(u32, u32)> {
    let mut grid = CellGrid::<D>::default();
    grid.fill(positions, reach);
    let mut pairs = Vec::new();
    for (i, &position) in positions.iter().enumerate() {
        grid.visit_around(position, |j| {
            if j < i as u32 && (position - positions[j as usize]).length() < reach {
                pairs.push((i as u32, j));
            }
        });
    }
    pairs.sort_unstable();
    pairs
}

fn pairs_by_force<D: Dim>(positions: &[D::Vec], reach: f64) -> Vec<(u32, u32)> {
    let near = |i: usize, j: usize| (positions[i] - positions[j]).length() < reach;
    (0..positions.len())
        .flat_map(|i| (0..i).map(move |j| (i, j)))
        .filter(|&(i, j)| near(i, j))
        .map(|(i, j)| (i as u32, j as u32))
        .collect()
}

proptest! {
    #[test]
    fn the_grid_finds_the_pairs_of_brute_force_in_the_plane(
        points in prop::collection::vec((-3.0..3.0, -1.0..2.0f64), 0..200), reach in 0.01..1.0f64, far in 1.0..1e9f64
    ) {
        let mut positions: Vec<DVec2> = points.into_iter().map(DVec2::from).collect();
        positions.push(DVec2::new(far, -far));
        positions.push(DVec2::new(far + 0.5 * reach, -far));
        prop_assert_eq!(pairs_by_grid::<D2>(&positions, reach), pairs_by_force::<D2>(&positions, reach));
    }

    #[test]
    fn the_grid_finds_the_pairs_of_brute_force_in_space(
        points in prop::collection::vec((-1.0..1.0, -1.0..1.0, -1.0..1.0f64), 0..150), reach in 0.05..1.0f64
    ) {
        let positions: Vec<DVec3> = points.into_iter().map(DVec3::from).collect();
        prop_assert_eq!(pairs_by_grid::<D3>(&positions, reach), pairs_by_force::<D3>(&positions, reach));
    }

    #[test]
    fn the_curve_is_a_permutation(points in prop::collection::vec((-3.0..3.0, -1.0..2.0f64), 0..200)) {
        let positions: Vec<DVec2> = points.into_iter().map(DVec2::from).collect();
        let mut order = curve_order::<D2>(&positions, 0.1);
        order.sort_unstable();
        prop_assert_eq!(order, (0..positions.len() as u32).collect::<Vec<_>>());
    }
}

#[test]
fn a_far_ball_does_not_cost_cells() {
    let mut positions: Vec<DVec2> = (0..1000).map(|i| DVec2::new((i % 40) as f64, (i / 40) as f64)).collect();
    positions.push(DVec2::new(1e12, 1e12));
    let mut grid = CellGrid::<D2>::default();
    grid.fill(&positions, 1.5);
    assert!(grid.starts.len() <= CELLS_PER_BALL * positions.len() + 65);
    let mut most = 0;
    for &position in &positions {
        let mut visited = 0;
        grid.visit_around(position, |_| visited += 1);
        most = most.max(visited);
    }
    assert!(most < 40, "a cell holds too many balls: {most} neighbours visited");
}
