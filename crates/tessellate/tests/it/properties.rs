//! What must not change a diagram, and what another program finds.

use crate::support::{Random, unit_square};
use granular_core::glam::DVec2;
use granular_tessellate::{Diagram, Domain};
use proptest::prelude::*;
use spade::{DelaunayTriangulation, Point2, Triangulation};

fn sites(seed: u64, count: usize, largest: f64) -> (Vec<DVec2>, Vec<f64>) {
    let mut random = Random(seed);
    (0..count).map(|_| (random.point(), largest * random.unit())).unzip()
}

/// Areas, and pairs of neighbours.
fn result(positions: &[DVec2], radii: &[f64], corners: &[DVec2]) -> (Vec<f64>, Vec<[usize; 2]>) {
    let domain = Domain::polygon(corners).unwrap();
    let diagram = Diagram::new(positions, radii).unwrap();
    (diagram.cells(&domain).areas().to_vec(), diagram.dual())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn motions_and_scales_change_nothing(
        seed in any::<u64>(),
        count in 1_usize..60,
        largest in 0.0..0.3,
        angle in 0.0..7.0,
        scale in prop::sample::select(vec![1.0, 1e-12, 3e7, 1e12]),
        shift in -2.0..2.0,
    ) {
        let (positions, radii) = sites(seed, count, largest);
        let corners: Vec<DVec2> = unit_square().corners().collect();
        let (areas, pairs) = result(&positions, &radii, &corners);
        let moved = |p: &DVec2| (DVec2::from_angle(angle).rotate(*p) + DVec2::splat(shift)) * scale;
        let positions: Vec<DVec2> = positions.iter().map(moved).collect();
        let corners: Vec<DVec2> = corners.iter().map(moved).collect();
        let radii: Vec<f64> = radii.iter().map(|radius| radius * scale).collect();
        let (again, pairs_again) = result(&positions, &radii, &corners);
        prop_assert_eq!(pairs, pairs_again);
        for (a, b) in areas.iter().zip(again) {
            prop_assert!((a - b / (scale * scale)).abs() < 1e-11, "{} {}", a, b / (scale * scale));
        }
    }

    #[test]
    fn the_order_of_sites_does_not_matter(seed in any::<u64>(), count in 1_usize..60, largest in 0.0..0.5) {
        let (positions, radii) = sites(seed, count, largest);
        let mut random = Random(!seed);
        let mut order: Vec<usize> = (0..count).collect();
        (1..count).rev().for_each(|k| order.swap(k, random.below(k + 1)));
        let corners: Vec<DVec2> = unit_square().corners().collect();
        let (areas, pairs) = result(&positions, &radii, &corners);
        let shuffled: (Vec<DVec2>, Vec<f64>) = order.iter().map(|&k| (positions[k], radii[k])).unzip();
        let (again, pairs_again) = result(&shuffled.0, &shuffled.1, &corners);
        let mut renamed: Vec<[usize; 2]> = pairs_again
            .iter()
            .map(|&[a, b]| [order[a].min(order[b]), order[a].max(order[b])])
            .collect();
        renamed.sort_unstable();
        prop_assert_eq!(pairs, renamed);
        for (k, area) in again.iter().enumerate() {
            prop_assert!((area - areas[order[k]]).abs() < 1e-14);
        }
    }

    #[test]
    fn adding_to_all_radii_changes_nothing(seed in any::<u64>(), count in 1_usize..40, more in -0.2..0.5) {
        let (positions, radii) = sites(seed, count, 0.3);
        let corners: Vec<DVec2> = unit_square().corners().collect();
        let (areas, pairs) = result(&positions, &radii, &corners);
        let radii: Vec<f64> = radii.iter().map(|radius| radius + more).collect();
        let (again, pairs_again) = result(&positions, &radii, &corners);
        prop_assert_eq!(pairs, pairs_again);
        prop_assert!(areas.iter().zip(again).all(|(a, b)| (a - b).abs() < 1e-12));
    }

    #[test]
    fn disks_of_one_size_give_the_delaunay_triangulation(seed in any::<u64>(), count in 3_usize..400) {
        let (positions, _) = sites(seed, count, 0.0);
        let mut other = DelaunayTriangulation::<Point2<f64>>::new();
        for point in &positions {
            other.insert(Point2::new(point.x, point.y)).unwrap();
        }
        let mut pairs: Vec<[usize; 2]> = other
            .undirected_edges()
            .map(|edge| edge.vertices().map(|vertex| vertex.fix().index()))
            .map(|[a, b]| [a.min(b), a.max(b)])
            .collect();
        pairs.sort_unstable();
        let radii = vec![0.01; count];
        prop_assert_eq!(Diagram::new(&positions, &radii).unwrap().dual(), pairs);
    }
}

#[test]
fn a_disk_lies_in_its_own_cell_if_disks_do_not_overlap() {
    // Rows of disks of two sizes that touch: ordinary cells would cut the large ones.
    let (large, small) = (0.07, 0.03);
    let mut positions = Vec::new();
    let mut radii = Vec::new();
    for row in 0..5 {
        for column in 0..5 {
            let odd = (row + column) % 2 == 1;
            positions.push(DVec2::new(0.1 + 0.1001 * f64::from(column), 0.1 + 0.1001 * f64::from(row)));
            radii.push(if odd { small } else { large });
        }
    }
    let domain = unit_square();
    let cells = |radii: &[f64]| {
        let diagram = Diagram::new(&positions, radii).unwrap();
        let cells = diagram.cells(&domain);
        // Nearest point of the boundary to the centre, less the radius.
        let clear = |site: usize| {
            let sides = cells.boundary(site).into_iter().flatten().filter(|side| side.neighbour.is_some());
            let points = sides.flat_map(|side| (0..=100).map(move |k| side.point(f64::from(k) / 100.0)));
            points.map(|point| (point - positions[site]).length()).fold(f64::INFINITY, f64::min)
        };
        (0..25).map(clear).collect::<Vec<f64>>()
    };
    assert!(cells(&radii).iter().zip(&radii).all(|(clear, radius)| clear >= radius));
    assert!(cells(&[0.0; 25]).iter().zip(&radii).any(|(clear, radius)| clear < radius));
}
