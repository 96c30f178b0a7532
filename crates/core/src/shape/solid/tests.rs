use super::*;
use crate::random::Chance;
use crate::shape::Shape;

/// The place `distance` against the normal lies on the surface, and no point nearer than that is on the other side of it:
/// this is what a signed distance is.
fn is_signed_distance<D: Dim>(body: &dyn SolidShape<D>, point: D::Vec, chance: &mut Chance) {
    let (distance, normal) = body.distance(point).unwrap();
    assert!((normal.length() - 1.0).abs() < 1e-12, "{normal:?}");
    assert_eq!(body.contains(point), distance <= 0.0, "{point:?} at {distance}");
    let mut away = |from: D::Vec, length: f64| {
        let way =
            (0..D::N).fold(D::Vec::ZERO, |sum, axis| sum + D::Vec::along(axis, chance.between(-1.0, 1.0)));
        body.contains(from + way * (length / way.length()))
    };
    let nearest = point - normal * distance;
    let around = (0..100).filter(|_| away(nearest, 1e-9)).count();
    assert!((1..100).contains(&around), "{nearest:?} is not on the surface");
    for _ in 0..50 {
        assert_eq!(
            away(point, 0.999 * distance.abs()),
            distance <= 0.0,
            "something is nearer to {point:?} than {distance}"
        );
    }
}

fn everywhere<D: Dim>(body: &dyn SolidShape<D>) {
    let mut chance = Chance::new(3);
    for _ in 0..300 {
        let point =
            (0..D::N).fold(D::Vec::ZERO, |sum, axis| sum + D::Vec::along(axis, chance.between(-2.0, 2.0)));
        is_signed_distance(body, point, &mut chance);
    }
}

fn notched() -> Polygon {
    let corners = [(-1.0, -1.0), (1.0, -1.2), (0.9, 1.0), (0.1, 0.2), (-0.8, 1.1)];
    Polygon { corners: corners.map(|(x, y)| DVec2::new(x, y)).to_vec() }
}

#[test]
fn distances_are_those_of_the_nearest_place_in_plane_and_space() {
    everywhere::<D2>(&Ball { centre: DVec2::new(0.2, -0.1), radius: 0.9 });
    everywhere::<D3>(&Ball { centre: DVec3::new(0.2, -0.1, 0.3), radius: 0.9 });
    everywhere::<D2>(&Block { low: DVec2::new(-1.0, -0.5), high: DVec2::new(0.5, 1.0) });
    everywhere::<D3>(&Block { low: DVec3::new(-1.0, -0.5, -0.2), high: DVec3::new(0.5, 1.0, 0.7) });
    everywhere::<D2>(&notched());
    everywhere::<D3>(&notched());
    everywhere::<D3>(&Extruded { shape: notched(), from: -0.4, to: 0.8 });
}

#[test]
fn walls_with_an_inside_are_bodies() {
    let plane = Shape::<D3>::plane(DVec3::new(0.1, 0.2, 0.3), DVec3::new(1.0, -2.0, 0.5)).unwrap();
    let block = Shape::<D3>::block(DVec3::splat(-0.7), DVec3::new(0.5, 0.6, 0.8)).unwrap();
    everywhere::<D3>(&plane);
    everywhere::<D3>(&block);
    assert!(plane.check().is_ok() && block.check().is_ok());
    let (outside, inside) = (DVec3::new(2.0, -2.0, 1.0), DVec3::new(0.0, 0.4, 0.1));
    for body in [&plane, &block] {
        let exact = body.crossing(outside, inside);
        let halved = by_halving(|at| body.contains(outside + (inside - outside) * at));
        assert!((exact - halved).abs() < 1e-13, "{exact} {halved}");
    }
    let held = Shape::<D2>::balls(&[(DVec2::ZERO, 0.5), (DVec2::X, 0.7)]).unwrap();
    assert!(
        held.check().is_ok() && held.contains(DVec2::new(1.6, 0.0)) && !held.contains(DVec2::new(0.0, 0.6))
    );
    let tube = Shape::<D3>::tube(DVec3::ZERO, DVec3::Z, 0.5).unwrap();
    assert_eq!(tube.check().unwrap_err().value, "a tube");
    assert!(!tube.contains(DVec3::ZERO));
}
