use super::*;

/// A pile of disks (radius, x, y) that stand already.
fn pile(width: f64, sides: Sides, disks: &[(f64, f64, f64)]) -> Pile {
    let largest = disks.iter().map(|disk| disk.0).fold(1.0, f64::max);
    let mut pile = Pile::new(64, width, sides, largest);
    for &(radius, x, y) in disks {
        pile.add(radius, DVec2::new(x, y));
    }
    pile
}

#[track_caller]
fn assert_rests(pile: &Pile, radius: f64, x: f64, place: [f64; 2], supports: [Support; 2]) {
    let rest = pile.settle(radius, x).expect("settles");
    assert!((rest.point - DVec2::from(place)).length() < 1e-12, "{} instead of {place:?}", rest.point);
    assert_eq!(rest.supports, supports);
}

const FLOOR: [Support; 2] = [Support::Floor; 2];

#[test]
fn a_disk_falls_onto_the_floor() {
    let empty = pile(10.0, Sides::Walls, &[]);
    assert_rests(&empty, 1.0, 4.0, [4.0, 1.0], FLOOR);
}

#[test]
fn a_disk_rolls_off_a_single_disk_to_the_floor() {
    let one = pile(10.0, Sides::Walls, &[(1.0, 5.0, 1.0)]);
    assert_rests(&one, 1.0, 5.1, [7.0, 1.0], FLOOR);
    assert_rests(&one, 1.0, 4.9, [3.0, 1.0], FLOOR);
    // A larger disk meets the floor above the equator of the small one.
    let small = pile(10.0, Sides::Walls, &[(0.25, 5.0, 0.25)]);
    assert_rests(&small, 1.0, 5.1, [6.0, 1.0], FLOOR);
    // Exactly above: towards the middle of the box.
    let left = pile(10.0, Sides::Walls, &[(1.0, 4.0, 1.0)]);
    assert_rests(&left, 1.0, 4.0, [6.0, 1.0], FLOOR);
}

#[test]
fn a_disk_rests_between_two_disks() {
    let two = pile(10.0, Sides::Walls, &[(1.0, 4.0, 1.0), (1.0, 6.0, 1.0)]);
    let top = 1.0 + 3.0_f64.sqrt();
    assert_rests(&two, 1.0, 4.1, [5.0, top], [Support::Grain(0), Support::Grain(1)]);
    assert_rests(&two, 1.0, 5.9, [5.0, top], [Support::Grain(1), Support::Grain(0)]);
    // Exactly into the hollow: both contacts at once.
    let rest = two.settle(1.0, 5.0).expect("settles");
    assert!((rest.point - DVec2::new(5.0, top)).length() < 1e-12);
}

#[test]
fn a_disk_rests_between_a_disk_and_a_wall() {
    let one = pile(10.0, Sides::Walls, &[(1.0, 1.5, 1.0)]);
    let height = 1.0 + (4.0_f64 - 0.25).sqrt();
    assert_rests(&one, 1.0, 1.4, [1.0, height], [Support::Grain(0), Support::LeftWall]);
    let mirrored = pile(10.0, Sides::Walls, &[(1.0, 8.5, 1.0)]);
    assert_rests(&mirrored, 1.0, 8.7, [9.0, height], [Support::Grain(0), Support::RightWall]);
}

#[test]
fn the_sides_repeat() {
    let one = pile(4.0, Sides::Periodic, &[(1.0, 0.5, 1.0)]);
    // The floor between the disk and its image is exactly one diameter wide.
    assert_rests(&one, 1.0, 1.0, [2.5, 1.0], FLOOR);
    let narrow = pile(3.0, Sides::Periodic, &[(1.0, 0.5, 1.0)]);
    let height = 1.0 + (4.0_f64 - 2.25).sqrt();
    assert_rests(&narrow, 1.0, 1.0, [2.0, height], [Support::Grain(0), Support::Grain(0)]);
}

#[test]
fn the_lower_disk_takes_over_on_a_staircase() {
    // From the top of the stairs down over each step to the floor.
    let stairs = [(1.0, 3.0, 3.0), (1.0, 4.6, 1.8), (0.6, 6.0, 0.6)];
    let pile = pile(20.0, Sides::Walls, &stairs);
    let reach = 1.6_f64;
    let x = 6.0 + (reach * reach - 0.4 * 0.4).sqrt();
    assert_rests(&pile, 1.0, 3.3, [x, 1.0], FLOOR);
}

#[test]
fn a_disk_is_caught_under_an_overhang() {
    // It rolls down to the right under a disk that hangs higher than its own centre.
    let pile = pile(20.0, Sides::Walls, &[(1.0, 5.0, 1.0), (1.0, 7.2, 3.7)]);
    let rest = pile.settle(1.0, 5.15).expect("settles");
    assert_eq!(rest.supports, [Support::Grain(0), Support::Grain(1)]);
    assert!(rest.point.y < 3.7 && rest.point.x > 5.0 && rest.point.x < 7.2, "{}", rest.point);
}

#[test]
fn a_box_of_one_diameter_makes_a_tower() {
    for sides in [Sides::Walls, Sides::Periodic] {
        let deposit = ballistic(&[0.5; 30], 1.0, sides, 7).unwrap();
        let top = deposit.positions[29].y;
        assert!(top <= 29.5 + 1e-9, "{top}");
        if sides == Sides::Walls {
            assert!((top - 29.5).abs() < 1e-9);
            assert!(deposit.positions.iter().all(|p| (p.x - 0.5).abs() < 1e-12));
        }
    }
}

