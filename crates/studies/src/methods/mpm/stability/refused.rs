//! Values that no run may have: refused before it begins.

use crate::validate::stability::{Outcome, Row};
use granular_constitutive::{LinearElastic, MohrCoulomb, Strength};
use granular_core::SetupError;
use granular_core::glam::DVec2;
use granular_mpm::{Mpm2, Options, Particle, Setup, ShapeFunctions};

pub(super) fn rows() -> Vec<Row> {
    let elastic = LinearElastic::new(1e6, 0.3);
    let sand = |degrees: f64, dilation: f64| {
        let friction_angle = degrees.to_radians();
        let strength = Strength { friction_angle, dilation_angle: dilation.to_radians(), cohesion: 0.0 };
        elastic.clone().and_then(|elastic| MohrCoulomb::new(elastic, strength)).err()
    };
    vec![
        row("Poisson's ratio 0.5", 0.5, LinearElastic::new(1e6, 0.5).err()),
        row("angle of friction 90 degrees", 90.0, sand(90.0, 0.0)),
        row("neither friction nor cohesion", 0.0, sand(0.0, 0.0)),
        row("dilation of 31 degrees at a friction of 30", 30.0, sand(30.0, 31.0)),
        row("particles twice as wide as a cell, as blocks", 1.0, wide()),
        row("Courant number 1.1", 1.0, courant(1.1)),
    ]
}

fn wide() -> Option<SetupError> {
    let options = Options { shape: ShapeFunctions::UniformGimp, ..Options::default() };
    let particles = [Particle::at(DVec2::ZERO, 4.0)];
    let body = |elastic| Mpm2::new(Setup { options, ..Setup::new(1.0) })?.body(elastic, 1.0, &particles);
    LinearElastic::new(1e6, 0.3).and_then(body).err()
}

fn courant(courant: f64) -> Option<SetupError> {
    let options = Options { courant, ..Options::default() };
    Mpm2::new(Setup { options, ..Setup::new(1.0) }).err()
}

/// What is refused has a reason; what is taken makes the study fail.
fn row(case: &str, limit: f64, refusal: Option<SetupError>) -> Row {
    let fault = refusal.is_none().then(|| "it is taken".to_owned());
    Row {
        case: case.to_owned(),
        parameter: "set-up",
        predicted_limit: Some(limit),
        observed_limit: None,
        outcome: Outcome::Refused,
        reason: refusal.map_or_else(String::new, |error| format!("refused: {error}")),
        fault,
        known: false,
    }
}
