//! Studies of error against run time.

mod cells;
mod column;
mod hertz;
mod restitution;

use crate::bench::Precision;

pub(super) const STUDIES: &[Precision] = &[
    Precision {
        name: "restitution",
        about: "Restitution of a normal impact over the step, for both treatments of tension",
        run: restitution::study,
    },
    Precision {
        name: "hertz",
        about: "The same for elastic disks and spheres with damping",
        run: hertz::study,
    },
    Precision {
        name: "column",
        about: "Run-out of a column over stiffness and step, as a mean over seeds; takes minutes",
        run: column::study,
    },
    Precision {
        name: "cells",
        about: "Areas of Voronoi cells: a raster, exact cells, an estimate from a grid; takes seconds",
        run: cells::study,
    },
];
