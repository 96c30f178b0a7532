//! `granular element`.

use super::{Common, Edits, show};
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use granular_core::units::{Measured, Pressure, Time, Unit};
use granular_driver::element::{Material, Plan, Test};
use granular_driver::failure::Failure;
use serde_json::json;
use std::path::PathBuf;

/// What `granular element` takes.
#[derive(Args, Debug)]
pub(super) struct Element {
    /// File with what stands behind a name in `continua`, such as `(law: MohrCoulomb(..))`, or - for standard input; or a
    /// scene and one of its continua, such as scene.ron:sand.
    law: String,
    /// Path along which it is led.
    #[arg(value_parser = tests())]
    path: Test,
    /// Lateral pressure of a compression, normal stress of a shear, or pressure at the start of an oedometer; 100 kPa by
    /// default, none in an oedometer.
    #[arg(short, long, value_name = "PRESSURE", value_parser = measured::<Pressure>)]
    pressure: Option<f64>,
    /// Strain to reach, axial or shear (du_x / dy); 0.1 by default, 0.02 in an oedometer.
    #[arg(short, long, value_name = "STRAIN")]
    strain: Option<f64>,
    /// Equal increments of strain, each a row of the table; 1000 by default.
    #[arg(long, value_name = "N")]
    steps: Option<usize>,
    /// Time that it takes, which laws that know a rate ask for; 1 s by default.
    #[arg(long, value_name = "TIME", value_parser = measured::<Time>)]
    duration: Option<f64>,
    #[command(flatten)]
    edits: Edits,
    /// Folder for the table and the figure; `element/<material>-<path>` by default.
    #[arg(short, long, value_name = "FOLDER")]
    out: Option<PathBuf>,
}

fn tests() -> impl TypedValueParser<Value = Test> {
    let names = Test::ALL.map(|test| PossibleValue::new(test.name()).help(test.about()));
    PossibleValuesParser::new(names).map(|name| {
        let found = Test::ALL.into_iter().find(|test| test.name() == name);
        found.expect("the parser lets only these names pass")
    })
}

/// A value with its unit, or in the SI unit.
fn measured<M: Quantity>(text: &str) -> Result<f64, String> {
    M::read(text)
}

/// What an option measures.
trait Quantity {
    fn read(text: &str) -> Result<f64, String>;
}

impl<U: Unit> Quantity for Measured<U> {
    fn read(text: &str) -> Result<f64, String> {
        let plain = text.trim().parse().ok().filter(|value: &f64| value.is_finite());
        plain.map_or_else(|| text.parse().map(Self::value).map_err(|error| format!("{error}")), Ok)
    }
}

impl Element {
    pub(super) fn execute(self, common: &Common) -> Result<(), Failure> {
        let material = Material::read(&self.law, &self.edits.set)?;
        let usual = Plan::of(self.path);
        let found = material.test(Plan {
            test: self.path,
            pressure: self.pressure.unwrap_or(usual.pressure),
            strain: self.strain.unwrap_or(usual.strain),
            steps: self.steps.unwrap_or(usual.steps),
            duration: self.duration.unwrap_or(usual.duration),
        })?;
        let folder = format!("{}-{}", material.name.replace(['/', '\\'], "-"), self.path.name());
        let folder = self.out.unwrap_or_else(|| PathBuf::from("element").join(folder));
        let files = found.save(&folder)?;
        let files: Vec<String> = files.iter().map(|path| path.display().to_string()).collect();
        let mut value = found.to_json();
        value["files"] = json!(files);
        show(common, &value, || format!("{found}  files: {}\n", files.join(", ")));
        Ok(())
    }
}
