//! The critical state of the grains of the thesis: what shear in a periodic cell gives, beside what is claimed.

use super::collapse::Collapse;
use crate::validate::Effort;
use crate::validate::{Measure, Rows, Tier};
use granular_driver::calibrate::{self, Estimate, MaterialFile, Plan};
use granular_driver::failure::Failure;
use granular_driver::scene::Scene;

/// Share by which a claim may be missed.
const NEAR: f64 = 0.15;
/// Normal stiffness of the template \[N/m\]: the modulus of a packing in the plane.
const STIFFNESS: f64 = 1.6e6;

/// Samples that are sheared in a few seconds; errors over seeds are accordingly wide.
fn quick() -> Plan {
    Plan {
        grains: 150,
        seeds: 2,
        levels: vec![1e-3],
        inertial_numbers: vec![0.015, 0.05, 0.15],
        other_stresses_at: 0.015,
        settle: 0.8,
        measure: 1.2,
    }
}

fn moderate() -> Plan {
    Plan { grains: 400, seeds: 4, ..Plan::of(Effort::Quick) }
}

pub(super) fn run(rows: &mut Rows, effort: Effort) -> Result<(), Failure> {
    let plan = if effort == Effort::Full { moderate() } else { quick() };
    // The template resists rolling so that its deposits come to rest; the grains of the thesis do not.
    let scene = Collapse::of(plan.grains).set("materials.glass.rolling_friction=0".to_owned()).scene()?;
    let scene: Scene = scene.parse().map_err(|problem| Failure::Scene(vec![problem]))?;
    let file = calibrate::friction(&scene, &plan, &|_, _| {})?;
    rows.claims_need(plan.grains, moderate().grains);
    servo(rows, &file);
    friction(rows, &file);
    dilation(rows, &file);
    stiffness(rows, &file);
    Ok(())
}

/// The cell keeps the normal stress that it was told to keep, and the stress that it takes to move. The mean is one of looks
/// at a stress that fluctuates by as much as 15 % in so few grains.
fn servo(rows: &mut Rows, file: &MaterialFile) {
    for point in &file.points {
        let wanted = point.stress_over_modulus * STIFFNESS;
        let number = point.inertial_number.value;
        let metric = format!(
            "mean normal stress of steady shear at I = {number:.3}, less what the cell takes to move [N/m]"
        );
        let measure = Measure::relative(Tier::Identity, metric, point.held_stress.value, wanted, 1e-2);
        let all = point.normal_stress.value;
        let note = of_seeds(file, point.held_stress);
        rows.add(measure.note(note).note(format!("{all:.0} with it: the height goes on changing")));
    }
}

fn of_seeds(file: &MaterialFile, estimate: Estimate) -> String {
    format!("{} seeds of {} disks, standard error {:.3}", file.seeds, file.grains, estimate.error)
}

fn friction(rows: &mut Rows, file: &MaterialFile) {
    let angle = file.critical_angle;
    let slowest = file.points.iter().map(|point| point.inertial_number.value).fold(f64::INFINITY, f64::min);
    let measure =
        Measure::absolute(Tier::Thesis, "critical-state friction angle [deg]", angle.value, 23.0, 1.0);
    rows.add(measure.claim().note(of_seeds(file, angle)).note(format!(
        "atan of shear over normal stress at I = {slowest:.3}, where friction is above its limit at rest by about I; the \
         thesis gives 22.2 (text), 23.2 (table), 23.7 (slope of its figure) for layers of fixed grains at both ends"
    )));
    let rest = file.linear.static_friction;
    let slope = file.linear.slope;
    let span = "friction 0.53 and restitution 0.75 here; a line over another range of I has another slope";
    for (name, tier, at_rest, rise) in
        [("thesis", Tier::Thesis, 0.22, 1.0), ("da Cruz et al. 2005", Tier::OtherCode, 0.25, 1.1)]
    {
        let metric = format!("mu(I) = mu_s + b I: mu_s against the {name}");
        let measure = Measure::relative(tier, metric, rest.value, at_rest, NEAR).claim();
        let why = if tier == Tier::Thesis {
            "a fit to its own shear test by contact dynamics; 12.4 degrees, against the 22 to 24 of the same chapter"
        } else {
            "friction 0.4 there, disks of sizes within 20 %, a gap between rough walls"
        };
        rows.add(measure.note(of_seeds(file, rest)).note(why));
        let metric = format!("mu(I) = mu_s + b I: b against the {name}");
        let measure = Measure::relative(tier, metric, slope.value, rise, NEAR).claim();
        rows.add(measure.note(of_seeds(file, slope)).note(span));
    }
}

fn dilation(rows: &mut Rows, file: &MaterialFile) {
    let (solid, fall) = (file.solid_fraction.static_friction, file.solid_fraction.slope);
    let metric = "solid fraction of slow shear against da Cruz et al. 2005";
    let measure = Measure::relative(Tier::OtherCode, metric, solid.value, 0.81, 1e-2).claim();
    rows.add(measure.note(of_seeds(file, solid)));
    let metric = "fall of the solid fraction over I against da Cruz et al. 2005";
    let measure = Measure::relative(Tier::OtherCode, metric, fall.value, -0.3, NEAR).claim();
    rows.add(measure.note(of_seeds(file, fall)));
    // In plane strain a peak is above the critical angle by 0.8 of the angle of dilation [Bolton1986].
    let psi = file.peak_dilation;
    let above = file.peak_friction.value.atan().to_degrees() - file.critical_angle.value;
    let metric = "peak angle above the critical one over the angle of dilation";
    let measure = Measure::relative(Tier::Experiment, metric, above / psi.value, 0.8, NEAR).claim();
    rows.add(measure.note(of_seeds(file, psi)).note(format!(
        "dilation {:.1} degrees at the peak; Bolton 1986 for sands in plane strain, with angles of principal stresses; here \
         those of the plane of shear, and a peak is the largest mean over a strain of 0.04",
        psi.value
    )));
}

fn stiffness(rows: &mut Rows, file: &MaterialFile) {
    let young = file.young_modulus;
    let metric = "Young's modulus from uniaxial compression [N/m]";
    let measure = Measure::relative(Tier::Thesis, metric, young.value, 1.98e6, NEAR).claim();
    rows.add(measure.note(of_seeds(file, young)).note(format!(
        "proportional to the stiffness of contacts, 1.6e6 N/m here (E = {:.2} of it), 1.6e8 in table 4.2; from a dense sample \
         without sliding, strain {:.0e}; the thesis does not state density and strain of its test",
        young.value / STIFFNESS,
        0.2 * file.points.first().map_or(f64::NAN, |point| point.stress_over_modulus)
    )));
}
