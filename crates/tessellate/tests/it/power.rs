//! Power cells of spheres.

use crate::support::Random;
use granular_core::glam::DVec3;
use granular_tessellate::power_cells;

fn spheres(count: usize, largest: f64, seed: u64) -> (Vec<DVec3>, Vec<f64>) {
    let mut random = Random(seed);
    let mut sphere = || (random.point().extend(random.unit()), largest * random.unit());
    (0..count).map(|_| sphere()).unzip()
}

#[test]
fn volumes_sum_to_the_box_and_faces_are_mutual() {
    for (seed, (count, largest)) in
        [(1, 0.1), (2, 0.5), (60, 0.0), (300, 0.05), (300, 0.4)].into_iter().enumerate()
    {
        let (positions, radii) = spheres(count, largest, seed as u64);
        let cells = power_cells(&positions, &radii, DVec3::ZERO, DVec3::ONE).unwrap();
        let sum: f64 = cells.iter().map(|cell| cell.volume).sum();
        assert!((sum - 1.0).abs() < 1e-12, "{count} {largest}: {sum}");
        for (site, cell) in cells.iter().enumerate() {
            assert!(cell.volume >= -1e-15);
            for &(other, area) in &cell.faces {
                let back = cells[other].faces.iter().find(|face| face.0 == site).map_or(0.0, |face| face.1);
                assert!((area - back).abs() < 1e-12, "{site} {other}: {area} {back}");
            }
        }
    }
}

#[test]
fn volumes_are_those_of_sampling() {
    let (positions, radii) = spheres(20, 0.3, 7);
    let cells = power_cells(&positions, &radii, DVec3::ZERO, DVec3::ONE).unwrap();
    let mut counts = [0_u32; 20];
    let n = 60;
    for k in 0..n * n * n {
        let at = |k: i32| (f64::from(k) + 0.5) / f64::from(n);
        let point = DVec3::new(at(k % n), at(k / n % n), at(k / (n * n)));
        let power = |site: &usize| (point - positions[*site]).length_squared() - radii[*site] * radii[*site];
        let nearest = (0..20).min_by(|a, b| power(a).total_cmp(&power(b))).unwrap();
        counts[nearest] += 1;
    }
    for (cell, count) in cells.iter().zip(counts) {
        assert!(
            (cell.volume - f64::from(count) / f64::from(n * n * n)).abs() < 2e-3,
            "{} {count}",
            cell.volume
        );
    }
}

#[test]
fn a_cubic_lattice_has_cubes() {
    let n = 5;
    let at = |k: usize| DVec3::new((k % n) as f64, (k / n % n) as f64, (k / (n * n)) as f64) + 0.5;
    let positions: Vec<DVec3> = (0..n * n * n).map(at).collect();
    let cells = power_cells(&positions, &vec![0.5; n * n * n], DVec3::ZERO, DVec3::splat(n as f64)).unwrap();
    assert!(cells.iter().all(|cell| (cell.volume - 1.0).abs() < 1e-14));
    // Faces of area zero, where four cells meet in a line, may remain.
    let faces = |k: usize| cells[k].faces.iter().filter(|(_, area)| *area > 1e-12).count();
    assert_eq!(faces(n * n * n / 2), 6);
}