#[test]
fn rows_of_touching_disks_and_every_dropping_place_settle() {
    // A lattice has ties everywhere: two contacts at once, straight above, grazing.
    for sides in [Sides::Walls, Sides::Periodic] {
        let mut disks: Vec<(f64, f64, f64)> = (0..8).map(|k| (1.0, 1.0 + 2.0 * f64::from(k), 1.0)).collect();
        disks.extend((0..7).map(|k| (1.0, 2.0 + 2.0 * f64::from(k), 1.0 + 3.0_f64.sqrt())));
        let pile = pile(16.0, sides, &disks);
        for step in 0..=140 {
            let rest = pile.settle(1.0, 1.0 + 0.1 * f64::from(step)).expect("settles");
            assert!(rest.point.y > 2.0);
        }
    }
}

#[test]
fn bad_requests_are_refused() {
    let error = ballistic(&[1.0, 2.0], 3.9, Sides::Walls, 0).unwrap_err();
    assert_eq!(
        error.to_string(),
        "width of the box [m] is 3.9, allowed is at least 4 (the largest diameter), finite"
    );
    assert_eq!(
        ballistic(&[1.0, 0.0], 9.0, Sides::Walls, 0).unwrap_err(),
        PackingError::Radius { index: 1, radius: 0.0 }
    );
    for (radii, width) in [(&[][..], 9.0), (&[f64::NAN], 9.0), (&[1.0], f64::NAN), (&[1.0], f64::INFINITY)] {
        assert!(ballistic(radii, width, Sides::Periodic, 0).is_err());
    }
}

#[test]
fn a_disk_exactly_on_top_goes_the_way_that_is_free() {
    // Straight above disk 0, against disk 1 at one side: towards the middle is blocked.
    for (x, other) in [(3.0, 5.0), (7.0, 5.0)] {
        let pile = pile(10.0, Sides::Walls, &[(1.0, x, 1.0), (1.0, other, 3.0)]);
        let free = if x < 5.0 { 1.0 } else { 9.0 };
        assert_rests(&pile, 1.0, x, [free, 1.0], FLOOR);
    }
    // Both sides are blocked.
    let held = pile(10.0, Sides::Walls, &[(1.0, 5.0, 1.0), (1.0, 3.0, 3.0), (1.0, 7.0, 3.0)]);
    let rest = held.settle(1.0, 5.0).expect("settles");
    assert!((rest.point - DVec2::new(5.0, 3.0)).length() < 1e-12, "{}", rest.point);
}

#[test]
fn ties_at_the_height_of_the_anchor_are_no_contact_behind() {
    // The disk loses disk 0 and touches disk 1, exactly below, at once; disk 2 is a contact on
    // the far side of disk 1, a quarter turn behind the way of the disk.
    let (small, x) = (1.0 / 6.0, 5.0 - 2.0 / 3.0);
    let pile =
        pile(10.0, Sides::Walls, &[(0.5, 5.0, 0.5), (small, x, small), (small, x + 4.0 * small, small)]);
    for step in 1..100 {
        let rest = pile.settle(small, 5.0 - 0.0066 * f64::from(step)).expect("settles");
        assert!(rest.point.x <= x, "{}", rest.point);
    }
}

/// The rest of a disk that is let down in small steps and pushed out of whatever it enters.
fn slow_motion(disks: &[(f64, DVec2)], width: f64, radius: f64, x: f64) -> DVec2 {
    let step = 1e-3;
    let top = disks.iter().map(|disk| disk.1.y + disk.0).fold(0.0, f64::max);
    let mut point = DVec2::new(x, top + 2.0 * radius);
    for _ in 0..100_000 {
        let before = point;
        point.y -= step;
        for _ in 0..30 {
            for &(other, centre) in disks {
                let apart = point - centre;
                let entered = radius + other - apart.length();
                if entered > 0.0 {
                    point += apart.normalize() * entered;
                }
            }
            point.x = point.x.clamp(radius, width - radius);
            point.y = point.y.max(radius);
        }
        if (before - point).length() < 1e-9 {
            break;
        }
    }
    point
}

#[test]
fn the_way_down_agrees_with_slow_motion() {
    let (width, mut random) = (9.0, Random::new(5));
    let mut pile = Pile::new(64, width, Sides::Walls, 1.0);
    let mut disks: Vec<(f64, DVec2)> = Vec::new();
    let mut different = 0;
    for _ in 0..40 {
        let radius = 0.3 + 0.7 * random.uniform();
        let x = radius + random.uniform() * (width - 2.0 * radius);
        let rest = pile.settle(radius, x).expect("settles");
        let slow = slow_motion(&disks, width, radius, x);
        if (slow - rest.point).length() > 0.02 {
            println!("radius {radius} from {x}: {} by slow motion {slow}", rest.point);
            different += 1;
        }
        disks.push((radius, rest.point));
        pile.add(radius, rest.point);
    }
    // Slow motion may take the other side of a disk that it meets almost on top.
    println!("{different} of 40 places differ from slow motion");
    assert!(different <= 1);
}
