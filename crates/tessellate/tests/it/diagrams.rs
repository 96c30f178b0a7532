//! Diagrams with known cells, and random ones against brute force.

use crate::support::{Random, distance, in_cell, unit_square, violation};
use granular_core::glam::DVec2;
use granular_tessellate::{Diagram, Domain};

fn sites(count: usize, largest: f64, random: &mut Random) -> (Vec<DVec2>, Vec<f64>) {
    (0..count).map(|_| (random.point(), largest * random.unit())).unzip()
}

#[test]
fn two_disks_share_a_box_along_a_hyperbola() {
    let domain = Domain::rectangle(DVec2::splat(-2.0), DVec2::splat(2.0)).unwrap();
    let centres = [DVec2::new(-1.0, 0.0), DVec2::new(1.0, 0.0)];
    let equal = Diagram::new(&centres, &[0.3, 0.3]).unwrap();
    assert_eq!(equal.cells(&domain).areas(), [8.0, 8.0]);
    let unequal = Diagram::new(&centres, &[0.5, 0.1]).unwrap();
    let edge = unequal.edges().next().unwrap();
    assert!((edge.curve.point(0.0) - DVec2::new(0.2, 0.0)).length() < 1e-15);
    // x = 0.2 sqrt(1 + y^2 / 0.96): 8 and twice the integral over 0..2.
    let (a, b) = (0.2, 0.96_f64.sqrt());
    let y = 2.0 / b;
    let beyond = a * b * (y * (1.0 + y * y).sqrt() + y.asinh());
    let areas = unequal.cells(&domain).areas().to_vec();
    assert!((areas[0] - 8.0 - beyond).abs() < 1e-14, "{areas:?}");
    assert!((areas[0] + areas[1] - 16.0).abs() < 1e-14);
}

#[test]
fn hidden_and_touching_disks_have_no_cell() {
    let centres = [DVec2::ZERO, DVec2::new(0.3, 0.0), DVec2::new(0.5, 0.0), DVec2::ZERO];
    let diagram = Diagram::new(&centres, &[1.0, 0.5, 0.5, 1.0]).unwrap();
    let hidden: Vec<_> = (0..4).map(|site| diagram.hidden_by(site)).collect();
    assert_eq!(hidden, [None, Some(0), Some(0), Some(0)]);
}

#[test]
fn random_diagrams_obey_the_definition() {
    let domain = unit_square();
    for seed in 0..300 {
        let mut random = Random(seed);
        let count = 1 + random.below(60);
        let largest = [0.0, 1e-3, 0.05, 0.3, 1.0][seed as usize % 5];
        let (positions, radii) = sites(count, largest, &mut random);
        let diagram = Diagram::new(&positions, &radii).unwrap();
        assert_eq!(violation(&diagram, &domain, 1e-12), None, "seed {seed}, {count} sites");
    }
}

#[test]
fn points_lie_in_the_cell_of_the_nearest_disk() {
    let domain = unit_square();
    for seed in 0..40 {
        let mut random = Random(1000 + seed);
        let (positions, radii) = sites(12, [0.02, 0.2, 0.6][seed as usize % 3], &mut random);
        let diagram = Diagram::new(&positions, &radii).unwrap();
        let cells = diagram.cells(&domain);
        for _ in 0..100 {
            let point = random.point();
            let nearest = diagram.nearest(point);
            let least = distance(&diagram, nearest, point);
            for site in 0..12 {
                let further = distance(&diagram, site, point) - least;
                if site == nearest || further > 1e-3 {
                    // Points next to a border are left out: the test draws curves as polygons.
                    let others = (0..12).filter(|&other| other != nearest);
                    let margin = others.map(|other| distance(&diagram, other, point) - least);
                    if margin.fold(f64::INFINITY, f64::min) > 1e-3 {
                        assert_eq!(in_cell(&cells, site, point), site == nearest, "{seed} {site} {point}");
                    }
                }
            }
        }
    }
}
