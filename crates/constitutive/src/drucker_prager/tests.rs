use super::*;
use crate::axes::{InPlane, InSpace};
use crate::measures;

fn sand(cone: ConeMatch, dilation: f64) -> DruckerPrager {
    let strength = Strength {
        friction_angle: 23.2_f64.to_radians(),
        dilation_angle: dilation.to_radians(),
        cohesion: 1e4,
    };
    DruckerPrager::new(LinearElastic::new(1.98e6, 0.23).unwrap(), strength, cone).unwrap()
}

#[test]
fn slopes_are_those_of_textbooks() {
    for (cone, slope) in [
        (ConeMatch::PlaneStrain, 0.12804),
        (ConeMatch::Compression, 0.17455),
        (ConeMatch::Extension, 0.13403),
    ] {
        assert!((sand(cone, 0.0).slope() - slope).abs() < 5e-6, "{cone:?}: {}", sand(cone, 0.0).slope());
    }
    let associated = sand(ConeMatch::PlaneStrain, 23.2);
    let given = sand(ConeMatch::PlaneStrainDilation, 23.2);
    assert!((associated.slope() - given.slope()).abs() < 1e-15);
    assert!((associated.shear_strength() - given.shear_strength()).abs() < 1e-10 * given.shear_strength());
    let tangent = 23.2_f64.to_radians().tan();
    let of_cohesion = 3.0 * 1e4 / (9.0 + 12.0 * tangent * tangent).sqrt();
    assert!((associated.shear_strength() / of_cohesion - 1.0).abs() < 1e-14);
}

/// Mohr-Coulomb: `(s1 - s3) / 2 = -(s1 + s3) / 2 sin(phi) + c cos(phi)`.
fn strength_of_mohr_coulomb(stress: SymmetricTensor) -> f64 {
    let phi = 23.2_f64.to_radians();
    let [first, _, last] = InSpace::principal(stress).values;
    (first - last) / (-(first + last) * phi.sin() + 2.0 * 1e4 * phi.cos())
}

#[test]
fn cones_fit_the_pyramid_where_they_should() {
    for (cone, axial) in [(ConeMatch::Compression, -1.0), (ConeMatch::Extension, 1.0)] {
        let law = sand(cone, 0.0);
        let at = |q: f64| SymmetricTensor { yy: -1e5 + axial * q, ..SymmetricTensor::IDENTITY * -1e5 };
        let (mut low, mut high) = (0.0, 1e6);
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if law.excess(at(middle)) < 0.0 { low = middle } else { high = middle }
        }
        assert!((strength_of_mohr_coulomb(at(low)) - 1.0).abs() < 1e-12, "{cone:?}");
    }
}

/// Long simple shear in plane strain, with the normal stress free: the stress at collapse.
#[test]
fn collapse_in_plane_strain_has_the_strength_of_mohr_coulomb() {
    for (cone, dilation) in [
        (ConeMatch::PlaneStrain, 23.2),
        (ConeMatch::PlaneStrainDilation, 0.0),
        (ConeMatch::PlaneStrainDilation, 10.0),
        (ConeMatch::PlaneStrainDilation, 23.2),
    ] {
        let law = sand(cone, dilation);
        let mut stress = SymmetricTensor::IDENTITY * -1e5;
        let mut memory = law.start();
        for _ in 0..400 {
            // Volume grows by the sine of the angle of dilation times the shear.
            let shear = 1e-2;
            let volume = 0.5 * shear * dilation.to_radians().sin();
            let strain = SymmetricTensor { xx: volume, yy: volume, xy: 0.5 * shear, ..SymmetricTensor::ZERO };
            stress = law.respond::<InPlane>(stress, &mut memory, &Increment::of_strain(strain)).stress;
        }
        assert!(
            (strength_of_mohr_coulomb(stress) - 1.0).abs() < 1e-9,
            "{cone:?} {dilation}: {}",
            strength_of_mohr_coulomb(stress)
        );
    }
}

#[test]
fn pulled_sand_carries_nothing_and_its_gap_must_be_closed() {
    let elastic = LinearElastic::new(1.98e6, 0.23).unwrap();
    let law = DruckerPrager::new(elastic, Strength::of_friction(0.4), ConeMatch::PlaneStrain).unwrap();
    let mut memory = law.start();
    let all = |strain: f64| Increment::of_strain(SymmetricTensor::IDENTITY * strain);
    let pulled = law.respond::<InSpace>(SymmetricTensor::ZERO, &mut memory, &all(0.01));
    assert_eq!((pulled.stress, pulled.plastic_work), (SymmetricTensor::ZERO, 0.0));
    assert!((memory[GAP] - 0.03).abs() < 1e-15);
    let nearer = law.respond::<InSpace>(pulled.stress, &mut memory, &all(-0.006));
    assert_eq!(nearer.stress, SymmetricTensor::ZERO);
    let pressed = law.respond::<InSpace>(nearer.stress, &mut memory, &all(-0.006));
    assert!((measures::mean_pressure(pressed.stress) / (elastic.bulk() * 0.006) - 1.0).abs() < 1e-12);
    assert_eq!(memory[GAP], 0.0);
}
