use super::*;
use crate::axes::InPlane;
use granular_core::random::Chance;

fn elastic() -> LinearElastic {
    LinearElastic::new(1e6, 0.25).unwrap()
}

const DRY: Grains = Grains::Dry { diameter: 1e-3, density: 2500.0 };
const WET: Grains = Grains::InLiquid { viscosity: 0.1 };

/// The stress after a step satisfies `stress = mu(I) p` with I of the plastic rate of the step.
fn check<F: RateFriction>(friction: F) {
    let mut chance = Chance::new(5);
    for grains in [DRY, WET] {
        let law = MuI::new(elastic(), friction, grains).unwrap();
        for _ in 0..10_000 {
            let pressure = 10.0_f64.powf(chance.between(-2.0, 6.0));
            let dt = 10.0_f64.powf(chance.between(-8.0, -1.0));
            let trial = pressure * friction.at_rest() * (1.0 + 10.0_f64.powf(chance.between(-6.0, 3.0)));
            let relaxed = law.elastic.shear() * dt;
            let stress = friction.stress(trial, pressure, relaxed, law.per_rate(pressure));
            assert!(stress >= friction.at_rest() * pressure && stress <= trial * (1.0 + 1e-15));
            let number = law.number((trial - stress) / relaxed, pressure);
            let wanted = friction.at(number) * pressure;
            // The rate is a difference: where little of the trial stress is lost its round-off counts.
            let sensitivity = law.number(1.0 / relaxed, pressure) * pressure;
            let slope = (friction.at(number * 1.000_001) - friction.at(number)) / (number * 1e-6);
            let tolerance = 1e-13 * trial * (1.0 + slope * sensitivity) + 1e-9 * (wanted - stress).abs();
            assert!(
                (stress - wanted).abs() <= 10.0 * tolerance,
                "{stress} {wanted} of {trial}, {pressure} Pa, {dt} s"
            );
        }
    }
}

#[test]
fn the_stress_after_a_step_satisfies_the_law_with_the_rate_of_the_step() {
    check(LinearFriction::new(0.22, 1.0).unwrap());
    check(SaturatingFriction::glass_beads());
}

/// Long simple shear at a number I.
fn steady<F: RateFriction>(law: &MuI<F>, number: f64, pressure: f64) -> (f64, f64) {
    let rate = number / law.number(1.0, pressure);
    let dt = 1e-4 / rate;
    let strain = SymmetricTensor { xy: 0.5 * rate * dt, ..SymmetricTensor::ZERO };
    let mut stress = SymmetricTensor::IDENTITY * -pressure;
    let mut memory = law.start();
    let mut response = Response::default();
    for _ in 0..20_000 {
        response = law.respond::<InPlane>(stress, &mut memory, &Increment { strain, dt, volume_ratio: 1.0 });
        stress = response.stress;
    }
    let lost = (response.plastic_work + response.viscous_work) / (rate * dt);
    (stress.xy / pressure, lost / pressure)
}

#[test]
fn steady_simple_shear_has_the_friction_of_its_rate() {
    for grains in [DRY, WET] {
        for number in [1e-4, 1e-2, 0.1, 1.0] {
            let linear = MuI::new(elastic(), LinearFriction::new(0.22, 1.0).unwrap(), grains).unwrap();
            let (found, lost) = steady(&linear, number, 100.0);
            assert!((found - (0.22 + number)).abs() < 1e-10, "{grains:?} {number}: {found}");
            assert!((lost - found).abs() < 1e-8, "all work is lost: {lost} of {found}");
            let beads = MuI::new(elastic(), SaturatingFriction::glass_beads(), grains).unwrap();
            let (found, _) = steady(&beads, number, 100.0);
            let wanted = 0.38 + 0.26 / (1.0 + 0.28 / number);
            assert!((found - wanted).abs() < 1e-10, "{grains:?} {number}: {found} {wanted}");
        }
    }
}

/// A uniform flow on a slope: with pressure and shear stress of depth y, the rates of the law add up to Bagnold's profile.
#[test]
fn rates_on_a_slope_add_up_to_the_profile_of_bagnold() {
    let (slope, depth, bulk_density, gravity) = (24.0_f64.to_radians(), 0.04, 1500.0, 9.81);
    let law = MuI::new(elastic(), SaturatingFriction::glass_beads(), DRY).unwrap();
    let number = 0.28 * (slope.tan() - 0.38) / (0.64 - slope.tan());
    let cells = 400;
    let height = depth / f64::from(cells);
    let mut velocity = 0.0;
    for cell in 0..cells {
        let pressure = bulk_density * gravity * slope.cos() * (depth - (f64::from(cell) + 0.5) * height);
        // The rate at which the law answers with the stress ratio of the slope.
        let (mut low, mut high) = (0.0, 1e3);
        for _ in 0..60 {
            let rate = 0.5 * (low + high);
            let ratio = law.friction().at(law.number(rate, pressure));
            if ratio < slope.tan() { low = rate } else { high = rate }
        }
        velocity += low * height;
    }
    let wanted =
        2.0 / 3.0 * number / 1e-3 * (bulk_density / 2500.0 * gravity * slope.cos()).sqrt() * depth.powf(1.5);
    assert!((velocity / wanted - 1.0).abs() < 1e-4, "{velocity} {wanted}");
}

#[test]
fn no_pressure_no_duration_and_no_strain_are_answered() {
    for grains in [DRY, WET] {
        let beads = MuI::new(elastic(), SaturatingFriction::glass_beads(), grains).unwrap();
        let linear = MuI::new(elastic(), LinearFriction::new(0.22, 0.0).unwrap(), grains).unwrap();
        let shear = SymmetricTensor { xy: 1e-3, ..SymmetricTensor::ZERO };
        for dt in [0.0, 1e-5] {
            let increment = Increment { strain: shear, dt, volume_ratio: 1.0 };
            let mut memory = [0.0; 2];
            let none = beads.respond::<InPlane>(SymmetricTensor::ZERO, &mut memory, &increment);
            assert_eq!(none.stress, SymmetricTensor::ZERO);
            let none = linear.respond::<InPlane>(SymmetricTensor::ZERO, &mut memory, &increment);
            assert_eq!(none.stress, SymmetricTensor::ZERO);
            let pressed = SymmetricTensor::IDENTITY * -100.0;
            let still = Increment { strain: SymmetricTensor::ZERO, ..increment };
            assert_eq!(beads.respond::<InPlane>(pressed, &mut memory, &still).stress, pressed);
        }
        // Very fast flow has the greatest friction.
        let increment = Increment { strain: shear, dt: 0.0, volume_ratio: 1.0 };
        let fast = beads.respond::<InPlane>(SymmetricTensor::IDENTITY * -100.0, &mut [0.0; 2], &increment);
        assert!((fast.stress.xy - 64.0).abs() < 1e-10);
    }
}

#[test]
fn constants_out_of_range_are_refused() {
    assert!(LinearFriction::new(0.0, 1.0).is_err());
    assert!(LinearFriction::new(0.2, -1.0).is_err());
    assert!(SaturatingFriction::new(0.4, 0.3, 0.1).is_err());
    assert!(SaturatingFriction::new(0.4, 0.6, 0.0).is_err());
    let beads = SaturatingFriction::glass_beads();
    let refused = MuI::new(elastic(), beads, Grains::Dry { diameter: 0.0, density: 1.0 }).unwrap_err();
    assert_eq!(refused.to_string(), "diameter of the grains is 0, but must be above 0 m, and finite");
    assert!(MuI::new(elastic(), beads, Grains::InLiquid { viscosity: f64::NAN }).is_err());
}
