//! What an element test came to: a table, a figure, and the numbers that are asked for most.

use super::figure::figure;
use super::plan::Plan;
use crate::failure::Failure;
use granular_constitutive::element::{ElementState, ElementTest};
use granular_io::TableWriter;
use serde::Serialize;
use serde_json::{Value, json};
use std::fmt;
use std::path::{Path, PathBuf};

/// Stresses that differ by less than this share of them are equal: a plateau has its peak where it begins.
const PLATEAU: f64 = 1e-9;

/// A material that was led along a path.
#[derive(Clone, Debug, PartialEq)]
pub struct Element {
    /// Name of the material.
    pub material: String,
    /// Name of its law.
    pub law: &'static str,
    /// What was done.
    pub plan: Plan,
    /// All states, from the start on.
    pub(super) test: ElementTest,
}

/// One state of a test in numbers that its path makes plain.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Numbers {
    /// The strain that is prescribed \[-\]: axial, or the shear `du_x / dy`.
    pub strain: f64,
    /// The stress that answers it \[Pa\]: axial less lateral, axial in an oedometer, or the shear stress.
    pub stress: f64,
    /// Axial over lateral stress, lateral over axial in an oedometer, or shear over normal stress \[-\].
    pub ratio: f64,
    /// Mean pressure p \[Pa\].
    pub mean_pressure: f64,
    /// Deviator stress q \[Pa\].
    pub deviator_stress: f64,
    /// Mobilised angle of friction \[degrees\].
    pub friction_angle: f64,
    /// Volumetric strain \[-\], positive when the material dilates.
    pub volumetric_strain: f64,
}

impl Element {
    fn numbers(&self, state: &ElementState) -> Numbers {
        let test = self.plan.test;
        Numbers {
            strain: test.strain(state),
            stress: test.stress(state),
            ratio: test.ratio(state),
            mean_pressure: state.mean_pressure,
            deviator_stress: state.deviator_stress,
            // Tension beside pressure mobilises more than any friction.
            friction_angle: state.mobilised_friction.min(1.0).asin().to_degrees(),
            volumetric_strain: state.volumetric_strain,
        }
    }

    /// Where the stress is largest, and first is.
    pub fn peak(&self) -> Numbers {
        let stress = |state: &ElementState| self.plan.test.stress(state);
        let largest = self.test.states.iter().map(stress).fold(f64::NEG_INFINITY, f64::max);
        let enough = largest - PLATEAU * largest.abs();
        let peak = self.test.states.iter().find(|state| stress(state) >= enough);
        self.numbers(peak.unwrap_or(self.test.last()))
    }

    /// The last state.
    pub fn end(&self) -> Numbers {
        self.numbers(self.test.last())
    }

    /// Writes `element.csv`, `element.svg` and `element.png` to a folder, and says where they are.
    ///
    /// # Errors
    /// When something cannot be written.
    pub fn save(&self, folder: &Path) -> Result<Vec<PathBuf>, Failure> {
        std::fs::create_dir_all(folder).map_err(|error| Failure::io(folder.display(), error))?;
        let path = folder.join("element.csv");
        let columns = self.test.columns();
        let heads: Vec<(&str, &str)> = columns.iter().map(|(name, unit)| (name.as_str(), *unit)).collect();
        let mut table = TableWriter::create(&path, &heads)?;
        self.test.states.iter().try_for_each(|state| table.row(&self.test.row(state)))?;
        table.sync()?;
        let [svg, png] = figure(self, &self.test.states).save(&folder.join("element"))?;
        Ok(vec![path, svg, png])
    }

    /// What was done and what came of it, for programs.
    pub fn to_json(&self) -> Value {
        json!({
            "material": self.material,
            "law": self.law,
            "path": self.plan.test.name(),
            "plan": self.plan,
            "peak": self.peak(),
            "end": self.end(),
        })
    }

    /// What was done, in a line.
    pub(super) fn title(&self) -> String {
        let Plan { test, pressure, .. } = self.plan;
        format!("{}: {}, {} from {} kPa", self.material, self.law, test.name(), 1e-3 * pressure)
    }
}

impl fmt::Display for Element {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Plan { test, strain, steps, .. } = self.plan;
        writeln!(f, "{} to a strain of {strain} in {steps} increments", self.title())?;
        writeln!(f, "  {:<34} {:>13} {:>13}", "", "peak", "end")?;
        let (peak, end) = (self.peak(), self.end());
        let mut row = |name: &str, of: fn(&Numbers) -> f64| {
            writeln!(f, "  {name:<34} {:>13} {:>13}", shown(of(&peak)), shown(of(&end)))
        };
        row(test.strain_label(), |numbers| numbers.strain)?;
        row(test.stress_label(), |numbers| numbers.stress)?;
        row(test.ratio_label(), |numbers| numbers.ratio)?;
        row("mean pressure p [Pa]", |numbers| numbers.mean_pressure)?;
        row("deviator stress q [Pa]", |numbers| numbers.deviator_stress)?;
        row("mobilised friction [degrees]", |numbers| numbers.friction_angle)?;
        row("volumetric strain [-]", |numbers| numbers.volumetric_strain)?;
        let last = self.test.last();
        writeln!(
            f,
            "  work {} J/m^3: {} stored more, {} lost to plastic strain, {} to viscosity",
            shown(last.work),
            shown(last.stored_energy - self.test.states[0].stored_energy),
            shown(last.plastic_work),
            shown(last.viscous_work)
        )
    }
}

/// Six digits; nothing where there is no number.
fn shown(value: f64) -> String {
    match value.abs() {
        _ if !value.is_finite() => "-".to_owned(),
        0.0 => "0".to_owned(),
        size if (1e-2..1e4).contains(&size) => format!("{value:.5}"),
        _ => format!("{value:.5e}"),
    }
}
