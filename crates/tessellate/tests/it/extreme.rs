//! Adversarial diagrams. `GRANULAR_DIAGRAMS` sets how many; few by default.

use crate::support::{Random, unit_square, violation};
use granular_core::glam::DVec2;
use granular_tessellate::{Diagram, Domain};

type Sites = (Vec<DVec2>, Vec<f64>);

/// Points of a lattice, square or sheared, some doubled; radii equal, of few sizes, or random.
fn lattice(random: &mut Random) -> Sites {
    let (columns, rows) = (1 + random.below(6), 1 + random.below(6));
    let shear = [0.0, 0.5, 0.25][random.below(3)];
    let spacing = [1.0, 0.1, 1.0 / 3.0][random.below(3)];
    let sizes = [1, 2, 1000][random.below(3)];
    let mut sites = Sites::default();
    for j in 0..rows {
        for i in 0..columns {
            let point = DVec2::new(i as f64 + shear * j as f64, j as f64) * spacing;
            let radius = spacing * 0.5 * (1 + random.below(sizes)) as f64 / sizes as f64;
            for _ in 0..1 + random.below(8) / 7 {
                sites.0.push(point);
                sites.1.push(radius);
            }
        }
    }
    sites
}

/// Disks that stand on one line, hang from one, or touch a common circle.
fn aligned(random: &mut Random) -> Sites {
    let kind = random.below(4);
    let disk = |random: &mut Random| {
        let radius = [0.05, 0.1, 0.05 + 0.05 * random.unit()][random.below(3)];
        let along = [random.unit(), random.below(9) as f64 / 8.0][random.below(2)];
        let position = match kind {
            0 => DVec2::new(along, 0.25 + radius),
            1 => DVec2::new(0.75 - radius, along),
            2 => DVec2::splat(0.5) + DVec2::from_angle(7.0 * along) * (0.3 + radius),
            _ => DVec2::new(along, along),
        };
        (position, radius)
    };
    let count = 2 + random.below(20);
    (0..count).map(|_| disk(random)).unzip()
}

/// Random disks, each repeated a few units in the last place away.
fn near_duplicates(random: &mut Random) -> Sites {
    let mut sites = Sites::default();
    for _ in 0..1 + random.below(8) {
        let (position, radius) = (random.point(), 0.2 * random.unit());
        for _ in 0..1 + random.below(3) {
            let step = |random: &mut Random| (random.below(5) as f64 - 2.0) * f64::EPSILON * 0.25;
            sites.0.push(position + DVec2::new(step(random), step(random)));
            sites.1.push(radius + step(random));
        }
    }
    sites
}

/// Radii over six decades.
fn graded(random: &mut Random) -> Sites {
    let count = 2 + random.below(30);
    (0..count).map(|_| (random.point(), 0.5 * 10f64.powf(-6.0 * random.unit()))).unzip()
}

/// Disks that lie in others and touch them from inside, nearly.
fn nested(random: &mut Random) -> Sites {
    let mut sites = Sites::default();
    for _ in 0..1 + random.below(5) {
        let (centre, radius) = (random.point(), 0.1 + 0.2 * random.unit());
        sites.0.push(centre);
        sites.1.push(radius);
        for _ in 0..random.below(4) {
            let inner = radius * [0.5, 0.25, random.unit()][random.below(3)];
            let direction = DVec2::from_angle([0.0, 1.5, 6.0 * random.unit()][random.below(3)]);
            let outward = 1.0 + [0.0, 1e-15, -1e-15, 1e-6][random.below(4)];
            sites.0.push(centre + direction * (radius - inner) * outward);
            sites.1.push(inner);
        }
    }
    sites
}

fn plain(random: &mut Random) -> Sites {
    let largest = [0.0, 0.05, 0.5][random.below(3)];
    let count = 1 + random.below(40);
    (0..count).map(|_| (random.point(), largest * random.unit())).unzip()
}

fn diagram(number: u64) -> (Sites, f64) {
    let mut random = Random(number);
    let kinds = [lattice, aligned, near_duplicates, graded, nested, plain];
    let sites = kinds[random.below(kinds.len())](&mut random);
    (sites, [1.0, 1e-12, 1e12][random.below(3)])
}

/// Numbers of the diagrams that break a rule, with the reason.
fn broken(numbers: std::ops::Range<u64>) -> Vec<String> {
    let square = unit_square();
    numbers
        .filter_map(|number| {
            let ((positions, radii), scale) = diagram(number);
            let positions: Vec<DVec2> = positions.iter().map(|&p| p * scale).collect();
            let radii: Vec<f64> = radii.iter().map(|r| r * scale).collect();
            let corners: Vec<DVec2> = square.corners().map(|p| p * scale).collect();
            let domain = Domain::polygon(&corners).unwrap();
            let diagram = Diagram::new(&positions, &radii).unwrap();
            let reason = violation(&diagram, &domain, 1e-12)?;
            Some(format!("{number}: {} sites, scale {scale}: {reason}", positions.len()))
        })
        .collect()
}

#[test]
fn adversarial_diagrams_obey_the_definition() {
    let count = std::env::var("GRANULAR_DIAGRAMS").ok().and_then(|text| text.parse().ok()).unwrap_or(3000);
    let broken = broken(0..count);
    assert!(
        broken.is_empty(),
        "{} of {count}:\n{}",
        broken.len(),
        broken.iter().take(20).cloned().collect::<Vec<_>>().join("\n")
    );
}
