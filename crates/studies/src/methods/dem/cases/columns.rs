//! Studies of chapter 4 of \[Kumar2014\] on columns of grains, beside what it claims.

mod aspects;
mod density;
mod flow;
mod phases;

pub(super) use density::run as density;

use super::collapse::Collapse;
use super::recorded::{Recorded, record};
use crate::validate::Effort;
use crate::validate::Rows;
use granular_driver::failure::Failure;
use granular_driver::parallel;
use granular_driver::scene::names::ENERGIES;

/// Share of the potential energy at the release that may be missing in the balance.
const RESIDUAL: f64 = 1e-3;
/// Share by which a claim without a tolerance of its own may be missed.
const NEAR: f64 = 0.15;
/// Diameter of the disks of hexagonal columns \[m\].
const HEXAGONAL: &str = "1.15 mm";

/// A column of a study.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Column {
    /// Height over width asked for.
    nominal: f64,
    hexagonal: bool,
}

/// How large the study of aspect ratios is.
struct Size {
    grains: usize,
    random: &'static [f64],
    hexagonal: &'static [f64],
    /// End in units of sqrt(H/g) after the release, of low columns and of those higher than wide: the tips of low ones creep.
    until: [f64; 2],
    /// Normal stiffness of all contacts \[N/m\].
    stiffness: Option<f64>,
}

const ALL: [f64; 10] = [0.2, 0.4, 0.6, 0.8, 1.0, 2.0, 4.0, 6.0, 8.0, 10.0];

/// As many disks as a quick test bears, with springs soft enough for it.
const QUICK: Size = Size {
    grains: 80,
    random: &[0.4, 1.0, 2.0, 4.0, 6.0],
    hexagonal: &[1.0, 4.0],
    until: [5.0, 4.0],
    stiffness: Some(4e5),
};
const FULL: Size = Size {
    grains: 1000,
    random: &ALL,
    hexagonal: &[0.4, 0.8, 2.0, 4.0, 6.0, 10.0],
    until: [8.0, 6.0],
    stiffness: None,
};

/// Run-out and height over the aspect ratio, the flow over time and where its energy goes.
pub(super) fn run(rows: &mut Rows, effort: Effort) -> Result<(), Failure> {
    let size = if effort == Effort::Full { FULL } else { QUICK };
    let random = size.random.iter().map(|&nominal| Column { nominal, hexagonal: false });
    let hexagonal = size.hexagonal.iter().map(|&nominal| Column { nominal, hexagonal: true });
    let columns: Vec<Column> = random.chain(hexagonal).collect();
    let recorded = parallel::each(&columns, |column| collapse(&size, *column))?;
    rows.claims_need(size.grains, FULL.grains);
    let of = format!("{} disks, one seed", size.grains);
    aspects::rows(rows, &of, &columns, &recorded);
    flow::rows(rows, &of, &columns, &recorded);
    Ok(())
}

fn collapse(size: &Size, column: Column) -> Result<Recorded, Failure> {
    let mut collapse = Collapse::of(size.grains).set(format!("sample.aspect_ratio={}", column.nominal));
    if column.hexagonal {
        collapse = collapse
            .set("sample.packing=Hexagonal".to_owned())
            .set(format!("sample.grading=Single(\"{HEXAGONAL}\")"));
    }
    if let Some(stiffness) = size.stiffness {
        for material in ["glass", "wall"] {
            collapse = collapse.set(format!("materials.{material}.normal_stiffness={stiffness}"));
        }
    }
    record(
        &collapse.scene()?,
        &[&["front", "height"], ENERGIES].concat(),
        size.until[usize::from(column.nominal >= 1.0)],
    )
}

/// Numbers with a blank between.
fn listed(values: &[f64]) -> String {
    values.iter().map(|value| format!("{value:.3}")).collect::<Vec<_>>().join(" ")
}
