//! An elastic column between smooth walls that settles under its own weight.

use super::{About, Measured, Run, runs, study as study_of};
use crate::bench::study::Study;
use crate::methods::mpm::cases::Elastic;
use granular_driver::failure::Failure;

pub(super) fn study() -> Result<Study, Failure> {
    let about = About {
        case: "self-weight",
        error: "error of places over the settlement [-]",
        notes: vec![
            "column of 0.2 m of table 4.3 of the thesis, linear elastic, loaded by gravity in ten parts with local damping; \
             error: root mean square of the places of particles over the settlement of the surface, 1.6445e-4 m"
                .to_owned(),
        ],
    };
    study_of(about, &runs(&[5, 10, 20, 40]), measure)
}

pub(super) fn measure(run: &Run) -> Result<Measured, Failure> {
    let column = Elastic { shape: run.shape, scheme: run.when, cells: run.cells, along: run.along };
    let settled = column.settle()?;
    let said = format!("stresses are {:.2e} of that at the base off", settled.stresses);
    Ok(Measured { dt: settled.dt, error: settled.places, said })
}
