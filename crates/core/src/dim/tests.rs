use super::*;
use proptest::prelude::*;

fn close(a: DVec3, b: DVec3) -> bool {
    (a - b).length() <= 1e-12 * (1.0 + a.length() + b.length())
}

proptest! {
    #[test]
    fn the_plane_is_a_slice_of_space(a in [-1.0..1.0, -1.0..1.0f64], b in [-1.0..1.0, -1.0..1.0f64], w in -1.0..1.0f64) {
        let (a2, b2) = (DVec2::from(a), DVec2::from(b));
        let (a3, b3) = (a2.extend(0.0), b2.extend(0.0));
        prop_assert_eq!(D2::cross(a2, b2), D3::cross(a3, b3).z);
        prop_assert!(close(D2::turn(w, a2).extend(0.0), D3::turn(DVec3::about_z(w), a3)));
    }

    #[test]
    fn rotations_are_those_of_quaternions_and_of_the_plane(
        v in [-1.0..1.0, -1.0..1.0, -1.0..1.0f64],
        a in [-4.0..4.0, -4.0..4.0, -4.0..4.0f64],
        b in [-4.0..4.0, -4.0..4.0, -4.0..4.0f64],
    ) {
        let [v, a, b] = [v, a, b].map(DVec3::from);
        prop_assert!(close(D3::rotated(v, a), DQuat::from_scaled_axis(a) * v));
        let both = D3::rotation_after(a, b);
        prop_assert!(both.length() <= std::f64::consts::PI * (1.0 + 1e-12));
        prop_assert!((D3::rotated(v, both) - D3::rotated(D3::rotated(v, a), b)).length() < 1e-13);
        let flat = D2::rotated(v.truncate(), a.z);
        prop_assert!(close(flat.extend(0.0), D3::rotated(DVec3::new(v.x, v.y, 0.0), DVec3::new(0.0, 0.0, a.z))));
        prop_assert!(close(flat.extend(0.0), (glam::DVec2::from_angle(a.z).rotate(v.truncate())).extend(0.0)));
    }

    #[test]
    fn a_tangential_vector_survives_its_dual(v in [-1.0..1.0, -1.0..1.0, -1.0..1.0f64], n in [0.1..1.0, -1.0..1.0, -1.0..1.0f64]) {
        let normal = DVec3::from(n).normalize();
        let vector = DVec3::from(v);
        let tangential = vector - normal * vector.dot(normal);
        prop_assert!(close(D3::turn(D3::cross(normal, vector), normal), tangential));
    }

    #[test]
    fn following_a_contact_keeps_the_length(s in [-1.0..1.0, 0.2..1.0, -1.0..1.0f64], twist in -0.1..0.1f64) {
        let followed = D3::follow(DVec3::from(s), DVec3::Z, twist);
        prop_assert!((followed.length() - DVec3::from(s).length()).abs() < 1e-14);
        prop_assert!(followed.z.abs() < 1e-15);
    }
}

#[test]
fn small_rotations_are_kept() {
    let (first, then) = (DVec3::new(3e-12, 0.0, 0.0), DVec3::new(0.0, 2e-11, 0.0));
    assert!((D3::rotation_after(first, then) - (first + then)).length() < 1e-20);
    assert_eq!(D3::rotation_after(DVec3::ZERO, DVec3::ZERO), DVec3::ZERO);
    assert!(
        (D3::rotated(DVec3::X, DVec3::new(0.0, 0.0, 1e-9)) - DVec3::new(1.0, 1e-9, 0.0)).length() < 1e-17
    );
    // A quarter about z and then one about x takes x to y to z.
    let quarter = std::f64::consts::FRAC_PI_2;
    let both = D3::rotation_after(DVec3::Z * quarter, DVec3::X * quarter);
    assert!((D3::rotated(DVec3::X, both) - DVec3::Z).length() < 1e-15);
}

#[test]
fn components_are_counted() {
    assert_eq!(DVec2::from_slice(&[1.0, 2.0]), DVec2::new(1.0, 2.0));
    assert!(<DVec2 as Vector>::from_slice(&[1.0]).is_none());
    assert!(<DVec3 as Vector>::from_slice(&[1.0, 2.0]).is_none());
}

/// A normal that turns steadily was, half a step ago, where it is known to have been, to the second order in the step, in the
/// plane as in space.
#[test]
fn a_normal_was_where_it_came_from() {
    let missed = |time: f64| {
        let (now, rate) = (glam::DVec2::X, glam::DVec2::new(5.0, 3.0));
        let flat = D2::normal_before(now, || rate, time);
        let space = D3::normal_before(now.extend(0.0), || rate.extend(0.0), time);
        assert_eq!(space.truncate(), flat);
        (flat - glam::DVec2::from_angle(-3.0 * time)).length()
    };
    let (coarse, fine) = (missed(1e-2), missed(1e-3));
    assert!(coarse < 1e-3 && fine < 0.0101 * coarse, "{coarse} {fine}");
}
