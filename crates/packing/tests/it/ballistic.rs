//! Deposits against their definition: no overlap, inside the box, every disk on two supports.

use granular_core::D2;
use granular_core::glam::DVec2;
use granular_core::search::CellGrid;
use granular_packing::{Bands, Deposit, Grading, Sides, Support, ballistic, solid_fraction_bands};
use proptest::prelude::*;
use std::time::Instant;

/// Largest overlap and largest gap at a support, over the smaller radius; panics when a
/// centre does not lie between its supports.
struct Quality {
    overlap: f64,
    open_support: f64,
}

/// Images of `other` that may touch a disk at `point`.
fn images(other: DVec2, width: f64, sides: Sides) -> impl Iterator<Item = DVec2> {
    let shifts = if sides == Sides::Periodic { -1..=1 } else { 0..=0 };
    shifts.map(move |shift| other + DVec2::new(f64::from(shift) * width, 0.0))
}

fn largest_overlap(deposit: &Deposit, radii: &[f64], width: f64, sides: Sides) -> f64 {
    let largest = radii.iter().copied().fold(0.0, f64::max);
    let mut grid = CellGrid::<D2>::default();
    grid.fill(&deposit.positions, 2.001 * largest);
    let mut overlap = f64::NEG_INFINITY;
    for (i, &point) in deposit.positions.iter().enumerate() {
        for image in images(point, width, sides) {
            grid.visit_around(image, |j| {
                let j = j as usize;
                let gap = (deposit.positions[j] - image).length() - radii[i] - radii[j];
                if i != j {
                    overlap = overlap.max(-gap / radii[i].min(radii[j]));
                }
            });
        }
        overlap = overlap.max(1.0 - point.y / radii[i]);
        if sides == Sides::Walls {
            overlap = overlap.max(1.0 - point.x / radii[i]).max(1.0 - (width - point.x) / radii[i]);
        } else {
            assert!((0.0..width).contains(&point.x));
        }
    }
    overlap
}

/// Horizontal distance from the centre to a support, and the gap there: one pair, or one for
/// each image that touches in a narrow periodic box.
fn touching(
    deposit: &Deposit,
    radii: &[f64],
    width: f64,
    sides: Sides,
    index: usize,
    which: usize,
) -> Vec<(f64, f64)> {
    let (point, radius) = (deposit.positions[index], radii[index]);
    match deposit.supports[index][which] {
        Support::Floor => vec![(0.0, point.y - radius)],
        Support::LeftWall => vec![(-radius, point.x - radius)],
        Support::RightWall => vec![(radius, width - point.x - radius)],
        Support::Grain(other) => {
            assert!((other as usize) < index, "supports are older");
            let reach = radius + radii[other as usize];
            images(deposit.positions[other as usize], width, sides)
                .map(|image| (image.x - point.x, (image - point).length() - reach))
                .filter(|near| near.1.abs() < 1e-9 * reach)
                .collect()
        }
    }
}

fn quality(deposit: &Deposit, radii: &[f64], width: f64, sides: Sides) -> Quality {
    let mut open_support = 0.0_f64;
    for (index, &radius) in radii.iter().enumerate() {
        let first = touching(deposit, radii, width, sides, index, 0);
        let second = touching(deposit, radii, width, sides, index, 1);
        // Round-off may put a disk that is held on both sides beside the top of its support.
        let side = |x: f64| if x.abs() < 1e-12 * radius { 0.0 } else { x };
        let between = first.iter().any(|a| second.iter().any(|b| side(a.0) * side(b.0) <= 0.0));
        assert!(between, "disk {index} is not between its supports: {first:?} {second:?}");
        for (_, gap) in first.into_iter().chain(second) {
            open_support = open_support.max(gap.abs() / radius);
        }
    }
    Quality { overlap: largest_overlap(deposit, radii, width, sides), open_support }
}

/// Solid fraction of the middle, ten diameters or more away from floor and surface.
fn bulk_density(deposit: &Deposit, radii: &[f64], width: f64) -> f64 {
    let diameter = 2.0 * radii.iter().copied().fold(0.0, f64::max);
    // The surface lies above nine tenths of the centres.
    let mut heights: Vec<f64> = deposit.positions.iter().map(|point| point.y).collect();
    heights.sort_unstable_by(f64::total_cmp);
    let (low, high) = (10.0 * diameter, heights[heights.len() * 9 / 10] - 10.0 * diameter);
    let bands = Bands { base: width, low, high, thickness: high - low };
    solid_fraction_bands::<D2>(&deposit.positions, radii, &bands).expect("bands in the pile")[0]
}

#[test]
fn one_size_packs_to_the_density_of_the_literature() {
    let (radii, seeds) = (vec![0.5; 30_000], 16);
    let densities: Vec<f64> = (0..seeds)
        .map(|seed| {
            let deposit = ballistic(&radii, 400.0, Sides::Periodic, seed).unwrap();
            bulk_density(&deposit, &radii, 400.0)
        })
        .collect();
    let mean = densities.iter().sum::<f64>() / seeds as f64;
    let variance = densities.iter().map(|density| (density - mean).powi(2)).sum::<f64>() / (seeds - 1) as f64;
    let error = (variance / seeds as f64).sqrt();
    println!("bulk density of one size, periodic, {seeds} seeds: {mean:.4} +- {error:.4}, {densities:.4?}");
    // The demand is "near 0.82" (literature as the checklist quotes it). Equal disks repeat the gaps of the first layers all
    // the way up, so that one seed scatters however high the pile is.
    assert!(densities.iter().all(|density| (0.81..0.83).contains(density)), "{densities:?}");
    assert!((mean - 0.82).abs() < 0.004, "{mean}");
}

