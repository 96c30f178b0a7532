use super::*;
use granular_core::glam::DVec3;
use granular_core::random::Chance;

fn norm(tensor: SymmetricTensor) -> f64 {
    tensor.contract(tensor).sqrt()
}

fn random(chance: &mut Chance) -> SymmetricTensor {
    let mut one = || chance.between(-1.0, 1.0);
    SymmetricTensor { xx: one(), yy: one(), zz: one(), xy: one(), yz: one(), xz: one() }
}

fn unit(chance: &mut Chance) -> DVec3 {
    loop {
        let v = DVec3::new(chance.between(-1.0, 1.0), chance.between(-1.0, 1.0), chance.between(-1.0, 1.0));
        if v.length() > 0.1 && v.length() < 1.0 {
            return v.normalize();
        }
    }
}

/// A tensor by principal values along random axes.
fn turned(chance: &mut Chance, values: [f64; 3]) -> SymmetricTensor {
    let a = unit(chance);
    let b = a.cross(unit(chance)).normalize();
    let c = a.cross(b);
    SymmetricTensor::dyad(a, a) * values[0]
        + SymmetricTensor::dyad(b, b) * values[1]
        + SymmetricTensor::dyad(c, c) * values[2]
}

fn check<A: Axes>(tensor: SymmetricTensor) -> [f64; 3] {
    let Principal { values, directions } = A::principal(tensor);
    let size = norm(tensor);
    let [a, b, c] = values;
    assert!(a >= b && b >= c, "{values:?}");
    assert!((a + b + c - tensor.trace()).abs() <= 4e-15 * size, "{values:?}");
    assert!((a * a + b * b + c * c - size * size).abs() <= 1e-14 * size * size, "{values:?}");
    let back = A::with_values(&directions, values);
    assert!(norm(back - tensor) <= 2e-15 * size, "{tensor:?} comes back as {back:?}");
    // The square has the same axes.
    let square = A::with_values(&directions, [a.abs(), b.abs(), c.abs()].map(|value| value + size));
    assert!(
        (square.contract(tensor) - values.iter().map(|v| v * (v.abs() + size)).sum::<f64>()).abs()
            <= 1e-14 * size * size
    );
    values
}

#[test]
fn values_and_axes_of_random_tensors_are_right_to_round_off() {
    let mut chance = Chance::new(1);
    for _ in 0..100_000 {
        let size = 10.0_f64.powf(chance.between(-9.0, 9.0));
        let tensor = random(&mut chance) * size;
        check::<InSpace>(tensor);
        let plane = SymmetricTensor { yz: 0.0, xz: 0.0, ..tensor };
        let (one, two) = (check::<InPlane>(plane), check::<InSpace>(plane));
        assert!((0..3).all(|i| (one[i] - two[i]).abs() <= 2e-15 * norm(plane)), "{one:?} {two:?}");
    }
}

#[test]
fn values_that_are_given_come_out_however_close_they_are() {
    let mut chance = Chance::new(2);
    for trial in 0..100_000 {
        let mut values = [0, 1, 2].map(|_| chance.between(-1.0, 1.0));
        let apart = 10.0_f64.powf(chance.between(-17.0, 0.0));
        match trial % 4 {
            0 => values[1] = values[0] + apart,
            1 => values = [values[0], values[0] + apart, values[0] - apart],
            2 => values = [values[0], values[0] + apart, values[0] + apart],
            _ => {}
        }
        let found = check::<InSpace>(turned(&mut chance, values));
        values.sort_by(|a, b| b.total_cmp(a));
        let worst = (0..3).map(|i| (found[i] - values[i]).abs()).fold(0.0, f64::max);
        assert!(worst <= 2e-15, "{found:?} of {values:?}");
    }
}

#[test]
fn equal_values_on_the_diagonal_are_equal_to_the_last_bit() {
    let mut chance = Chance::new(3);
    for _ in 0..1000 {
        let [a, b] = [chance.between(-1e6, 1e6), chance.between(-1e6, 1e6)];
        for [xx, yy, zz] in [[a, a, b], [a, b, a], [b, a, a], [a, a, a]] {
            let tensor = SymmetricTensor { xx, yy, zz, ..SymmetricTensor::ZERO };
            let Principal { values, directions } = InSpace::principal(tensor);
            assert!(values[0] == values[1] || values[1] == values[2], "{values:?}");
            let back = InSpace::with_values(&directions, values);
            assert!([back.xy, back.yz, back.xz].iter().all(|shear| *shear == 0.0), "{back:?}");
        }
        // Within the plane as well; across it only to round-off, since values in the plane are mean and half difference.
        let plane =
            InPlane::principal(SymmetricTensor { xx: a, yy: a, zz: b, ..SymmetricTensor::ZERO }).values;
        assert!(plane[0] == plane[1] || plane[1] == plane[2], "{plane:?}");
    }
}

#[test]
fn no_stress_and_what_is_not_finite_go_through() {
    assert_eq!(check::<InSpace>(SymmetricTensor::ZERO), [0.0; 3]);
    assert_eq!(check::<InPlane>(SymmetricTensor::ZERO), [0.0; 3]);
    for broken in [f64::NAN, f64::INFINITY] {
        let tensor = SymmetricTensor { xy: broken, xx: 1.0, ..SymmetricTensor::ZERO };
        assert!(InSpace::principal(tensor).values.iter().any(|value| !value.is_finite()));
        assert!(InPlane::principal(tensor).values.iter().any(|value| !value.is_finite()));
    }
}
