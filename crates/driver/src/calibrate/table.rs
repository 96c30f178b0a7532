//! What a calibration prints.

use super::{Estimate, MaterialFile};
use crate::scene::Dimension;
use std::fmt::Write;

/// Critical-state angle that the thesis claims for disks with friction 0.53 \[degrees\].
const CLAIMED: [f64; 2] = [22.0, 24.0];

/// The calibration as text, compared with the thesis.
pub fn table(file: &MaterialFile) -> String {
    let mut text = String::new();
    let unit = if file.dimension == Dimension::Plane { "N/m" } else { "Pa" };
    let both = |estimate: Estimate| format!("{:.4} +- {:.4}", estimate.value, estimate.error);
    let _ = writeln!(
        text,
        "{} grains of {:.4e} m with friction {}, means and standard errors over {} seeds",
        file.grains, file.diameter, file.contact_friction, file.seeds
    );
    let _ = writeln!(
        text,
        "\n{:>10} {:>20} {:>20} {:>20} {:>20}",
        "stress/M",
        format!("normal stress [{unit}]"),
        "inertial number",
        "friction",
        "solid fraction"
    );
    for point in &file.points {
        let stress = format!("{:.1} +- {:.1}", point.normal_stress.value, point.normal_stress.error);
        let number = format!("{:.5} +- {:.5}", point.inertial_number.value, point.inertial_number.error);
        let _ = writeln!(
            text,
            "{:>10.1e} {stress:>20} {number:>20} {:>20} {:>20}",
            point.stress_over_modulus,
            both(point.friction),
            both(point.solid_fraction)
        );
    }
    let young = format!("Young's modulus [{unit}]");
    let rows = [
        ("critical friction", both(file.critical_friction)),
        ("critical angle [deg]", both(file.critical_angle)),
        ("peak friction", both(file.peak_friction)),
        ("peak dilation [deg]", both(file.peak_dilation)),
        ("mu_s of mu_s + b I", both(file.linear.static_friction)),
        ("b of mu_s + b I", both(file.linear.slope)),
        ("mu_s of Jop", both(file.jop.static_friction)),
        ("mu_2 of Jop", both(file.jop.dynamic_friction)),
        ("I_0 of Jop", both(file.jop.inertial_number)),
        ("solid fraction at rest", both(file.solid_fraction.static_friction)),
        ("its slope over I", both(file.solid_fraction.slope)),
        (young.as_str(), format!("{:.4e} +- {:.1e}", file.young_modulus.value, file.young_modulus.error)),
        ("Poisson's ratio", both(file.poisson_ratio)),
    ];
    text.push('\n');
    for (name, value) in rows {
        let _ = writeln!(text, "{name:<24} {value}");
    }
    if file.dimension == Dimension::Plane {
        text += &claim(file);
    }
    text
}

/// What the thesis claims for disks.
fn claim(file: &MaterialFile) -> String {
    let [angle, peak] =
        [file.critical_friction, file.peak_friction].map(|friction| friction.value.atan().to_degrees());
    let inside = (CLAIMED[0]..=CLAIMED[1]).contains(&angle);
    let verdict = if inside { "agrees" } else { "differs" };
    format!(
        "\nthe thesis claims 22 to 24 degrees for the critical state of 1078 disks with friction 0.53 between two layers of \
         fixed grains; here {angle:.1}: {verdict}. The peak of dense samples is {peak:.1} degrees here. Simple shear of disks with \
         friction 0.4 gives a friction of 0.25 + 1.1 I, 14 degrees at rest [DaCruz2005].\n"
    )
}