#[test]
fn a_large_deposit_is_sound_and_quick() {
    let grading = Grading::Beta { min: 0.92e-3, max: 1.38e-3, a: 4.0, b: 4.0 };
    for (count, width) in [(3000, 68e-3), (100_000, 230e-3)] {
        let radii = grading.sample::<D2>(count, 1).unwrap();
        for sides in [Sides::Walls, Sides::Periodic] {
            let start = Instant::now();
            let deposit = ballistic(&radii, width, sides, 1).unwrap();
            let seconds = start.elapsed().as_secs_f64();
            let Quality { overlap, open_support } = quality(&deposit, &radii, width, sides);
            let density = if count > 10_000 { bulk_density(&deposit, &radii, width) } else { f64::NAN };
            println!(
                "{count} disks, {sides:?}: {seconds:.4} s, overlap {overlap:.1e} r, gap at supports \
                 {open_support:.1e} r, bulk density {density:.4}, repeated {}",
                deposit.repeated
            );
            assert!(overlap < 1e-12 && open_support < 1e-11);
            assert_eq!(deposit.repeated, 0);
            // Generous: other programs may share the machine.
            assert!(seconds < 10.0);
        }
    }
}

#[test]
fn wide_gradings_are_sound() {
    let grading = Grading::Beta { min: 1.0, max: 6.0, a: 4.0, b: 4.0 };
    let radii = grading.sample::<D2>(5000, 3).unwrap();
    for sides in [Sides::Walls, Sides::Periodic] {
        let Quality { overlap, open_support } =
            quality(&ballistic(&radii, 150.0, sides, 3).unwrap(), &radii, 150.0, sides);
        assert!(overlap < 1e-12 && open_support < 1e-11, "{overlap:e} {open_support:e}");
    }
}

#[test]
fn narrow_boxes_are_sound() {
    // Below two diameters a disk meets both images of its neighbour.
    for sides in [Sides::Walls, Sides::Periodic] {
        for tenth in 20..60 {
            let (radii, width) = (vec![1.0; 200], f64::from(tenth) * 0.1);
            let deposit = ballistic(&radii, width, sides, tenth as u64).unwrap();
            let Quality { overlap, open_support } = quality(&deposit, &radii, width, sides);
            assert!(
                overlap < 1e-12 && open_support < 1e-10,
                "{sides:?} {width}: {overlap:e} {open_support:e}"
            );
        }
    }
}

#[test]
fn many_sizes_with_exact_ties_need_no_second_drop() {
    // Twenty sizes in turn: a disk often falls exactly onto the middle of an equal one.
    let radii: Vec<f64> = (0..500).map(|k| 0.5 / f64::from(1 + k * 7 % 20)).collect();
    for seed in (0..50).chain([1133, 3283, 3643]) {
        for sides in [Sides::Walls, Sides::Periodic] {
            assert_eq!(ballistic(&radii, 10.0, sides, seed).unwrap().repeated, 0, "seed {seed}");
        }
    }
}

/// Radii on a coarse lattice of values, so that equal sizes and exact ties are common.
fn any_radii() -> impl Strategy<Value = Vec<f64>> {
    prop_oneof![
        prop::collection::vec(0.3..1.0_f64, 1..300),
        prop::collection::vec((1..=4_u8).prop_map(|quarter| f64::from(quarter) * 0.25), 1..300),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn every_disk_is_supported_and_none_overlap(
        radii in any_radii(), width in 2.0..30.0_f64, seed in any::<u64>(), walls in any::<bool>(),
    ) {
        let sides = if walls { Sides::Walls } else { Sides::Periodic };
        let deposit = ballistic(&radii, width, sides, seed).unwrap();
        let Quality { overlap, open_support } = quality(&deposit, &radii, width, sides);
        prop_assert!(overlap < 1e-12, "overlap {overlap:e}");
        prop_assert!(open_support < 1e-11, "gap at a support {open_support:e}");
        prop_assert_eq!(&deposit, &ballistic(&radii, width, sides, seed).unwrap());
    }

    #[test]
    fn scaling_by_a_power_of_two_keeps_every_bit(
        radii in any_radii(), power in -20..=20_i32, seed in any::<u64>(), walls in any::<bool>(),
    ) {
        let (sides, scale) = (if walls { Sides::Walls } else { Sides::Periodic }, 2.0_f64.powi(power));
        let scaled: Vec<f64> = radii.iter().map(|radius| radius * scale).collect();
        let one = ballistic(&radii, 7.0, sides, seed).unwrap();
        let other = ballistic(&scaled, 7.0 * scale, sides, seed).unwrap();
        prop_assert!(one.positions.iter().zip(&other.positions).all(|(a, b)| *a * scale == *b));
        prop_assert_eq!(one.supports, other.supports);
    }

    #[test]
    fn any_scale_is_sound(radii in any_radii(), decade in -6.0..6.0_f64, seed in any::<u64>()) {
        let scale = 10.0_f64.powf(decade);
        let scaled: Vec<f64> = radii.iter().map(|radius| radius * scale).collect();
        let deposit = ballistic(&scaled, 9.0 * scale, Sides::Periodic, seed).unwrap();
        let Quality { overlap, open_support } = quality(&deposit, &scaled, 9.0 * scale, Sides::Periodic);
        prop_assert!(overlap < 1e-12 && open_support < 1e-11, "{overlap:e} {open_support:e}");
    }
}
