//! Validation cases of continua.

mod elastic_column;
mod element_tests;
mod rotating_disk;
mod single_point;
mod sliding_block;
mod two_disks;
mod uniform_drift;
mod vibrating_bar;

pub(super) use elastic_column::Elastic;
pub(super) use vibrating_bar::Bar;

use crate::validate::cases;

cases! { "mpm";
    element_tests: "laws of soil in triaxial, biaxial and oedometer tests" => element_tests::run;
    single_point: "one particle in one cell is a spring" => single_point::run;
    vibrating_bar: "periods and energy of a bar that is held at one end" => vibrating_bar::run;
    elastic_column: "settlement of an elastic column under its own weight" => elastic_column::run;
    uniform_drift: "a block under one stress that drifts through cells" => uniform_drift::run;
    rotating_disk: "what a spinning disk keeps of its angular momentum" => rotating_disk::run;
    two_disks: "two elastic disks meet and part" => two_disks::run;
    sliding_block: "a block slides or sticks on an incline" => sliding_block::run;
}
